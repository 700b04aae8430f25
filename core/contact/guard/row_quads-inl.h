// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_ROW_QUADS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_ROW_QUADS_INL_H
#undef WEFT_ROW_QUADS_INL_H
#else
#define WEFT_ROW_QUADS_INL_H
#endif

#include <array>
#include <cstddef>

#include <hwy/highway.h>

#include "core/contact/guard/row_blocks.h"
#include "core/math/quads-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR
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

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
