// Matrix operations of a grid level for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_SPRING_GRID_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SPRING_GRID_INL_H
#undef WEFT_SPRING_GRID_INL_H
#else
#define WEFT_SPRING_GRID_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/math/kernels.h"
#include "core/solver/implicit/grid_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// @tparam Blocks  storage of the springs' blocks
template <template <class> class Blocks, class Real>
HWY_INLINE void multiply_grid(const SpringGrid<Real>& g, const Real* vector, Real* product) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const GridLayout& layout = g.layout;
  const std::ptrdiff_t s = layout.stride;
  const PlaneVector<Real> p(layout, vector);
  const Blocks<Real> along(g.springs[kAlong]), down(g.springs[kDown]), falling(g.springs[kFalling]),
      rising(g.springs[kRising]);
  const PlaneBlocks<Real> air(g.air);
  const bool bends = g.bends();
  for (int r = 0; r < layout.rows; ++r) {
    for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      const std::ptrdiff_t k = layout.at(r, 0) + c;
      const Triple<V> here = p(d, k);
      Triple<V> sum = here * hn::LoadU(d, g.inertia.data() + k);
      if (g.has_air) sum = air.times(d, k, here, sum);
      sum = along.times(d, k, here - p(d, k + 1), sum);
      sum = along.times(d, k - 1, here - p(d, k - 1), sum);
      sum = down.times(d, k, here - p(d, k + s), sum);
      sum = down.times(d, k - s, here - p(d, k - s), sum);
      sum = falling.times(d, k, here - p(d, k + s + 1), sum);
      sum = falling.times(d, k - s - 1, here - p(d, k - s - 1), sum);
      sum = rising.times(d, k - 1, here - p(d, k + s - 1), sum);
      sum = rising.times(d, k - s, here - p(d, k - s + 1), sum);
      if (bends) sum = add_bending(d, g, p, r, c, sum);
      store_planes(d, only(is_free(d, g, k), sum), layout.plane, product + k);
    }
  }
}

/// @param y  product of z, or null for z = 0
template <class Real>
HWY_ATTR void smooth_grid(const SpringGrid<Real>& g, Real omega, const Real* residual,
                          const Real* y, Real* z) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const GridLayout& layout = g.layout;
  const PlaneBlocks<Real> inverse(g.inverse);
  const PlaneVector<Real> r(layout, residual), done(layout, y ? y : residual), now(layout, z);
  const V w = hn::Set(d, omega), zero = hn::Zero(d);
  for (int row = 0; row < layout.rows; ++row) {
    for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      const std::ptrdiff_t k = layout.at(row, 0) + c;
      const Triple<V> left = y ? r(d, k) - done(d, k) : r(d, k);
      const Triple<V> step = inverse.times(d, k, left, {zero, zero, zero});
      const Triple<V> from = y ? now(d, k) : Triple<V>{zero, zero, zero};
      store_planes(d, fused(d, step, w, from), layout.plane, z + k);
    }
  }
}

/// Sums kGridMargin interleaved partial sums, which are added to doubles from time to time.
template <class Real>
HWY_ATTR double dot_product(const Real* a, const Real* b, std::size_t count) {
  const hn::CappedTag<Real, static_cast<std::size_t>(kGridMargin)> d;
  constexpr std::size_t kStripe = static_cast<std::size_t>(kGridMargin), kOften = 64 * kStripe;
  double total = 0;
  for (std::size_t from = 0; from < count; from += kOften) {
    const std::size_t to = from + kOften < count ? from + kOften : count;
    HWY_ALIGN Real sums[kStripe] = {};
    for (std::size_t n = from; n < to; n += kStripe) {
      for (std::size_t j = 0; j < kStripe; j += hn::Lanes(d))
        hn::Store(fused(d, hn::LoadU(d, a + n + j), hn::LoadU(d, b + n + j), hn::Load(d, sums + j)),
                  d, sums + j);
    }
    for (const Real sum : sums) total += static_cast<double>(sum);
  }
  return total;
}

/// y = s a + y, or y = a + s y.
template <class Real>
HWY_ATTR void combine(bool scale_y, Real s, const Real* a, Real* y, std::size_t count) {
  const hn::CappedTag<Real, static_cast<std::size_t>(kGridMargin)> d;
  const auto factor = hn::Set(d, s);
  for (std::size_t n = 0; n < count; n += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, a + n), z = hn::LoadU(d, y + n);
    hn::StoreU(scale_y ? fused(d, z, factor, x) : fused(d, x, factor, z), d, y + n);
  }
}

/// Inverses of diagonal blocks; see `invert_diagonal`.
template <template <class> class Blocks, class Real>
HWY_INLINE void invert_grid(SpringGrid<Real>& g) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const GridLayout& layout = g.layout;
  const std::ptrdiff_t s = layout.stride;
  constexpr std::size_t kDiagonal[] = {0, 3, 5};
  const Blocks<Real> springs[4] = {Blocks<Real>(g.springs[0]), Blocks<Real>(g.springs[1]),
                                   Blocks<Real>(g.springs[2]), Blocks<Real>(g.springs[3])};
  const std::ptrdiff_t first[4] = {0, 0, 0, -1}, second[4] = {-1, -s, -s - 1, -s};
  for (int r = 0; r < layout.rows; ++r) {
    for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      const std::ptrdiff_t k = layout.at(r, 0) + c;
      V a[6];
      for (std::size_t e = 0; e < 6; ++e) {
        a[e] = g.has_air ? hn::LoadU(d, g.air[e].data() + k) : hn::Zero(d);
        for (std::size_t kind = 0; kind < 4; ++kind)
          a[e] = hn::Add(a[e], hn::Add(springs[kind].number(d, e, k + first[kind]),
                                       springs[kind].number(d, e, k + second[kind])));
      }
      const V inertia = hn::LoadU(d, g.inertia.data() + k);
      for (const std::size_t e : kDiagonal) a[e] = hn::Add(a[e], inertia);
      if (g.bends()) {
        const V bound = hn::LoadU(d, g.bending_bound.data() + k);
        for (const std::size_t e : kDiagonal) a[e] = hn::Add(a[e], bound);
      }
      const V xx = fused_minus(d, a[4], a[4], hn::Mul(a[3], a[5]));
      const V xy = fused_minus(d, a[1], a[5], hn::Mul(a[2], a[4]));
      const V xz = fused_minus(d, a[2], a[3], hn::Mul(a[1], a[4]));
      const V determinant = fused_dot(d, Triple<V>{a[0], a[1], a[2]}, Triple<V>{xx, xy, xz});
      const auto regular = hn::And(is_free(d, g, k), hn::Gt(determinant, hn::Zero(d)));
      const V scale = hn::Div(hn::Set(d, Real(1)), determinant);
      const V adjugate[6] = {xx,
                             xy,
                             xz,
                             fused_minus(d, a[2], a[2], hn::Mul(a[0], a[5])),
                             fused_minus(d, a[0], a[4], hn::Mul(a[1], a[2])),
                             fused_minus(d, a[1], a[1], hn::Mul(a[0], a[3]))};
      for (std::size_t e = 0; e < 6; ++e)
        hn::StoreU(hn::IfThenElseZero(regular, hn::Mul(adjugate[e], scale)), d,
                   g.inverse[e].data() + k);
    }
  }
}

template <class Real>
HWY_ATTR void multiply_springs(const SpringGrid<Real>& g, const Real* p, Real* y) {
  g.factored ? multiply_grid<FactoredBlocks>(g, p, y) : multiply_grid<PlaneBlocks>(g, p, y);
}

template <class Real>
HWY_ATTR void invert_blocks(SpringGrid<Real>& g) {
  g.factored ? invert_grid<FactoredBlocks>(g) : invert_grid<PlaneBlocks>(g);
}

WEFT_KERNEL(multiply_springs);
WEFT_KERNEL(smooth_grid);
WEFT_KERNEL(dot_product);
WEFT_KERNEL(combine);
WEFT_KERNEL(invert_blocks);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
