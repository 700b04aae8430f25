// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_PATCH_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_PATCH_BOXES_INL_H
#undef WEFT_PATCH_BOXES_INL_H
#else
#define WEFT_PATCH_BOXES_INL_H
#endif

#include <hwy/highway.h>

#include "core/contact/guard/patch_boxes.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One box after the other against all of the other side.
template <class Real>
HWY_INLINE void overlap(const BoxColumns<Real>& a, const BoxColumns<Real>& b,
                        PatchOverlaps::Bits& bits) {
  const hn::CappedTag<Real, 8> d;  // whose bits are a byte
  using V = hn::Vec<decltype(d)>;
  for (std::size_t k = 0; k < a.count; ++k) {
    const auto own = [&](std::size_t component)
                         HWY_ATTR { return hn::Set(d, a.numbers[component * a.pitch + k]); };
    const V lower[3] = {own(0), own(1), own(2)}, upper[3] = {own(3), own(4), own(5)};
    std::uint32_t found = 0;
    for (std::size_t n = 0; n < b.pitch; n += hn::Lanes(d)) {
      const Real* const other = b.numbers + n;
      auto both = hn::And(hn::Le(lower[0], hn::LoadU(d, other + 3 * b.pitch)),
                          hn::Le(hn::LoadU(d, other), upper[0]));
      for (std::size_t c = 1; c < 3; ++c) {
        both = hn::And(both, hn::Le(lower[c], hn::LoadU(d, other + (3 + c) * b.pitch)));
        both = hn::And(both, hn::Le(hn::LoadU(d, other + c * b.pitch), upper[c]));
      }
      std::uint8_t byte[8] = {};
      hn::StoreMaskBits(d, both, byte);
      found |= static_cast<std::uint32_t>(byte[0]) << n;
    }
    bits[k] = found;
  }
}

template <class Real>
HWY_INLINE void overlap_all(const PatchColumns<Real>& p, const PatchColumns<Real>& q,
                            PatchOverlaps& overlaps) {
  overlap(p.vertices, q.triangles, overlaps.first_vertices);
  overlap(q.vertices, p.triangles, overlaps.second_vertices);
  overlap(p.edges, q.edges, overlaps.first_edges);
}

HWY_ATTR void overlap_f32(const PatchColumns<float>& p, const PatchColumns<float>& q,
                          PatchOverlaps& overlaps) {
  overlap_all(p, q, overlaps);
}
HWY_ATTR void overlap_f64(const PatchColumns<double>& p, const PatchColumns<double>& q,
                          PatchOverlaps& overlaps) {
  overlap_all(p, q, overlaps);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
