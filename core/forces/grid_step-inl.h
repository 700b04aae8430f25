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

/// The springs of a whole grid.
template <class Real>
struct SpringLaws {
  using D = GridTag<Real>;
  SpringLaw<D> warp, weft, shear;

  explicit HWY_INLINE SpringLaws(const GridSprings<Real>& s)
      : warp(law(s, s.rest_warp)), weft(law(s, s.rest_weft)), shear(law(s, s.rest_shear)) {}

 private:
  static HWY_INLINE SpringLaw<D> law(const GridSprings<Real>& s, Real rest_length) {
    const D d;
    return {hn::Set(d, Real(1)), hn::Set(d, rest_length), hn::Set(d, s.damping_per_stiffness),
            hn::Set(d, Real(kSmallestSquaredLength))};
  }
};

/// Factors of the four springs that start at each place of a row, into four lines of scratch. A
/// loop of its own: it is short enough for the processor to work at several vectors at once, which
/// hides the latency of roots and divisions.
template <class Real>
HWY_INLINE void compute_factors(const GridView<Real>& g, std::ptrdiff_t r,
                                const SpringLaws<Real>& laws) {
  const GridTag<Real> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  const Real* k = g.row[r].coefficients;
  const Real* x = g.motion + r * pitch;
  const Real* v = x + GridView<Real>::kVelocityLine * line;
  Real* factor = g.scratch + kFactorLine * line;
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const auto x0 = load(d, x + c, line), xr = load(d, x + c + 1, line),
               xd = load(d, x + c + pitch, line), xe = load(d, x + c + pitch + 1, line);
    const auto v0 = load(d, v + c, line), vr = load(d, v + c + 1, line),
               vd = load(d, v + c + pitch, line), ve = load(d, v + c + pitch + 1, line);
    const auto k_shear = hn::LoadU(d, k + kShear * line + c);
    const auto along = spring(d, laws.warp, hn::LoadU(d, k + kWarp * line + c), xr - x0, vr - v0);
    hn::StoreU(along, d, factor + c);
    const auto down = spring(d, laws.weft, hn::LoadU(d, k + kWeft * line + c), xd - x0, vd - v0);
    hn::StoreU(down, d, factor + line + c);
    hn::StoreU(spring(d, laws.shear, k_shear, xe - x0, ve - v0), d, factor + 2 * line + c);
    hn::StoreU(spring(d, laws.shear, k_shear, xd - xr, vd - vr), d, factor + 3 * line + c);
  }
}

/// One component of the forces on a row: springs and quadratic bending, each once, from left to
/// right. What acts on a particle to the right is handed on in registers, what acts on the row
/// below in lines of scratch (NUMERICS.md a). A component at a time, so that all of it stays in
/// registers. sink(column, force) may move the row's component, because nobody reads it any more.
/// @param component  0 to 2
template <class Real, class Sink>
HWY_INLINE void sum_forces(const GridView<Real>& g, std::ptrdiff_t r, int component, Sink&& sink) {
  using D = GridTag<Real>;
  const D d;
  using V = hn::Vec<D>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const OneLaneUp<D> up;
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  const V two = hn::Set(d, Real(2));
  const Real* k = g.row[r].coefficients;
  const Real* x = g.motion + r * pitch + component * line;
  const Real* factor = g.scratch + kFactorLine * line;
  Real* const carry = g.scratch + component * line;
  Real* const bent = carry + 3 * line;
  V right_before = hn::Zero(d), next_right_before = right_before, below_right_before = right_before;
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const V x0 = hn::LoadU(d, x + c), xr = hn::LoadU(d, x + c + 1),
            xd = hn::LoadU(d, x + c + pitch), xe = hn::LoadU(d, x + c + pitch + 1);
    const V along = hn::Sub(xr, x0), down = hn::Sub(xd, x0);
    const V falling = hn::Sub(xe, x0), rising = hn::Sub(xd, xr);
    const V f_along = hn::LoadU(d, factor + c), f_down = hn::LoadU(d, factor + line + c),
            f_falling = hn::LoadU(d, factor + 2 * line + c),
            f_rising = hn::LoadU(d, factor + 3 * line + c);
    const V twist = hn::Mul(hn::Sub(hn::Sub(xe, xd), along), hn::LoadU(d, k + kTwist * line + c));
    // The stencils centred one column to the right and one row below.
    const V bend_right = hn::Mul(hn::Sub(hn::Sub(hn::LoadU(d, x + c + 2), xr), along),
                                 hn::LoadU(d, k + kBendU * line + c));
    const V bend_below = hn::Mul(hn::Sub(hn::Sub(hn::LoadU(d, x + c + 2 * pitch), xd), down),
                                 hn::LoadU(d, k + kBendV * line + c));
    const V bend_here = hn::LoadU(d, bent + c);
    hn::StoreU(bend_below, d, bent + c);

    V here = hn::Sub(hn::LoadU(d, carry + c), hn::Add(hn::Add(twist, bend_right), bend_below));
    here = fused(d, along, f_along, here);
    here = fused(d, down, f_down, here);
    here = fused(d, falling, f_falling, here);
    const V next_right = up(next_right_before, bend_right);
    V right = fused(d, bend_right, two, hn::Sub(twist, next_right));
    right = fused_minus(d, along, f_along, right);
    right = fused(d, rising, f_rising, right);
    const V below_right = up(below_right_before, fused(d, falling, f_falling, twist));
    V below = fused(d, bend_below, two, hn::Sub(hn::Sub(twist, bend_here), below_right));
    below = fused_minus(d, down, f_down, below);
    below = fused_minus(d, rising, f_rising, below);
    hn::StoreU(below, d, carry + c);
    sink(c, hn::Add(here, up(right_before, right)));
  }
}

/// Nothing is carried into the first row.
template <class Real>
HWY_INLINE void clear_carries(const GridView<Real>& g) {
  const GridTag<Real> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t c = 0; c < kPowerLine * g.line; c += lanes)
    hn::StoreU(hn::Zero(d), d, g.scratch + c);
}

/// Forces alone, into the arrays of external forces.
template <class Real>
HWY_INLINE void internal_forces(const GridView<Real>& g) {
  clear_carries(g);
  const SpringLaws<Real> laws(g.springs);
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    compute_factors(g, r, laws);
    for (int component = 0; component < 3; ++component) {
      Real* const to = g.external + (3 * r + component) * g.line;
      sum_forces(g, r, component, [&](std::ptrdiff_t c, auto force) HWY_ATTR {
        hn::StoreU(force, GridTag<Real>(), to + c);
      });
    }
  }
}

/// Kick and drift of one component of a row, whose force is at hand.
template <class Real, bool kPulled>
HWY_INLINE void advance_component(const GridView<Real>& g, std::ptrdiff_t r, int component,
                                  const GridStep<Real>& step) {
  using D = GridTag<Real>;
  const D d;
  using V = hn::Vec<D>;
  const std::ptrdiff_t line = g.line;
  Real* const x = g.motion + r * g.pitch() + component * line;
  Real* const v = x + GridView<Real>::kVelocityLine * line;
  const Real* const inverse = x + (GridView<Real>::kInverseMassLine - component) * line;
  const Real* const external = kPulled ? g.external + (3 * r + component) * line : nullptr;
  Real* const power = g.scratch + kPowerLine * line;
  const V keep = hn::Set(d, step.keep), push = hn::Set(d, step.push), dt = hn::Set(d, step.dt);
  const V fall = hn::Set(d, step.push * step.gravity[component]);
  sum_forces(g, r, component, [&](std::ptrdiff_t c, V force) HWY_ATTR {
    V pull = force;
    if constexpr (kPulled) {
      pull = hn::LoadU(d, external + c);
      force = hn::Add(force, pull);
    }
    const V inverse_mass = hn::LoadU(d, inverse + c);
    const auto held = hn::Eq(inverse_mass, hn::Zero(d));
    const V change = fused(d, force, hn::Mul(inverse_mass, push), fall);
    const V speed = hn::IfThenZeroElse(held, fused(d, hn::LoadU(d, v + c), keep, change));
    hn::StoreU(speed, d, v + c);
    hn::StoreU(hn::Add(hn::LoadU(d, x + c), hn::Mul(speed, dt)), d, x + c);
    if constexpr (kPulled) hn::StoreU(fused(d, pull, speed, hn::LoadU(d, power + c)), d, power + c);
  });
}

template <class Real, bool kPulled>
HWY_INLINE void advance_rows(const GridView<Real>& g, const GridStep<Real>& step) {
  const SpringLaws<Real> laws(g.springs);
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    compute_factors(g, r, laws);
    for (int component = 2; component >= 0; --component)
      advance_component<Real, kPulled>(g, r, component, step);
  }
}

/// The whole substep.
/// @returns power of the external forces at the new velocities [W]
template <class Real>
HWY_INLINE double advance(const GridView<Real>& g, const GridStep<Real>& step) {
  clear_carries(g);
  if (!step.pulled) {
    advance_rows<Real, false>(g, step);
    return 0;
  }
  Real* const power = g.scratch + kPowerLine * g.line;
  for (std::ptrdiff_t c = 0; c < g.line; ++c) power[c] = 0;
  advance_rows<Real, true>(g, step);
  return sum_of_columns(g, power);
}

/// Moves positions of the model by its velocities and takes both over.
/// @returns power of the external forces [W]
template <class Real>
HWY_INLINE double drift(const GridView<Real>& g, Real dt, bool pulled, const Real* v, Real* x) {
  Real* const power = g.scratch + kPowerLine * g.line;
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
