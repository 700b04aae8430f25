// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_SPRING_GRID_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SPRING_GRID_INL_H
#undef WEFT_SPRING_GRID_INL_H
#else
#define WEFT_SPRING_GRID_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/math/lanes-inl.h"
#include "core/solver/implicit/spring_grid.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The three planes of a vector, or the six of symmetric blocks, at one place.
template <class Real>
struct PlaneVector {
  const Real *x, *y, *z;
  PlaneVector(const GridLayout& layout, const Real* p)
      : x(p), y(p + layout.plane), z(p + 2 * layout.plane) {}
  template <class D>
  HWY_INLINE Triple<hn::Vec<D>> operator()(D d, std::ptrdiff_t k) const {
    return {hn::LoadU(d, x + k), hn::LoadU(d, y + k), hn::LoadU(d, z + k)};
  }
};

template <class Real>
struct PlaneBlocks {
  const Real *xx, *xy, *xz, *yy, *yz, *zz;
  explicit PlaneBlocks(const std::array<AlignedVector<Real>, 6>& b)
      : xx(b[0].data()), xy(b[1].data()), xz(b[2].data()), yy(b[3].data()), yz(b[4].data()),
        zz(b[5].data()) {}
  /// sum + block at k times u
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE Triple<V> times(D d, std::ptrdiff_t k, const Triple<V>& u,
                             const Triple<V>& sum) const {
    const V b = hn::LoadU(d, xy + k), c = hn::LoadU(d, xz + k), e = hn::LoadU(d, yz + k);
    return {fused_dot(d, {hn::LoadU(d, xx + k), b, c}, u, sum.x),
            fused_dot(d, {b, hn::LoadU(d, yy + k), e}, u, sum.y),
            fused_dot(d, {c, e, hn::LoadU(d, zz + k)}, u, sum.z)};
  }
};

template <class D, class Real, class V>
HWY_INLINE void store_planes(D d, const Triple<V>& a, std::ptrdiff_t plane, Real* at) {
  hn::StoreU(a.x, d, at);
  hn::StoreU(a.y, d, at + plane);
  hn::StoreU(a.z, d, at + 2 * plane);
}

/// What bending adds to a row of the product.
template <class D, class Real, class V = hn::Vec<D>>
HWY_INLINE Triple<V> add_bending(D d, const SpringGrid<Real>& g, const PlaneVector<Real>& p, int r,
                                 std::ptrdiff_t c, const Triple<V>& sum) {
  const std::ptrdiff_t s = g.layout.stride, k = g.layout.at(r, 0) + c, table = kGridMargin + c;
  const std::array<Real, 4>& row = g.row_bend[static_cast<std::size_t>(r)];
  const V cells = hn::LoadU(d, g.cells.data() + table);
  const auto across = [&](std::ptrdiff_t at) HWY_ATTR {  // cells p_c - p_(c-1) - p_(c+1)
    const Triple<V> here = p(d, at), left = p(d, at - 1), right = p(d, at + 1);
    return here * cells - left - right;
  };
  const Triple<V> here = p(d, k);
  const auto line = [&](V w, V before, V behind, std::ptrdiff_t step) HWY_ATTR {
    Triple<V> l = p(d, k - 2 * step) + p(d, k + 2 * step);
    l = fused(d, p(d, k - step), before, l);
    l = fused(d, p(d, k + step), behind, l);
    return fused(d, here, w, l);
  };
  const Triple<V> u =
      line(hn::LoadU(d, g.bend.data() + table), hn::LoadU(d, g.bend_left.data() + table),
           hn::LoadU(d, g.bend_right.data() + table), 1);
  const Triple<V> v = line(hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2]), s);
  const Triple<V> twist = across(k) * hn::Set(d, row[3]) - across(k - s) - across(k + s);
  const V half = hn::Set(d, Real(0.5));
  const V along_u = hn::Set(d, g.bending.along_u * Real(0.5) * row[3]);
  const V along_v = hn::Mul(hn::Set(d, g.bending.along_v), hn::Mul(half, cells));
  return fused(d, u, along_u,
               fused(d, v, along_v, fused(d, twist, hn::Set(d, g.bending.twist), sum)));
}

template <class Real>
HWY_INLINE void multiply_grid(const SpringGrid<Real>& g, const Real* vector, Real* product) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const GridLayout& layout = g.layout;
  const std::ptrdiff_t s = layout.stride;
  const PlaneVector<Real> p(layout, vector);
  const PlaneBlocks<Real> own(g.own), along(g.springs[kAlong]), down(g.springs[kDown]),
      falling(g.springs[kFalling]), rising(g.springs[kRising]);
  const bool bends = g.bends();
  for (int r = 0; r < layout.rows; ++r) {
    for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
      const std::ptrdiff_t k = layout.at(r, 0) + c;
      const Triple<V> here = p(d, k);
      const V zero = hn::Zero(d);
      Triple<V> sum = own.times(d, k, here, {zero, zero, zero});
      sum = along.times(d, k, here - p(d, k + 1), sum);
      sum = along.times(d, k - 1, here - p(d, k - 1), sum);
      sum = down.times(d, k, here - p(d, k + s), sum);
      sum = down.times(d, k - s, here - p(d, k - s), sum);
      sum = falling.times(d, k, here - p(d, k + s + 1), sum);
      sum = falling.times(d, k - s - 1, here - p(d, k - s - 1), sum);
      sum = rising.times(d, k - 1, here - p(d, k + s - 1), sum);
      sum = rising.times(d, k - s, here - p(d, k - s + 1), sum);
      if (bends) sum = add_bending(d, g, p, r, c, sum);
      const V free = hn::LoadU(d, g.free.data() + k);
      store_planes(d, sum * free, layout.plane, product + k);
    }
  }
}

template <class Real>
HWY_INLINE void bend_grid(const SpringGrid<Real>& g, const Real* vector, Real* product) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const PlaneVector<Real> p(g.layout, vector);
  const V zero = hn::Zero(d);
  for (int r = 0; r < g.layout.rows; ++r) {
    for (std::ptrdiff_t c = 0; c < g.layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d)))
      store_planes(d, add_bending(d, g, p, r, c, Triple<V>{zero, zero, zero}), g.layout.plane,
                   product + g.layout.at(r, 0) + c);
  }
}

/// @param y  product of z, or null where z counts as 0
template <class Real>
HWY_INLINE void smooth_grid(const SpringGrid<Real>& g, Real omega, const Real* residual,
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

/// Stripes of kGridMargin numbers are summed one beside the other, and now and then in double.
template <class Real>
HWY_INLINE double dot_product(const Real* a, const Real* b, std::size_t count) {
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
HWY_INLINE void combine(bool scale_y, Real s, const Real* a, Real* y, std::size_t count) {
  const hn::CappedTag<Real, static_cast<std::size_t>(kGridMargin)> d;
  const auto factor = hn::Set(d, s);
  for (std::size_t n = 0; n < count; n += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, a + n), z = hn::LoadU(d, y + n);
    hn::StoreU(scale_y ? fused(d, z, factor, x) : fused(d, x, factor, z), d, y + n);
  }
}

HWY_ATTR void multiply_f32(const SpringGrid<float>& g, const float* p, float* y) {
  multiply_grid(g, p, y);
}
HWY_ATTR void multiply_f64(const SpringGrid<double>& g, const double* p, double* y) {
  multiply_grid(g, p, y);
}
HWY_ATTR void bend_f32(const SpringGrid<float>& g, const float* p, float* y) {
  bend_grid(g, p, y);
}
HWY_ATTR void bend_f64(const SpringGrid<double>& g, const double* p, double* y) {
  bend_grid(g, p, y);
}
HWY_ATTR void smooth_f32(const SpringGrid<float>& g, float w, const float* r, const float* y,
                         float* z) {
  smooth_grid(g, w, r, y, z);
}
HWY_ATTR void smooth_f64(const SpringGrid<double>& g, double w, const double* r, const double* y,
                         double* z) {
  smooth_grid(g, w, r, y, z);
}
HWY_ATTR double dot_f32(const float* a, const float* b, std::size_t count) {
  return dot_product(a, b, count);
}
HWY_ATTR double dot_f64(const double* a, const double* b, std::size_t count) {
  return dot_product(a, b, count);
}
HWY_ATTR void combine_f32(bool scale_y, float s, const float* a, float* y, std::size_t count) {
  combine(scale_y, s, a, y, count);
}
HWY_ATTR void combine_f64(bool scale_y, double s, const double* a, double* y, std::size_t count) {
  combine(scale_y, s, a, y, count);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
