// Helpers for vector code that give the same bits on every instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_LANES_INL_H
#undef WEFT_LANES_INL_H
#else
#define WEFT_LANES_INL_H
#endif

#include <cmath>
#include <cstddef>

#include <hwy/highway.h>

#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls body(d, n) for elements from number n on, as many as a vector has lanes, and then, with
/// one lane, for each of the remaining ones.
/// @tparam Lanes  of a vector at most
template <class Real, std::size_t Lanes = 16, class Body>
HWY_INLINE void for_each_vector(std::size_t count, Body&& body) {
  const hn::CappedTag<Real, Lanes> wide;
  const hn::CappedTag<Real, 1> single;
  std::size_t n = 0;
  for (; n + hn::Lanes(wide) <= count; n += hn::Lanes(wide)) body(wide, n);
  for (; n < count; ++n) body(single, n);
}

/// a b + c with a single rounding. Without such an instruction it is computed lane by lane, so that
/// the bits are the same everywhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V fused(D d, V a, V b, V c) {
#if HWY_NATIVE_FMA
  (void)d;
  return hn::MulAdd(a, b, c);
#else
  using Real = hn::TFromD<D>;
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  HWY_ALIGN Real x[kLanes], y[kLanes], z[kLanes];
  hn::Store(a, d, x);
  hn::Store(b, d, y);
  hn::Store(c, d, z);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) z[k] = std::fma(x[k], y[k], z[k]);
  return hn::Load(d, z);
#endif
}

/// c - a b with a single rounding.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V fused_minus(D d, V a, V b, V c) {
#if HWY_NATIVE_FMA
  (void)d;
  return hn::NegMulAdd(a, b, c);
#else
  return fused(d, hn::Neg(a), b, c);
#endif
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> fused(D d, const Triple<V>& a, V s, const Triple<V>& c) {
  return {fused(d, a.x, s, c.x), fused(d, a.y, s, c.y), fused(d, a.z, s, c.z)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> fused_minus(D d, const Triple<V>& a, V s, const Triple<V>& c) {
  return {fused_minus(d, a.x, s, c.x), fused_minus(d, a.y, s, c.y), fused_minus(d, a.z, s, c.z)};
}

/// a . b + c
template <class D, class V = hn::Vec<D>>
HWY_INLINE V fused_dot(D d, const Triple<V>& a, const Triple<V>& b, V c) {
  return fused(d, a.x, b.x, fused(d, a.y, b.y, fused(d, a.z, b.z, c)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V fused_dot(D d, const Triple<V>& a, const Triple<V>& b) {
  return fused(d, a.x, b.x, fused(d, a.y, b.y, hn::Mul(a.z, b.z)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> fused_cross(D d, const Triple<V>& a, const Triple<V>& b) {
  return {fused_minus(d, a.z, b.y, hn::Mul(a.y, b.z)), fused_minus(d, a.x, b.z, hn::Mul(a.z, b.x)),
          fused_minus(d, a.y, b.x, hn::Mul(a.x, b.y))};
}

/// Shifts vectors of a row one lane up: each lane gets its left neighbour, lane 0 the last lane of
/// the vector before.
template <class D>
class OneLaneUp {
  using V = hn::Vec<D>;
  using Int = hn::TFromD<hn::RebindToSigned<D>>;
  using Indices = decltype(hn::SetTableIndices(D(), static_cast<const Int*>(nullptr)));

 public:
  HWY_INLINE OneLaneUp() : indices_(turned()), first_(hn::FirstN(D(), 1)) {}

  /// @param before  state left by the previous vector; zero at the start of a row
  HWY_INLINE V operator()(V& before, V a) const {
    const V turned = hn::TableLookupLanes(a, indices_);
    const V shifted = hn::IfThenElse(first_, before, turned);
    before = turned;
    return shifted;
  }
  HWY_INLINE Triple<V> operator()(Triple<V>& before, const Triple<V>& a) const {
    return {(*this)(before.x, a.x), (*this)(before.y, a.y), (*this)(before.z, a.z)};
  }

 private:
  static HWY_INLINE Indices turned() {
    const std::size_t lanes = hn::Lanes(D());
    Int from[hn::MaxLanes(D())];
    for (std::size_t k = 0; k < lanes; ++k) from[k] = static_cast<Int>((k + lanes - 1) % lanes);
    return hn::SetTableIndices(D(), from);
  }

  Indices indices_;
  hn::Mask<D> first_;
};

/// 1 / sqrt(a) for a > 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_root(D d, V a) {
  return hn::Div(hn::Set(d, hn::TFromD<D>(1)), hn::Sqrt(a));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
