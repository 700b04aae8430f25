// Air forces on a grid.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_AIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_AIR_INL_H
#undef WEFT_GRID_AIR_INL_H
#else
#define WEFT_GRID_AIR_INL_H
#endif

#include "core/forces/air/air_force.h"
#include "core/forces/constants.h"
#include "core/forces/grid_layout-inl.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct AirLaw {
  hn::Vec<D> pressure_sixth, skin_sixth, skin_eighteenth, third, smallest;
};

/// A third of the air force on triangles (a, b, c); the formula of air_force.h, with the area
/// expressed by the length of the normal: A n = normal / 2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> air_third(D d, const AirLaw<D>& law, const Triple<V>& ab, const Triple<V>& ac,
                               const Triple<V>& slip_sum) {
  const auto normal = fused_cross(d, ab, ac);
  const V length2 = fused_dot(d, normal, normal, law.smallest);
  const V per_length = inverse_root(d, length2);
  const V un = hn::Mul(hn::Mul(fused_dot(d, slip_sum, normal), law.third), per_length);
  const V along = hn::Mul(un, fused(d, law.pressure_sixth, hn::Abs(un), hn::Neg(law.skin_sixth)));
  const V across = hn::Mul(law.skin_eighteenth, hn::Mul(length2, per_length));
  return fused(d, normal, along, slip_sum * across);
}

/// Adds the air's forces to the external forces, each triangle once. A cell has corners a, b in its
/// upper and f, e in its lower row. Even cells are split from a to e, odd ones from b to f
/// (split_cells in grid_cells.h).
template <class Real>
HWY_ATTR void air_forces(const GridView<Real>& g, Real rho_half, Real skin_friction) {
  using D = GridTag<Real>;
  const D d;
  using V = hn::Vec<D>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const OneLaneUp<D> up;
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  const auto zero = hn::Zero(d);
  const Triple<V> nothing{zero, zero, zero};
  for (std::ptrdiff_t c = 0; c < 3 * line; c += lanes) hn::StoreU(zero, d, g.scratch + c);
  const AirLaw<D> law{hn::Set(d, rho_half / Real(6)), hn::Set(d, skin_friction / Real(6)),
                      hn::Set(d, skin_friction / Real(18)), hn::Set(d, Real(1.0 / 3.0)),
                      hn::Set(d, Real(kSmallestSquaredNormal))};
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    const Real* cells = g.row[r].coefficients + kHasCell * line;
    const auto parity = hn::Set(d, static_cast<Real>(r % 2));
    Triple<V> right_before = nothing, below_right_before = nothing;
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const Real* const x = g.motion + r * pitch + c;
      const Real* const v = x + GridView<Real>::kVelocityLine * line;
      const Real* const wind = g.wind + 3 * r * line + c;
      Real* const carry = g.scratch + c;
      const auto a = load(d, x, line), b = load(d, x + 1, line), f = load(d, x + pitch, line),
                 e = load(d, x + pitch + 1, line);
      const auto sa = load(d, wind, line) - load(d, v, line),
                 sb = load(d, wind + 1, line) - load(d, v + 1, line),
                 sf = load(d, wind + 3 * line, line) - load(d, v + pitch, line),
                 se = load(d, wind + 3 * line + 1, line) - load(d, v + pitch + 1, line);
      const auto even = hn::Eq(hn::LoadU(d, g.odd + c), parity);
      const V exists = hn::LoadU(d, cells + c);
      const auto upper =
          air_third(d, law, b - a, select(even, e, f) - a, (sa + sb) + select(even, se, sf)) *
          exists;
      const auto lower =
          air_third(d, law, f - e, select(even, a, b) - e, (se + sf) + select(even, sa, sb)) *
          exists;
      const auto both = upper + lower;
      const auto at_a = select(even, both, upper), at_b = select(even, upper, both);
      const auto at_e = select(even, both, lower), at_f = select(even, lower, both);
      const auto total = (load(d, carry, line) + at_a) + up(right_before, at_b);
      store(d, at_f + up(below_right_before, at_e), carry, line);
      store(d, total, g.external + 3 * r * line + c, line);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
