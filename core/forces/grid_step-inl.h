// Forces, kick and drift of a grid's rows.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_STEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_STEP_INL_H
#undef WEFT_GRID_STEP_INL_H
#else
#define WEFT_GRID_STEP_INL_H
#endif

#include "core/forces/grid_layout-inl.h"
#include "core/forces/grid_misfit-inl.h"
#include "core/forces/spring_law-inl.h"
#include "core/math/drift-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Differences of coordinates of one line, and of what drifts have lost of them if `Fine`.
template <bool Fine, class Real>
struct Differences {
  const Real* x;        ///< of the line
  std::ptrdiff_t lost;  ///< from there to what was lost

  template <class D>
  HWY_INLINE hn::Vec<D> operator()(D d, std::ptrdiff_t from, std::ptrdiff_t to) const {
    const auto seen = hn::Sub(hn::LoadU(d, x + to), hn::LoadU(d, x + from));
    if constexpr (!Fine) return seen;
    const Real* const rest = x + lost;
    return hn::Add(seen, hn::Sub(hn::LoadU(d, rest + to), hn::LoadU(d, rest + from)));
  }
};

/// Force factors of one kind of spring that starts on a row, into a line of scratch. One loop per
/// kind is short enough for the processor to overlap several vectors, which hides the latency of
/// roots and divisions.
/// @param from, to  offsets of a spring's ends from its site in the row
template <bool Fine, class Real>
HWY_INLINE void compute_factors(const GridView<Real>& g, std::ptrdiff_t r, Real rest_length,
                                Real damping_time, GridCoefficient stiffness, std::ptrdiff_t from,
                                std::ptrdiff_t to, Real* factor) {
  using D = GridTag<Real>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const SpringLaw<D> law{hn::Set(d, Real(1)), hn::Set(d, rest_length), hn::Set(d, damping_time),
                         hn::Set(d, Real(kSmallestSquaredLength))};
  const Real* const x = g.motion + r * g.pitch();
  const Real* const v = x + GridView<Real>::kVelocityLine * g.line;
  const Real* const lost = x + GridView<Real>::kRemainderLine * g.line;
  const Real* const k = g.row[r].coefficients + stiffness * g.line;
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    auto delta = load(d, x + to + c, g.line) - load(d, x + from + c, g.line);
    if constexpr (Fine)
      delta = delta + (load(d, lost + to + c, g.line) - load(d, lost + from + c, g.line));
    const auto speed = load(d, v + to + c, g.line) - load(d, v + from + c, g.line);
    hn::StoreU(spring(d, law, hn::LoadU(d, k + c), delta, speed), d, factor + c);
  }
}

/// Lines of scratch for the forces on a row. A force on the next column, or the one after it, is
/// stored at its source and read with an offset: aligned stores are cheap, and reads before a
/// line's start hit the cleared tail of the previous line. A processor must wait with such a read
/// until what it straddles has left the store buffer; all components are stored first, so that it
/// has. Forces on the row below are kept for that row.
template <class Real>
struct ForceLines {
  Real *along, *down, *falling, *rising;  ///< factors of the springs
  Real *here, *right, *ahead;             ///< on this column, the next one, the one after it,
                                          ///< per component
  Real* carry;                            ///< on the row below, per component
  Real* bent;                             ///< bending stencils centred there, per component
  Real *corner_in, *corner_out;           ///< on the row below, one column on: from above, to below
  const Real* twist;                      ///< stiffness of the cells' twist
  Real* softened;                         ///< the same where a misfit is subtracted, else null
  const Real *bend_u, *bend_v;            ///< of the other bending stencils
  std::ptrdiff_t step;                    ///< from component to component

  HWY_INLINE ForceLines(const GridView<Real>& g, std::ptrdiff_t r) : step(g.scratch_line()) {
    Real* at = g.scratch;
    for (Real** line : {&along, &down, &falling, &rising}) {
      *line = at;
      at += step;
    }
    for (Real** lines : {&here, &right, &ahead, &carry, &bent}) {
      *lines = at;
      at += 3 * step;
    }
    corner_in = at + (r % 2 == 0 ? 0 : 3) * step;
    corner_out = at + (r % 2 == 0 ? 3 : 0) * step;
    const Real* const row = g.row[r].coefficients;
    softened = g.misfit.stiffness != 0 ? g.scratch + kTwistLine * step : nullptr;
    twist = softened != nullptr ? softened : row + kTwist * g.line;
    bend_u = row + kBendU * g.line;
    bend_v = row + kBendV * g.line;
  }
};

template <bool Fine, class Real>
HWY_INLINE void compute_factors(const GridView<Real>& g, std::ptrdiff_t r,
                                const ForceLines<Real>& to) {
  const GridSprings<Real>& s = g.springs;
  const std::ptrdiff_t below = g.pitch();
  if (to.softened != nullptr) soften_twist(g, r, to.softened);
  compute_factors<Fine>(g, r, s.rest_warp, s.warp_time, kWarp, 0, 1, to.along);
  compute_factors<Fine>(g, r, s.rest_weft, s.weft_time, kWeft, 0, below, to.down);
  compute_factors<Fine>(g, r, s.rest_shear, s.shear_time, kShear, 0, below + 1, to.falling);
  compute_factors<Fine>(g, r, s.rest_shear, s.shear_time, kShear, 1, below, to.rising);
}

/// One component of the forces of springs and quadratic bending that start on a row, each computed
/// once, from the given factors.
/// @param component  0 to 2
template <bool Fine, class Real>
HWY_INLINE void add_up_forces(const GridView<Real>& g, std::ptrdiff_t r, int component,
                              const ForceLines<Real>& to) {
  const GridTag<Real> d;
  using V = hn::Vec<GridTag<Real>>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  const V two = hn::Set(d, Real(2));
  const Real* const x = g.motion + r * pitch + component * line;
  const std::ptrdiff_t own = component * to.step;
  Real *const carry = to.carry + own, *const bent = to.bent + own;
  Real *const here_to = to.here + own, *const right_to = to.right + own,
              *const ahead = to.ahead + own;
  const Real* const corner_in = to.corner_in + own;
  Real* const corner_out = to.corner_out + own;
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const Differences<Fine, Real> between{x + c, GridView<Real>::kRemainderLine * line};
    const V along = between(d, 0, 1), down = between(d, 0, pitch);
    const V falling = between(d, 0, pitch + 1), rising = between(d, 1, pitch);
    const V f_along = hn::LoadU(d, to.along + c), f_down = hn::LoadU(d, to.down + c),
            f_falling = hn::LoadU(d, to.falling + c), f_rising = hn::LoadU(d, to.rising + c);
    const V twist =
        hn::Mul(hn::Sub(between(d, pitch, pitch + 1), along), hn::LoadU(d, to.twist + c));
    // The stencils centred one column to the right and one row below.
    const V bend_right = hn::Mul(hn::Sub(between(d, 1, 2), along), hn::LoadU(d, to.bend_u + c));
    const V bend_below =
        hn::Mul(hn::Sub(between(d, pitch, 2 * pitch), down), hn::LoadU(d, to.bend_v + c));
    const V bend_here = hn::LoadU(d, bent + c);
    hn::StoreU(bend_below, d, bent + c);

    V here = hn::Sub(hn::LoadU(d, carry + c), hn::LoadU(d, corner_in + c - 1));
    here = hn::Sub(here, hn::Add(hn::Add(twist, bend_right), bend_below));
    here = fused(d, along, f_along, here);
    here = fused(d, down, f_down, here);
    hn::StoreU(fused(d, falling, f_falling, here), d, here_to + c);
    V right = fused(d, bend_right, two, twist);
    right = fused_minus(d, along, f_along, right);
    hn::StoreU(fused(d, rising, f_rising, right), d, right_to + c);
    hn::StoreU(bend_right, d, ahead + c);
    V below = fused(d, bend_below, two, hn::Sub(twist, bend_here));
    below = fused_minus(d, down, f_down, below);
    hn::StoreU(fused_minus(d, rising, f_rising, below), d, carry + c);
    hn::StoreU(fused(d, falling, f_falling, twist), d, corner_out + c);
  }
}

/// Calls sink(column, force) for the vectors of a row, after `add_up_forces`.
template <class Real, class Sink>
HWY_INLINE void visit_forces(const GridView<Real>& g, const ForceLines<Real>& from, int component,
                             Sink&& sink) {
  const GridTag<Real> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::ptrdiff_t own = component * from.step;
  const Real *const here = from.here + own, *const right = from.right + own - 1,
                    *const ahead = from.ahead + own - 2;
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes)
    sink(c, hn::Add(hn::LoadU(d, here + c),
                    hn::Sub(hn::LoadU(d, right + c), hn::LoadU(d, ahead + c))));
}

/// The first row receives no forces from above, and the left border none from the left.
template <class Real>
HWY_INLINE void clear_lines(const GridView<Real>& g) {
  const GridTag<Real> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t c = 0; c < kGridScratchLines * g.scratch_line(); c += lanes)
    hn::StoreU(hn::Zero(d), d, g.scratch + c);
}

/// Only computes the forces, into the arrays of external forces.
template <bool Fine, class Real>
HWY_INLINE void sum_forces(const GridView<Real>& g) {
  clear_lines(g);
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    const ForceLines<Real> lines(g, r);
    compute_factors<Fine>(g, r, lines);
    for (int component = 0; component < 3; ++component) {
      add_up_forces<Fine>(g, r, component, lines);
      Real* const to = g.external + (3 * r + component) * g.line;
      visit_forces(g, lines, component, [&](std::ptrdiff_t c, auto force) HWY_ATTR {
        hn::StoreU(force, GridTag<Real>(), to + c);
      });
    }
  }
}

/// Kick and drift of one component of a row that no later row reads.
template <bool Pulled, class Real>
HWY_INLINE void move_row(const GridView<Real>& g, std::ptrdiff_t r, int component,
                         const GridStep<Real>& step, const ForceLines<Real>& from, Real* power) {
  const GridTag<Real> d;
  using V = hn::Vec<GridTag<Real>>;
  const std::ptrdiff_t line = g.line;
  Real* const x = g.motion + r * g.pitch() + component * line;
  Real* const v = x + GridView<Real>::kVelocityLine * line;
  Real* const lost = x + GridView<Real>::kRemainderLine * line;
  const Real* const inverse = x + (GridView<Real>::kInverseMassLine - component) * line;
  const Real* const external = Pulled ? g.external + (3 * r + component) * line : nullptr;
  const V keep = hn::Set(d, step.keep), scaled_dt = hn::Set(d, step.scaled_dt),
          dt = hn::Set(d, step.dt);
  const V fall = hn::Set(d, step.scaled_dt * step.gravity[component]);
  const bool drifts = step.dt != 0;
  visit_forces(g, from, component, [&](std::ptrdiff_t c, V force) HWY_ATTR {
    V pull = force;
    if constexpr (Pulled) {
      pull = hn::LoadU(d, external + c);
      force = hn::Add(force, pull);
    }
    const V inverse_mass = hn::LoadU(d, inverse + c);
    const auto held = hn::Eq(inverse_mass, hn::Zero(d));
    const V change = fused(d, force, hn::Mul(inverse_mass, scaled_dt), fall);
    const V speed = hn::IfThenZeroElse(held, fused(d, hn::LoadU(d, v + c), keep, change));
    hn::StoreU(speed, d, v + c);
    if (drifts) {
      V remainder = hn::LoadU(d, lost + c);
      hn::StoreU(drifted(d, hn::LoadU(d, x + c), speed, dt, remainder), d, x + c);
      hn::StoreU(remainder, d, lost + c);
    }
    if constexpr (Pulled) hn::StoreU(fused(d, pull, speed, hn::LoadU(d, power + c)), d, power + c);
  });
}

/// Clears the lines of scratch, and fills them with the forces that the rows above carry to row
/// `first`: springs reach one row down, bending two.
template <bool Fine, class Real>
HWY_INLINE void carry_forces(const GridView<Real>& g, std::ptrdiff_t first) {
  clear_lines(g);
  for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(0, first - 2); r < first; ++r) {
    const ForceLines<Real> lines(g, r);
    compute_factors<Fine>(g, r, lines);
    for (int component = 0; component < 3; ++component) add_up_forces<Fine>(g, r, component, lines);
  }
}

/// The whole substep of rows `first` to `last` (exclusive), after `carry_forces` or the rows above.
/// Accumulates the powers of the external forces at the new velocities in their line.
template <bool Fine, class Real>
HWY_INLINE void advance_rows(const GridView<Real>& g, const GridStep<Real>& step,
                             std::ptrdiff_t first, std::ptrdiff_t last) {
  Real* const power = g.scratch + kPowerLine * g.scratch_line();
  for (std::ptrdiff_t r = first; r < last; ++r) {
    const ForceLines<Real> lines(g, r);
    compute_factors<Fine>(g, r, lines);
    for (int component = 0; component < 3; ++component) add_up_forces<Fine>(g, r, component, lines);
    for (int component = 0; component < 3; ++component) {
      if (step.has_external)
        move_row<true>(g, r, component, step, lines, power);
      else
        move_row<false>(g, r, component, step, lines, power);
    }
  }
}

template <class Real>
HWY_ATTR void internal_forces(const GridView<Real>& g) {
  g.fine ? sum_forces<true>(g) : sum_forces<false>(g);
}

template <class Real>
HWY_ATTR void begin_rows(const GridView<Real>& g, std::ptrdiff_t first) {
  g.fine ? carry_forces<true>(g, first) : carry_forces<false>(g, first);
}

template <class Real>
HWY_ATTR void advance(const GridView<Real>& g, const GridStep<Real>& step, std::ptrdiff_t first,
                      std::ptrdiff_t last) {
  g.fine ? advance_rows<true>(g, step, first, last) : advance_rows<false>(g, step, first, last);
}

/// Takes over what moved in the model and its velocities, drifts, and stores the places into the
/// model. Accumulates the powers of the external forces in their line.
template <class Real>
HWY_ATTR void drift(const GridView<Real>& g, Real dt, bool has_external, const Real* v, Real* x) {
  Real* const power = g.scratch + kPowerLine * g.scratch_line();
  visit_places(g, x,
               [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number, auto& place,
                   auto& lost) HWY_ATTR {
                 const auto speed = load_particles(d, v + number);
                 const auto seconds = hn::Set(d, dt);
                 place = {drifted(d, place.x, speed.x, seconds, lost.x),
                          drifted(d, place.y, speed.y, seconds, lost.y),
                          drifted(d, place.z, speed.z, seconds, lost.z)};
                 store_particles(d, place + origin_of(d, g), x + number);
                 store(d, speed,
                       g.motion + r * g.pitch() + c + GridView<Real>::kVelocityLine * g.line,
                       g.line);
                 if (!has_external) return;
                 const auto external = load(d, g.external + 3 * r * g.line + c, g.line);
                 hn::StoreU(fused_dot(d, external, speed, hn::LoadU(d, power + c)), d, power + c);
               });
}

/// Takes over what moved in the model, and its velocities.
template <class Real>
HWY_ATTR void take_motion(const GridView<Real>& g, const Real* x, const Real* v) {
  visit_places(g, x,
               [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number, auto&, auto&)
                   HWY_ATTR {
                     store(d, load_particles(d, v + number),
                           g.motion + r * g.pitch() + c + GridView<Real>::kVelocityLine * g.line,
                           g.line);
                   });
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
