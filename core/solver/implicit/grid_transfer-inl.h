// Restriction and prolongation for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_TRANSFER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_TRANSFER_INL_H
#undef WEFT_GRID_TRANSFER_INL_H
#else
#define WEFT_GRID_TRANSFER_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/math/kernels.h"
#include "core/math/lanes-inl.h"
#include "core/solver/implicit/grid_planes-inl.h"
#include "core/solver/implicit/grid_transfer.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A fine row and its weight.
template <class Real>
struct Share {
  std::ptrdiff_t row;
  Real weight;
};

/// line = row a + weighted b + weighted c, followed by zeros.
/// @param at  loads a vector of numbers of the fine level
/// @returns   start of the line
template <class Real, class Numbers>
HWY_INLINE Real* add_up_rows(const Numbers& at, std::ptrdiff_t a, Share<Real> b, Share<Real> c,
                             int columns, AlignedVector<Real>& line) {
  const hn::ScalableTag<Real> d;
  Real* const to = line.data() + kGridMargin;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto wb = hn::Set(d, b.weight), wc = hn::Set(d, c.weight);
  std::ptrdiff_t k = 0;
  for (; k < columns; k += lanes) {
    auto sum = at(d, a + k);
    if (b.weight > 0) sum = fused(d, at(d, b.row + k), wb, sum);
    if (c.weight > 0) sum = fused(d, at(d, c.row + k), wc, sum);
    hn::StoreU(sum, d, to + k);
  }
  // Coarse vectors extend up to two fine ones beyond the last column.
  for (const std::ptrdiff_t end = columns + 2 * lanes; k < end; k += lanes)
    hn::StoreU(hn::Zero(d), d, to + k);
  return to;
}

/// Coarse row `r`: the fine row on its line plus half of the adjacent fine rows.
template <class Real, class Numbers>
HWY_INLINE Real* add_up_about(const Numbers& at, const GridLayout& fine, int r,
                              AlignedVector<Real>& line) {
  const int here = r * 2 < fine.rows ? r * 2 : fine.rows - 1;
  // Only fine rows that the coarse level drops are shared.
  const bool before = r > 0 && here == r * 2, behind = here + 2 < fine.rows;
  const std::ptrdiff_t row = fine.at(here, 0);
  return add_up_rows<Real>(at, row, {row - fine.stride, before ? Real(0.5) : Real(0)},
                           {row + fine.stride, behind ? Real(0.5) : Real(0)}, fine.columns, line);
}

/// to(c) = line(2c) + half of line(2c - 1) and line(2c + 1); the last of an even number of columns
/// is copied.
template <class Real>
HWY_INLINE void gather_about(Real* line, int columns, int coarse_columns, Real* to) {
  const hn::ScalableTag<Real> d;
  const bool short_last = columns % 2 == 0;
  const Real last = line[columns - 1];
  if (short_last) line[columns - 1] = 0;
  const auto half = hn::Set(d, Real(0.5));
  for (std::ptrdiff_t c = 0; c < coarse_columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    hn::Vec<decltype(d)> here, behind, unused, before;
    hn::LoadInterleaved2(d, line + 2 * c, here, behind);
    hn::LoadInterleaved2(d, line + 2 * c - 2, unused, before);
    hn::StoreU(fused(d, hn::Add(before, behind), half, here), d, to + c);
  }
  if (short_last) to[coarse_columns - 1] = last;
}

template <class Real>
HWY_ATTR void restrict_rows(const GridLayout& fine, const GridLayout& coarse, const Real* from,
                            Real* to, TransferLines<Real>& lines) {
  const auto at = [from](auto d, std::ptrdiff_t k) HWY_ATTR { return hn::LoadU(d, from + k); };
  for (int r = 0; r < coarse.rows; ++r)
    gather_about(add_up_about(at, fine, r, lines.fine), fine.columns, coarse.columns,
                 to + coarse.at(r, 0));
}

/// wide(2c) = line(c), wide(2c + 1) = mean of line(c) and line(c + 1); the last of an even number
/// of columns is copied.
template <class Real>
HWY_INLINE void interpolate(const Real* line, int columns, int coarse_columns, Real* wide) {
  const hn::ScalableTag<Real> d;
  const auto half = hn::Set(d, Real(0.5));
  for (std::ptrdiff_t c = 0; c < coarse_columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const auto here = hn::LoadU(d, line + c), behind = hn::LoadU(d, line + c + 1);
    hn::StoreInterleaved2(here, hn::Mul(hn::Add(here, behind), half), d, wide + 2 * c);
  }
  if (columns % 2 == 0) wide[columns - 1] = line[coarse_columns - 1];
}

template <class Real>
HWY_ATTR void prolong_rows(const GridLayout& fine, const GridLayout& coarse, const Real* free,
                           const Real* from, Real* to, TransferLines<Real>& lines) {
  const hn::ScalableTag<Real> d;
  Real* const wide = lines.fine.data() + kGridMargin;
  for (int r = 0; r < fine.rows; ++r) {
    const bool kept = r % 2 == 0 || r + 1 == fine.rows;
    const Real *first = from + coarse.at(kept ? (r + 1) / 2 : r / 2, 0), *line = first;
    if (!kept) {
      Real* const mean = lines.coarse.data() + kGridMargin;
      const auto half = hn::Set(d, Real(0.5));
      for (std::ptrdiff_t c = 0; c < coarse.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d)))
        hn::StoreU(
            hn::Mul(hn::Add(hn::LoadU(d, first + c), hn::LoadU(d, first + coarse.stride + c)),
                    half),
            d, mean + c);
      line = mean;
    }
    interpolate(line, fine.columns, coarse.columns, wide);
    const std::ptrdiff_t row = fine.at(r, 0);
    for (std::ptrdiff_t c = 0; c < fine.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      const auto is_free = hn::Gt(hn::LoadU(d, free + row + c), hn::Zero(d));
      const auto now = hn::LoadU(d, to + row + c);
      hn::StoreU(hn::Add(now, hn::IfThenElseZero(is_free, hn::LoadU(d, wide + c))), d,
                 to + row + c);
    }
  }
}

/// to(c) = (line(2c) + line(2c + 1)) / 4; for a short last cell, all of line(2c).
template <class Real>
HWY_INLINE void gather_pairs(const Real* line, int columns, int coarse_columns, Real short_share,
                             Real share, Real* to) {
  const hn::ScalableTag<Real> d;
  const auto factor = hn::Set(d, share);
  for (std::ptrdiff_t c = 0; c < coarse_columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    hn::Vec<decltype(d)> here, behind;
    hn::LoadInterleaved2(d, line + 2 * c, here, behind);
    hn::StoreU(hn::Mul(hn::Add(here, behind), factor), d, to + c);
  }
  if (columns % 2 == 0) to[coarse_columns - 2] = line[columns - 2] * short_share;
}

/// Coarse row `r` of component `e` of all blocks.
template <template <class> class Blocks, class Real>
HWY_INLINE void coarsen_row(const SpringGrid<Real>& fine, int r, std::size_t e,
                            SpringGrid<Real>& coarse, AlignedVector<Real>& line) {
  const GridLayout &f = fine.layout, &g = coarse.layout;
  constexpr Real kQuarter = Real(0.25);
  const auto numbers = [&](std::size_t kind) HWY_ATTR {
    return [blocks = Blocks<Real>(fine.springs[kind]), e](auto d, std::ptrdiff_t k)
               HWY_ATTR { return blocks.number(d, e, k); };
  };
  const auto to = [&](std::size_t kind)
                      HWY_ATTR { return coarse.springs[kind][e].data() + g.at(r, 0); };
  gather_pairs(add_up_about(numbers(kAlong), f, r, line), f.columns, g.columns, Real(1), kQuarter,
               to(kAlong));
  if (r + 1 == g.rows) return;  // no cells below the last row
  const bool is_short = r * 2 + 2 == f.rows;
  const std::ptrdiff_t row = f.at(2 * r, 0);
  const auto both = [&](std::size_t kind) HWY_ATTR {
    return add_up_rows<Real>(numbers(kind), row, {row + f.stride, is_short ? Real(0) : Real(1)},
                             {row, 0}, f.columns, line);
  };
  Real* const down = to(kDown);
  gather_about(both(kDown), f.columns, g.columns, down);
  if (!is_short) {
    for (int c = 0; c < g.columns; ++c) down[c] *= kQuarter;
  }
  for (const GridSpring kind : {kFalling, kRising})
    gather_pairs(both(kind), f.columns, g.columns, is_short ? Real(1) : kQuarter, kQuarter,
                 to(kind));
}

template <class Real>
HWY_ATTR void coarsen_grid(const SpringGrid<Real>& fine, SpringGrid<Real>& coarse,
                           TransferLines<Real>& lines) {
  for (int r = 0; r < coarse.layout.rows; ++r) {
    for (std::size_t e = 0; e < 6; ++e) {
      fine.factored ? coarsen_row<FactoredBlocks>(fine, r, e, coarse, lines.fine)
                    : coarsen_row<PlaneBlocks>(fine, r, e, coarse, lines.fine);
    }
  }
}

WEFT_KERNEL(restrict_rows);
WEFT_KERNEL(prolong_rows);
WEFT_KERNEL(coarsen_grid);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
