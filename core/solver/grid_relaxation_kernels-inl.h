// Compliant sweeps over a grid for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_RELAXATION_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_RELAXATION_KERNELS_INL_H
#undef WEFT_GRID_RELAXATION_KERNELS_INL_H
#else
#define WEFT_GRID_RELAXATION_KERNELS_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/forces/spring.h"
#include "core/math/kernels.h"
#include "core/math/triple-inl.h"
#include "core/solver/grid_relaxation.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class Pointer>
HWY_INLINE Triple<hn::Vec<D>> load_at(D d, const Pointer (&fields)[3], std::ptrdiff_t at) {
  return {hn::LoadU(d, fields[0] + at), hn::LoadU(d, fields[1] + at), hn::LoadU(d, fields[2] + at)};
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void store_at(D d, Real* const (&fields)[3], std::ptrdiff_t at,
                         const Triple<hn::Vec<D>>& a) {
  hn::StoreU(a.x, d, fields[0] + at);
  hn::StoreU(a.y, d, fields[1] + at);
  hn::StoreU(a.z, d, fields[2] + at);
}

/// Whether a sweep reads and writes multipliers.
template <bool Read, bool Write>
struct Multipliers {
  static constexpr bool kReads = Read, kWrites = Write;
};

/// Relaxes `count` springs of one colour: spring n joins particles i + n and j + n and has the
/// tables' entry k + n.
/// @param times  factor of `alpha` for each spring; null: 1
template <class Use, class D, class Real = hn::TFromD<D>>
HWY_INLINE void relax_line(Use, D d, const SweepView<Real>& g, std::size_t table, Real rest_length,
                           Real alpha, const hn::TFromD<D>* times, std::ptrdiff_t i,
                           std::ptrdiff_t j, std::ptrdiff_t k, std::ptrdiff_t count) {
  const auto length = hn::Set(d, rest_length), smallest = hn::Set(d, Real(kSmallestSquaredLength));
  const auto softness = hn::Set(d, alpha);
  const Real* share = g.share[table] + k;
  for (std::ptrdiff_t n = 0; n < count; n += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const auto old_i = load_at(d, g.displacement, i + n), old_j = load_at(d, g.displacement, j + n);
    const auto delta = (load_at(d, g.x, j + n) - load_at(d, g.x, i + n)) + (old_j - old_i);
    const auto l = hn::Sqrt(hn::Add(dot(delta, delta), smallest));
    auto excess = hn::Sub(l, length);
    if constexpr (Use::kReads) {
      const auto lambda = hn::LoadU(d, g.multiplier[table] + k + n);
      auto give = hn::Mul(softness, lambda);
      if (times != nullptr) give = hn::Mul(give, hn::LoadU(d, times + n));
      excess = hn::Sub(excess, give);
    }
    const auto dlambda = hn::Mul(hn::LoadU(d, share + n), excess);
    if constexpr (Use::kWrites) {
      auto lambda = dlambda;
      if constexpr (Use::kReads)
        lambda = hn::Add(hn::LoadU(d, g.multiplier[table] + k + n), dlambda);
      hn::StoreU(lambda, d, g.multiplier[table] + k + n);
    }
    const auto ratio = hn::Div(dlambda, l);
    const auto w_i = hn::LoadU(d, g.w + i + n), w_j = hn::LoadU(d, g.w + j + n);
    auto new_i = old_i + delta * hn::Mul(ratio, w_i), new_j = old_j - delta * hn::Mul(ratio, w_j);
    if (const std::ptrdiff_t left = count - n; left < static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      // Adding 0 to particles without such a spring could change the sign of a zero.
      const auto ends = hn::FirstN(d, static_cast<std::size_t>(left));
      new_i = select(ends, new_i, old_i);
      new_j = select(ends, new_j, old_j);
    }
    store_at(d, g.displacement, i + n, new_i);
    store_at(d, g.displacement, j + n, new_j);
  }
}

/// Springs along row r, in two colours.
template <class Use, class D, class Real = hn::TFromD<D>>
HWY_INLINE void relax_row(Use use, D d, const SweepView<Real>& g, int r) {
  const std::ptrdiff_t even = r * g.stride, odd = even + g.half;
  const bool border = r == 0 || r + 1 == g.rows;
  const Real alpha = border ? Real(2) * g.alpha[0] : g.alpha[0];
  relax_line(use, d, g, 0, g.length[0], alpha, nullptr, even, odd, even, g.columns / 2);
  relax_line(use, d, g, 0, g.length[0], alpha, nullptr, odd, even + 1, odd, (g.columns - 1) / 2);
}

/// Springs between rows r and r + 1; those of one direction share no particle.
template <class Use, class D, class Real = hn::TFromD<D>>
HWY_INLINE void relax_between_rows(Use use, D d, const SweepView<Real>& g, int r) {
  const std::ptrdiff_t even = r * g.stride, odd = even + g.half;
  const std::ptrdiff_t even_below = even + g.stride, odd_below = odd + g.stride;
  const std::ptrdiff_t evens = (g.columns + 1) / 2, odds = g.columns / 2;
  const Real down = g.length[1], diagonal = g.length[2];
  const Real a = g.alpha[1], b = g.alpha[2];
  relax_line(use, d, g, 1, down, a, g.softer, even, even_below, even, evens);
  relax_line(use, d, g, 1, down, a, g.softer + g.half, odd, odd_below, odd, odds);
  const std::ptrdiff_t cells = odds, more_cells = (g.columns - 1) / 2;
  relax_line(use, d, g, 2, diagonal, b, nullptr, even, odd_below, even, cells);
  relax_line(use, d, g, 2, diagonal, b, nullptr, odd, even_below + 1, odd, more_cells);
  relax_line(use, d, g, 3, diagonal, b, nullptr, odd, even_below, even, cells);
  relax_line(use, d, g, 3, diagonal, b, nullptr, even + 1, odd_below, odd, more_cells);
}

template <class Use, class Real>
HWY_INLINE void sweep_rows(Use use, const SweepView<Real>& g, bool down) {
  const hn::CappedTag<Real, kSweepMargin> d;
  for (int n = 0; n < g.rows; ++n) {
    const int r = down ? n : g.rows - 1 - n;
    if (down) relax_row(use, d, g, r);
    if (r + 1 < g.rows) relax_between_rows(use, d, g, r);
    if (!down) relax_row(use, d, g, r);
  }
}

template <class Real>
HWY_ATTR void sweep(const SweepView<Real>& g, bool down, bool first, bool last) {
  if (first && last)
    sweep_rows(Multipliers<false, false>(), g, down);
  else if (first)
    sweep_rows(Multipliers<false, true>(), g, down);
  else
    sweep_rows(Multipliers<true, true>(), g, down);
}

/// Positions of consecutive particles of a row and of their neighbours; `column` is the index of
/// the first in the tables by column.
struct Places {
  std::ptrdiff_t at, left, right, column;
};

/// Second differences about the three places in the middle of five of a line, with factors and the
/// weights 1 -2 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V bent_line(const V (&x)[5], const V (&factor)[3]) {
  const V a = hn::Sub(x[1], x[0]), b = hn::Sub(x[2], x[1]);
  const V c = hn::Sub(x[3], x[2]), e = hn::Sub(x[4], x[3]);
  const V middle = hn::Mul(hn::Sub(c, b), factor[1]);
  const V ends = hn::Add(hn::Mul(hn::Sub(b, a), factor[0]), hn::Mul(hn::Sub(e, c), factor[2]));
  return hn::Sub(ends, hn::Add(middle, middle));
}

/// Bending of one row in registers: the stencils of bending_stencil.h, summed per particle. It
/// begins with differences of neighbours, whose rounding is as small as they are: that of places
/// would not cancel in the sum of all forces. Beyond the border factors are 0.
template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>>
struct RowBending {
  D d;
  V rows[3], cell_up, cell_down;  ///< factors across the rows
  V along, across, twist;         ///< stiffnesses
  const Real *bend_left, *bend, *bend_right, *cell_left, *cell_right, *border;  ///< by column
  std::ptrdiff_t stride;

  HWY_INLINE RowBending(D tag, const SweepView<Real>& g, int r, std::ptrdiff_t column)
      : d(tag), bend_left(g.bend_left + column), bend(g.bend + column),
        bend_right(g.bend_right + column), cell_left(g.cell_left + column),
        cell_right(g.cell_right + column), border(g.border + column), stride(g.stride) {
    const BendingRow<Real>& line = g.row_bend[static_cast<std::size_t>(r)];
    rows[0] = hn::Set(d, line.before);
    rows[1] = hn::Set(d, line.here);
    rows[2] = hn::Set(d, line.behind);
    cell_up = hn::Set(d, line.cell_before);
    cell_down = hn::Set(d, line.cell_behind);
    along = hn::Set(d, Real(0.5) * line.cells() * g.bending.along_u);
    across = hn::Set(d, g.bending.along_v);
    twist = hn::Set(d, g.bending.twist);
  }

  /// One component of minus the force on particles n, n + 1, ...
  /// @param x,left,right  that component of the positions of particle 0 and of its neighbours
  HWY_INLINE V pull(const Real* x, const Real* left, const Real* right, std::ptrdiff_t n) const {
    const auto at = [&](const Real* p) HWY_ATTR { return hn::LoadU(d, p + n); };
    const V place = at(x), to_left = hn::Sub(at(left), place), to_right = hn::Sub(place, at(right));
    const V bent_along = bent_line<D>({at(x - 1), at(left), place, at(right), at(x + 1)},
                                      {at(bend_left), at(bend), at(bend_right)});
    const V up = at(x - stride), down = at(x + stride);
    const V bent_across =
        bent_line<D>({at(x - 2 * stride), up, place, down, at(x + 2 * stride)}, rows);
    const V has_left = at(cell_left), has_right = at(cell_right);
    // The twists of the cells between this row and another, the right one's less the left one's.
    const auto twists = [&](V other, std::ptrdiff_t row) HWY_ATTR {
      const V other_left = hn::Sub(at(left + row), other);
      const V other_right = hn::Sub(other, at(right + row));
      return hn::Sub(hn::Mul(hn::Sub(to_right, other_right), has_right),
                     hn::Mul(hn::Sub(to_left, other_left), has_left));
    };
    const V twisted =
        hn::Add(hn::Mul(twists(down, stride), cell_down), hn::Mul(twists(up, -stride), cell_up));
    return hn::Add(
        hn::Add(hn::Mul(bent_along, along), hn::Mul(bent_across, hn::Mul(across, at(border)))),
        hn::Mul(twisted, twist));
  }
};

/// Predicts one component of `count` consecutive particles in row r.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void predict_line(D d, const SweepView<Real>& g, const Prediction<Real>& step, int r,
                             int component, const Places& p, std::ptrdiff_t count) {
  const bool bends = g.bending.along_u != 0 || g.bending.along_v != 0 || g.bending.twist != 0;
  const bool forced = step.forced;
  const RowBending<D> bending(d, g, r, p.column);
  const auto dt2 = hn::Set(d, step.dt2), keep = hn::Set(d, step.keep);
  const auto gravity = hn::Set(d, step.gravity[component]);
  const Real *x = g.x[component] + p.at, *left = g.x[component] + p.left,
             *right = g.x[component] + p.right, *force = g.force[component] + p.at, *w = g.w + p.at,
             *free = g.free + p.at;
  Real* displacement = g.displacement[component] + p.at;
  for (std::ptrdiff_t n = 0; n < count; n += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const auto mobile = hn::LoadU(d, free + n), inverse_mass = hn::LoadU(d, w + n);
    auto acceleration = hn::Mul(gravity, mobile);
    if (bends)
      acceleration = hn::Sub(acceleration, hn::Mul(bending.pull(x, left, right, n), inverse_mass));
    if (forced)
      acceleration = hn::Add(acceleration, hn::Mul(hn::LoadU(d, force + n), inverse_mass));
    const auto kept = hn::Mul(hn::LoadU(d, displacement + n), hn::Mul(keep, mobile));
    hn::StoreU(hn::Add(kept, hn::Mul(acceleration, dt2)), d, displacement + n);
  }
}

template <class Real>
HWY_ATTR void predict(const SweepView<Real>& g, const Prediction<Real>& step) {
  const hn::CappedTag<Real, kSweepMargin> d;
  for (int r = 0; r < g.rows; ++r) {
    const std::ptrdiff_t even = r * g.stride, odd = even + g.half;
    for (int k = 0; k < 3; ++k) {
      predict_line(d, g, step, r, k, {even, odd - 1, odd, 0}, (g.columns + 1) / 2);
      predict_line(d, g, step, r, k, {odd, even, even + 1, g.half}, g.columns / 2);
    }
  }
}

template <class Real>
HWY_ATTR void move(const SweepView<Real>& g) {
  const hn::CappedTag<Real, kSweepMargin> d;
  const std::ptrdiff_t count = g.rows * g.stride;
  for (std::ptrdiff_t n = 0; n < count; n += static_cast<std::ptrdiff_t>(hn::Lanes(d)))
    store_at(d, g.x, n, load_at(d, g.x, n) + load_at(d, g.displacement, n));
}

WEFT_KERNEL(predict);
WEFT_KERNEL(sweep);
WEFT_KERNEL(move);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
