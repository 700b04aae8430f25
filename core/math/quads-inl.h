// Quads of single particles in lanes.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_QUADS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_QUADS_INL_H
#undef WEFT_QUADS_INL_H
#else
#define WEFT_QUADS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "core/math/quad.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A place is the number of a quad times four. A vector has at most eight lanes.

/// Whether quads are loaded whole and transposed, which is faster than number by number.
template <class Real>
inline constexpr bool kTransposes = HWY_TARGET != HWY_SCALAR && sizeof(Real) == 4;

#if HWY_TARGET != HWY_SCALAR
/// The k-th quad and, if a vector has two quads, the fourth one after it.
template <class D>
HWY_INLINE hn::Vec<D> load_quads(D d, const float* quads, const std::uint32_t* place,
                                 std::size_t k) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Load(d, quads + place[k]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, hn::Load(half, quads + place[k + 4]), hn::Load(half, quads + place[k]));
  }
}

/// @param count  of the first places that are to be given something
template <class D>
HWY_INLINE void store_quads(D d, hn::Vec<D> a, float* quads, const std::uint32_t* place,
                            std::size_t k, std::size_t count) {
  if constexpr (hn::MaxLanes(d) == 4) {
    if (k < count) hn::Store(a, d, quads + place[k]);
  } else {
    const hn::Half<D> half;
    if (k < count) hn::Store(hn::LowerHalf(half, a), half, quads + place[k]);
    if (k + 4 < count) hn::Store(hn::UpperHalf(half, a), half, quads + place[k + 4]);
  }
}
#endif

/// What as many particles have as there are lanes.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> gather_quads(D d, const Quad<Real>* quads,
                                           const std::uint32_t* place) {
  const Real* const numbers = reinterpret_cast<const Real*>(quads);
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kTransposes<Real>) {
    return transposed(d, load_quads(d, numbers, place, 0), load_quads(d, numbers, place, 1),
                      load_quads(d, numbers, place, 2), load_quads(d, numbers, place, 3));
  }
#endif
  HWY_ALIGN Real of[3][hn::MaxLanes(D())];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    for (std::size_t c = 0; c < 3; ++c) of[c][k] = numbers[place[k] + c];
  }
  return {hn::Load(d, of[0]), hn::Load(d, of[1]), hn::Load(d, of[2])};
}

/// Gives it to the first of these particles.
/// @param numbers  of their quads
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void scatter_quads(D d, const Triple<hn::Vec<D>>& a, Real* numbers,
                              const std::uint32_t* place, std::size_t count) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kTransposes<Real>) {
    const auto of_particle = transposed_back(d, a);
    for (std::size_t k = 0; k < 4; ++k) store_quads(d, of_particle[k], numbers, place, k, count);
    return;
  }
#endif
  HWY_ALIGN Real of[3][hn::MaxLanes(D())];
  hn::Store(a.x, d, of[0]);
  hn::Store(a.y, d, of[1]);
  hn::Store(a.z, d, of[2]);
  for (std::size_t k = 0; k < std::min(count, hn::Lanes(d)); ++k) {
    for (std::size_t c = 0; c < 3; ++c) numbers[place[k] + c] = of[c][k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
