// Vector access to the planes of a grid level.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_PLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_PLANES_INL_H
#undef WEFT_GRID_PLANES_INL_H
#else
#define WEFT_GRID_PLANES_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/math/lanes-inl.h"
#include "core/solver/implicit/spring_grid.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Access to the three planes of a vector, or the six of symmetric blocks.
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
  /// sum + (block at k) times u
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE Triple<V> times(D d, std::ptrdiff_t k, const Triple<V>& u,
                             const Triple<V>& sum) const {
    const V b = hn::LoadU(d, xy + k), c = hn::LoadU(d, xz + k), e = hn::LoadU(d, yz + k);
    return {fused_dot(d, {hn::LoadU(d, xx + k), b, c}, u, sum.x),
            fused_dot(d, {b, hn::LoadU(d, yy + k), e}, u, sum.y),
            fused_dot(d, {c, e, hn::LoadU(d, zz + k)}, u, sum.z)};
  }
  /// Component e of the blocks from k on.
  template <class D>
  HWY_INLINE hn::Vec<D> number(D d, std::size_t e, std::ptrdiff_t k) const {
    const Real* const numbers[6] = {xx, xy, xz, yy, yz, zz};
    return hn::LoadU(d, numbers[e] + k);
  }
};

/// The same for blocks a I + s s^T.
template <class Real>
struct FactoredBlocks {
  const Real *x, *y, *z, *a;
  explicit FactoredBlocks(const std::array<AlignedVector<Real>, 6>& b)
      : x(b[0].data()), y(b[1].data()), z(b[2].data()), a(b[3].data()) {}
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE Triple<V> times(D d, std::ptrdiff_t k, const Triple<V>& u,
                             const Triple<V>& sum) const {
    const Triple<V> s{hn::LoadU(d, x + k), hn::LoadU(d, y + k), hn::LoadU(d, z + k)};
    return fused(d, s, fused_dot(d, s, u), fused(d, u, hn::LoadU(d, a + k), sum));
  }
  template <class D>
  HWY_INLINE hn::Vec<D> number(D d, std::size_t e, std::ptrdiff_t k) const {
    const Real* const first[6] = {x, x, x, y, y, z};
    const Real* const second[6] = {x, y, z, y, z, z};
    const auto i = hn::LoadU(d, first[e] + k), j = hn::LoadU(d, second[e] + k);
    if (e == 0 || e == 3 || e == 5) return fused(d, i, j, hn::LoadU(d, a + k));
    return hn::Mul(i, j);
  }
};

template <class D, class Real, class V>
HWY_INLINE void store_planes(D d, const Triple<V>& a, std::ptrdiff_t plane, Real* at) {
  hn::StoreU(a.x, d, at);
  hn::StoreU(a.y, d, at + plane);
  hn::StoreU(a.z, d, at + 2 * plane);
}

/// Lanes from k on that hold particles that are not pinned.
template <class D, class Real>
HWY_INLINE hn::Mask<D> is_free(D d, const SpringGrid<Real>& g, std::ptrdiff_t k) {
  return hn::Gt(hn::LoadU(d, g.free.data() + k), hn::Zero(d));
}

/// Zeroes the other lanes, even if they are NaN.
template <class M, class V>
HWY_INLINE Triple<V> only(M mask, const Triple<V>& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y),
          hn::IfThenElseZero(mask, a.z)};
}

/// Adds bending to a row of the product.
template <class D, class Real, class V = hn::Vec<D>>
HWY_INLINE Triple<V> add_bending(D d, const SpringGrid<Real>& g, const PlaneVector<Real>& p, int r,
                                 std::ptrdiff_t c, const Triple<V>& sum) {
  const std::ptrdiff_t s = g.layout.stride, k = g.layout.at(r, 0) + c;
  const BendingLine<Real>& row = g.row_bending[static_cast<std::size_t>(r)];
  const auto column = [&](std::ptrdiff_t number) HWY_ATTR {
    return hn::LoadU(d, g.column_bending.data() + number * g.bending_pitch() + kGridMargin + c);
  };
  const auto here = [&](std::ptrdiff_t at) HWY_ATTR { return p(d, k + at); };
  Triple<V> u = fused(d, here(-2), column(0), here(2) * column(4));
  u = fused(d, here(-1), column(1), fused(d, here(1), column(3), u));
  u = fused(d, here(0), column(2), u);
  const auto weight = [&](std::size_t number) HWY_ATTR { return hn::Set(d, row.bend[number]); };
  Triple<V> v = fused(d, here(-2 * s), weight(0), here(2 * s) * weight(4));
  v = fused(d, here(-s), weight(1), fused(d, here(s), weight(3), v));
  v = fused(d, here(0), weight(2), v);
  const V before = column(5), self = column(6), behind = column(7);
  const auto across = [&](std::ptrdiff_t at) HWY_ATTR {
    return fused(d, here(at), self, fused(d, here(at - 1), before, here(at + 1) * behind));
  };
  const Triple<V> twist =
      fused(d, across(0), hn::Set(d, row.slope[1]),
            fused(d, across(-s), hn::Set(d, row.slope[0]), across(s) * hn::Set(d, row.slope[2])));
  const V half = hn::Set(d, Real(0.5));
  const V along_u = hn::Set(d, g.bending.along_u * Real(0.5) * row.width);
  const V along_v = hn::Mul(hn::Set(d, g.bending.along_v), hn::Mul(half, column(8)));
  return fused(d, u, along_u,
               fused(d, v, along_v, fused(d, twist, hn::Set(d, g.bending.twist), sum)));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
