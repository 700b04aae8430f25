// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_PATCH_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_PATCH_BOXES_INL_H
#undef WEFT_PATCH_BOXES_INL_H
#else
#define WEFT_PATCH_BOXES_INL_H
#endif

#include <algorithm>
#include <bit>

#include <hwy/highway.h>

#include "core/contact/guard/patch_boxes.h"
#include "core/math/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The boxes that overlap a given one, a bit each.
/// @param box    its lower x y z, upper x y z
/// @param pitch  from each of these to the next
template <class Real>
HWY_INLINE std::uint32_t overlap_one(const Real* box, std::size_t pitch,
                                     const BoxColumns<Real>& others) {
  const hn::CappedTag<Real, 8> d;  // whose bits are a byte
  using V = hn::Vec<decltype(d)>;
  const auto own = [&](std::size_t component)
                       HWY_ATTR { return hn::Set(d, box[component * pitch]); };
  const V lower[3] = {own(0), own(1), own(2)}, upper[3] = {own(3), own(4), own(5)};
  std::uint32_t found = 0;
  for (std::size_t n = 0; n < others.pitch; n += hn::Lanes(d)) {
    const Real* const other = others.numbers + n;
    auto both = hn::And(hn::Le(lower[0], hn::LoadU(d, other + 3 * others.pitch)),
                        hn::Le(hn::LoadU(d, other), upper[0]));
    for (std::size_t c = 1; c < 3; ++c) {
      both = hn::And(both, hn::Le(lower[c], hn::LoadU(d, other + (3 + c) * others.pitch)));
      both = hn::And(both, hn::Le(hn::LoadU(d, other + c * others.pitch), upper[c]));
    }
    std::uint8_t byte[8] = {};
    hn::StoreMaskBits(d, both, byte);
    found |= static_cast<std::uint32_t>(byte[0]) << n;
  }
  return found;
}

/// One box after the other against all of the other side, if it overlaps the box around these.
/// @param marked_a, marked_b  pairs without a marked one are left out
template <class Real>
HWY_INLINE void overlap(const BoxColumns<Real>& a, const BoxColumns<Real>& b, const Real* around_b,
                        std::uint32_t marked_a, std::uint32_t marked_b, PatchOverlaps::Bits& bits) {
  std::uint32_t near = overlap_one(around_b, 1, a);
  if (marked_b == 0) near &= marked_a;
  std::fill_n(bits.begin(), a.count, 0);
  for (; near != 0; near &= near - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(near));
    const std::uint32_t found = overlap_one(a.numbers + k, a.pitch, b);
    bits[k] = found & (((marked_a >> k) & 1) != 0 ? ~0u : marked_b);
  }
}

template <class Real>
HWY_ATTR void overlap_all(const PatchColumns<Real>& p, const PatchColumns<Real>& q,
                          const PatchMarks& marked_p, const PatchMarks& marked_q,
                          PatchOverlaps& overlaps) {
  overlap(p.vertices, q.triangles, q.whole, marked_p.vertices, marked_q.triangles,
          overlaps.first_vertices);
  overlap(q.vertices, p.triangles, p.whole, marked_q.vertices, marked_p.triangles,
          overlaps.second_vertices);
  overlap(p.edges, q.edges, q.whole, marked_p.edges, marked_q.edges, overlaps.first_edges);
}

WEFT_KERNEL(overlap_all);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
