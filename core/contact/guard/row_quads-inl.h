// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_ROW_QUADS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_ROW_QUADS_INL_H
#undef WEFT_ROW_QUADS_INL_H
#else
#define WEFT_ROW_QUADS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "core/contact/guard/row_blocks.h"
#include "core/math/quad.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether quads are loaded whole and transposed, which is faster than number by number.
template <class Real>
inline constexpr bool kTransposes = HWY_TARGET != HWY_SCALAR && sizeof(Real) == 4;

#if HWY_TARGET != HWY_SCALAR
/// The quads of the k-th row's particle and, if a vector has two quads, of that four rows behind.
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

/// @param rows  as many are to be given something
template <class D>
HWY_INLINE void store_quads(D d, hn::Vec<D> a, float* quads, const std::uint32_t* place,
                            std::size_t k, std::size_t rows) {
  if constexpr (hn::MaxLanes(d) == 4) {
    if (k < rows) hn::Store(a, d, quads + place[k]);
  } else {
    const hn::Half<D> half;
    if (k < rows) hn::Store(hn::LowerHalf(half, a), half, quads + place[k]);
    if (k + 4 < rows) hn::Store(hn::UpperHalf(half, a), half, quads + place[k + 4]);
  }
}

/// Four numbers of as many rows as there are lanes. @param first  the first number of a row
template <class D>
HWY_INLINE std::array<hn::Vec<D>, 4> load_four(D d, const GuardRow<float>* const* rows,
                                               std::size_t first) {
  const auto quads = [&](std::size_t k) HWY_ATTR {
    const auto at = [&](std::size_t j)
                        HWY_ATTR { return reinterpret_cast<const float*>(rows[j]) + first; };
    if constexpr (hn::MaxLanes(d) == 4) {
      return hn::LoadU(d, at(k));
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, hn::LoadU(half, at(k + 4)), hn::LoadU(half, at(k)));
    }
  };
  return transposed_four(d, quads(0), quads(1), quads(2), quads(3));
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
  HWY_ALIGN Real of[3][kBatchRows];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    for (std::size_t c = 0; c < 3; ++c) of[c][k] = numbers[place[k] + c];
  }
  return {hn::Load(d, of[0]), hn::Load(d, of[1]), hn::Load(d, of[2])};
}

/// Gives it to the particles of the first rows.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void scatter_quads(D d, const Triple<hn::Vec<D>>& a, Quad<Real>* quads,
                              const std::uint32_t* place, std::size_t rows) {
  Real* const numbers = reinterpret_cast<Real*>(quads);
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kTransposes<Real>) {
    const auto of_row = transposed_back(d, a);
    for (std::size_t k = 0; k < 4; ++k) store_quads(d, of_row[k], numbers, place, k, rows);
    return;
  }
#endif
  HWY_ALIGN Real of[3][kBatchRows];
  hn::Store(a.x, d, of[0]);
  hn::Store(a.y, d, of[1]);
  hn::Store(a.z, d, of[2]);
  for (std::size_t k = 0; k < std::min(rows, hn::Lanes(d)); ++k) {
    for (std::size_t c = 0; c < 3; ++c) numbers[place[k] + c] = of[c][k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
