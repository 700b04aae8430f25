// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_STEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_STEP_INL_H
#undef WEFT_GRID_STEP_INL_H
#else
#define WEFT_GRID_STEP_INL_H
#endif

#include "core/forces/grid_layout-inl.h"
#include "core/forces/spring.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One kind of spring: rest length, dashpot per stiffness.
template <class D>
struct SpringLaw {
  hn::Vec<D> one, rest_length, damping, smallest;
};

/// Force on the start of springs from their start to their end, as a factor of that way; the
/// formula of spring.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V spring(D tag, const SpringLaw<D>& law, V stiffness, const Triple<V>& d,
                    const Triple<V>& dv) {
  const V per_l = inverse_root(tag, fused_dot(tag, d, d, law.smallest));
  const V elastic = fused_minus(tag, law.rest_length, per_l, law.one);
  const V rate = hn::Mul(fused_dot(tag, d, dv), hn::Mul(per_l, per_l));
  return hn::Mul(stiffness, fused(tag, law.damping, rate, elastic));
}

/// Forces of springs and quadratic bending, each once, in one pass: row by row and from left to
/// right, what acts on a particle to the right is handed on in registers and what acts on the row
/// below in a row of carries (NUMERICS.md a). sink(row, column, at, force) gets the sum; it may
/// move the particles of its vector, whose motion is at `at`, because nobody reads them any more.
template <class Real, class Sink>
HWY_INLINE void pass_over_grid(const GridView<Real>& g, Sink&& sink) {
  using D = GridTag<Real>;
  const D d;
  using V = hn::Vec<D>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const OneLaneUp<D> up;
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  const auto zero = hn::Zero(d), two = hn::Set(d, Real(2));
  const Triple<V> nothing{zero, zero, zero};
  for (std::ptrdiff_t c = 0; c < 6 * line; c += lanes) hn::StoreU(zero, d, g.scratch + c);
  const auto law = [&](Real rest_length) HWY_ATTR {
    return SpringLaw<D>{hn::Set(d, Real(1)), hn::Set(d, rest_length),
                        hn::Set(d, g.springs.damping_per_stiffness),
                        hn::Set(d, Real(kSmallestSquaredLength))};
  };
  const SpringLaw<D> warp = law(g.springs.rest_warp), weft = law(g.springs.rest_weft),
                     shear = law(g.springs.rest_shear);
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    const Real* k = g.row[r].coefficients;
    Real* x = g.motion + r * pitch;
    Real* v = x + GridView<Real>::kVelocityLine * line;
    Real *carry = g.scratch, *bent = g.scratch + 3 * line;
    Triple<V> right_before = nothing, next_right_before = nothing, below_right_before = nothing;
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const auto x0 = load(d, x, line), xr = load(d, x + 1, line), xd = load(d, x + pitch, line),
                 xe = load(d, x + pitch + 1, line);
      const auto v0 = load(d, v, line), vr = load(d, v + 1, line), vd = load(d, v + pitch, line),
                 ve = load(d, v + pitch + 1, line);
      const auto along = xr - x0, down = xd - x0, falling = xe - x0, rising = xd - xr;
      const V k_shear = hn::LoadU(d, k + kShear * line);
      const V f_along = spring(d, warp, hn::LoadU(d, k + kWarp * line), along, vr - v0);
      const V f_down = spring(d, weft, hn::LoadU(d, k + kWeft * line), down, vd - v0);
      const V f_falling = spring(d, shear, k_shear, falling, ve - v0);
      const V f_rising = spring(d, shear, k_shear, rising, vd - vr);
      const auto twist = ((xe - xd) - along) * hn::LoadU(d, k + kTwist * line);
      // The stencils centred one column to the right and one row below.
      const auto bend_right =
          ((load(d, x + 2, line) - xr) - along) * hn::LoadU(d, k + kBendU * line);
      const auto bend_below =
          ((load(d, x + 2 * pitch, line) - xd) - down) * hn::LoadU(d, k + kBendV * line);
      const auto bend_here = load(d, bent, line);
      store(d, bend_below, bent, line);

      auto here = load(d, carry, line) - ((twist + bend_right) + bend_below);
      here = fused(d, along, f_along, here);
      here = fused(d, down, f_down, here);
      here = fused(d, falling, f_falling, here);
      const auto next_right = up(next_right_before, bend_right);
      auto right = fused(d, bend_right, two, twist - next_right);
      right = fused_minus(d, along, f_along, right);
      right = fused(d, rising, f_rising, right);
      const auto below_right = up(below_right_before, fused(d, falling, f_falling, twist));
      auto below = fused(d, bend_below, two, (twist - bend_here) - below_right);
      below = fused_minus(d, down, f_down, below);
      below = fused_minus(d, rising, f_rising, below);
      store(d, below, carry, line);
      sink(r, c, x, here + up(right_before, right));
      x += lanes;
      v += lanes;
      k += lanes;
      carry += lanes;
      bent += lanes;
    }
  }
}

/// Forces alone, into the arrays of external forces.
template <class Real>
HWY_INLINE void internal_forces(const GridView<Real>& g) {
  pass_over_grid(g, [&](std::ptrdiff_t r, std::ptrdiff_t c, const Real*, auto force) HWY_ATTR {
    store(GridTag<Real>(), force, g.external + 3 * r * g.line + c, g.line);
  });
}

/// The whole substep.
/// @returns power of the external forces at the new velocities [W]
template <class Real>
HWY_INLINE double advance(const GridView<Real>& g, const GridStep<Real>& step) {
  using D = GridTag<Real>;
  const D d;
  using V = hn::Vec<D>;
  const std::ptrdiff_t line = g.line;
  Real* const power = g.scratch + 6 * line;
  for (std::ptrdiff_t c = 0; c < line; ++c) power[c] = 0;
  const V keep = hn::Set(d, step.keep), push = hn::Set(d, step.push), dt = hn::Set(d, step.dt);
  const Triple<V> fall{hn::Set(d, step.push * step.gravity[0]),
                       hn::Set(d, step.push * step.gravity[1]),
                       hn::Set(d, step.push * step.gravity[2])};
  const bool drifts = step.dt != 0;
  pass_over_grid(g, [&](std::ptrdiff_t r, std::ptrdiff_t c, Real* x, Triple<V> force) HWY_ATTR {
    Triple<V> external;
    if (HWY_UNLIKELY(step.pulled)) {
      external = load(d, g.external + 3 * r * line + c, line);
      force = force + external;
    }
    Real* const v = x + GridView<Real>::kVelocityLine * line;
    const V inverse_mass = hn::LoadU(d, x + GridView<Real>::kInverseMassLine * line);
    const auto held = hn::Eq(inverse_mass, hn::Zero(d));
    const auto change = fused(d, force, hn::Mul(inverse_mass, push), fall);
    const Triple<V> speed = drop_if(held, fused(d, load(d, v, line), keep, change));
    store(d, speed, v, line);
    if (drifts) store(d, load(d, x, line) + speed * dt, x, line);
    if (HWY_UNLIKELY(step.pulled))
      hn::StoreU(fused_dot(d, external, speed, hn::LoadU(d, power + c)), d, power + c);
  });
  return step.pulled ? sum_of_columns(g, power) : 0;
}

/// Moves positions of the model by its velocities and takes both over.
/// @returns power of the external forces [W]
template <class Real>
HWY_INLINE double drift(const GridView<Real>& g, Real dt, bool pulled, const Real* v, Real* x) {
  Real* const power = g.scratch + 6 * g.line;
  for (std::ptrdiff_t c = 0; c < g.columns; ++c) power[c] = 0;
  for_each_stretch(
      g, [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number) HWY_ATTR {
        const auto speed = load_particles(d, v + number);
        const auto place = load_particles(d, x + number) + speed * hn::Set(d, dt);
        store_particles(d, place, x + number);
        Real* const motion = g.motion + r * g.pitch() + c;
        store(d, place, motion, g.line);
        store(d, speed, motion + GridView<Real>::kVelocityLine * g.line, g.line);
        if (!pulled) return;
        const auto external = load(d, g.external + 3 * r * g.line + c, g.line);
        hn::StoreU(fused_dot(d, external, speed, hn::LoadU(d, power + c)), d, power + c);
      });
  return pulled ? sum_of_columns(g, power) : 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
