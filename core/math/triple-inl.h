// Triples of vector registers: one spatial vector per lane.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_TRIPLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_TRIPLE_INL_H
#undef WEFT_TRIPLE_INL_H
#else
#define WEFT_TRIPLE_INL_H
#endif

#include <array>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Three components in vector registers, one particle, spring, edge or triangle per lane.
template <class V>
struct Triple {
  V x, y, z;
};

template <class V>
HWY_INLINE Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class V>
HWY_INLINE Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

template <class V>
HWY_INLINE Triple<V> operator*(const Triple<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class V>
HWY_INLINE Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

template <class M, class V>
HWY_INLINE Triple<V> select(M mask, const Triple<V>& yes, const Triple<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

template <class M, class V>
HWY_INLINE Triple<V> drop_if(M mask, const Triple<V>& a) {
  return {hn::IfThenZeroElse(mask, a.x), hn::IfThenZeroElse(mask, a.y),
          hn::IfThenZeroElse(mask, a.z)};
}

#if HWY_TARGET != HWY_SCALAR
/// Transposes quads, of which vector k holds every fourth one from the k-th on: the results hold
/// their first, second, third and fourth numbers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE std::array<V, 4> transposed_four(D d, V p0, V p1, V p2, V p3) {
  const hn::Repartition<double, D> wide;
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, p0, p1)),
             xy23 = hn::BitCast(wide, hn::InterleaveLower(d, p2, p3)),
             zw01 = hn::BitCast(wide, hn::InterleaveUpper(d, p0, p1)),
             zw23 = hn::BitCast(wide, hn::InterleaveUpper(d, p2, p3));
  return {hn::BitCast(d, hn::InterleaveLower(wide, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveUpper(wide, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveLower(wide, zw01, zw23)),
          hn::BitCast(d, hn::InterleaveUpper(wide, zw01, zw23))};
}

/// The first three of them.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> transposed(D d, V p0, V p1, V p2, V p3) {
  const auto four = transposed_four(d, p0, p1, p2, p3);
  return {four[0], four[1], four[2]};
}

/// The inverse, with 0 as the fourth number of the quads.
template <class D, class V = hn::Vec<D>>
HWY_INLINE std::array<V, 4> transposed_back(D d, const Triple<V>& a) {
  const hn::Repartition<double, D> wide;
  const auto zero = hn::Zero(d);
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, a.x, a.y)),
             xy23 = hn::BitCast(wide, hn::InterleaveUpper(d, a.x, a.y)),
             z01 = hn::BitCast(wide, hn::InterleaveLower(d, a.z, zero)),
             z23 = hn::BitCast(wide, hn::InterleaveUpper(d, a.z, zero));
  return {hn::BitCast(d, hn::InterleaveLower(wide, xy01, z01)),
          hn::BitCast(d, hn::InterleaveUpper(wide, xy01, z01)),
          hn::BitCast(d, hn::InterleaveLower(wide, xy23, z23)),
          hn::BitCast(d, hn::InterleaveUpper(wide, xy23, z23))};
}
#endif

/// Loads consecutive particles, x y z each.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load_particles(D d, const Real* from) {
  Triple<hn::Vec<D>> a;
  hn::LoadInterleaved3(d, from, a.x, a.y, a.z);
  return a;
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void store_particles(D d, const Triple<hn::Vec<D>>& a, Real* to) {
  hn::StoreInterleaved3(a.x, a.y, a.z, d, to);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
