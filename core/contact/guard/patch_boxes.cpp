#include "core/contact/guard/patch_boxes.h"

#include <algorithm>
#include <bit>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/guard/patch_boxes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/guard/patch_boxes-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {
namespace {

/// Components of a box, and columns of boxes are a multiple of so many long.
constexpr std::size_t kComponents = 6, kPadding = 8;

std::size_t padded(std::size_t count) {
  return (count + kPadding - 1) / kPadding * kPadding;
}

}  // namespace

template <class Real>
PatchBoxes<Real>::PatchBoxes(const PatchTree<Real>& tree)
    : fits_(tree.patch_count(), 0), changed_(tree.patch_count()) {
  std::size_t numbers = 0;
  for (std::size_t p = 0; p < tree.patch_count(); ++p) {
    const auto& patch = tree.patch(static_cast<Index>(p));
    begin_.push_back(numbers);
    numbers += kComponents * (padded(patch.edges.size()) + padded(patch.triangles.size()) +
                              padded(patch.vertices.size()) + 1);
  }
  // What pads a column is empty.
  numbers_.assign(numbers, QuadBox<Real>::kFar);
  for (std::size_t p = 0; p < begin_.size(); ++p) {
    const auto number = static_cast<Index>(p);
    const PatchColumns<Real> all = columns(number, tree.patch(number));
    for (const BoxColumns<Real>& kind : {all.edges, all.triangles, all.vertices}) {
      Real* const upper = numbers_.data() + (kind.numbers - numbers_.data()) + 3 * kind.pitch;
      std::fill(upper, upper + 3 * kind.pitch, -QuadBox<Real>::kFar);
    }
  }
}

template <class Real>
PatchColumns<Real> PatchBoxes<Real>::columns(Index p, const Patch& patch) const {
  assert(at_index(p) < begin_.size());
  const Real* at = numbers_.data() + begin_[at_index(p)];
  const auto take = [&](std::size_t count) {
    const BoxColumns<Real> kind{at, count, padded(count)};
    at += kComponents * kind.pitch;
    return kind;
  };
  PatchColumns<Real> all;
  all.edges = take(patch.edges.size());
  all.triangles = take(patch.triangles.size());
  all.vertices = take(patch.vertices.size());
  all.whole = at;
  return all;
}

/// Boxes of features from those of their corners.
/// @param changed  a bit for each corner
/// @return a bit for each feature with a changed corner
template <class Real>
template <std::size_t CornerCount>
std::uint32_t PatchBoxes<Real>::fit_features(const FeatureCorners<CornerCount>& features,
                                             const CornerBoxes& corner, std::uint32_t changed,
                                             std::size_t pitch, Real* numbers) {
  std::uint32_t marks = 0;
  for (std::size_t f = 0; f < features.size(); ++f) {
    QuadBox<Real> box = corner[features[f][0]];
    std::uint32_t corners = changed >> features[f][0];
    for (std::size_t k = 1; k < CornerCount; ++k) {
      box.add(corner[features[f][k]]);
      corners |= changed >> features[f][k];
    }
    marks |= (corners & 1) << f;
    for (int c = 0; c < 3; ++c) {
      numbers[at_index(c) * pitch + f] = box.lower[c];
      numbers[at_index(c + 3) * pitch + f] = box.upper[c];
    }
  }
  return marks;
}

template <class Real>
void PatchBoxes<Real>::fit(Index p, const Patch& patch, const PredictedMotion<Real>& motion,
                           const std::vector<char>& changed) {
  const auto number = at_index(p);
  assert(number < begin_.size() && patch.particles.size() <= kMostPatchFeatures);
  CornerBoxes corner;
  QuadBox<Real> whole;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < patch.particles.size(); ++k) {
    const auto i = at_index(patch.particles[k]);
    QuadBox<Real> box;
    box.add(motion.start[i]);
    box.add(motion.end[i]);
    corner[k] = box.grown(motion.radius + motion.margin);
    whole.add(corner[k]);
    bits |= static_cast<std::uint32_t>(changed[i] != 0) << k;
  }
  const PatchColumns<Real> all = columns(p, patch);
  const auto numbers = [&](const BoxColumns<Real>& kind) {
    return numbers_.data() + (kind.numbers - numbers_.data());
  };
  Real* const around = numbers_.data() + (all.whole - numbers_.data());
  for (int c = 0; c < 3; ++c) {
    around[c] = whole.lower[c];
    around[c + 3] = whole.upper[c];
  }
  changed_[number] = {
      fit_features(patch.vertex_corners, corner, bits, all.vertices.pitch, numbers(all.vertices)),
      fit_features(patch.edge_corners, corner, bits, all.edges.pitch, numbers(all.edges)),
      fit_features(patch.triangle_corners, corner, bits, all.triangles.pitch,
                   numbers(all.triangles))};
}

template <class Real>
void leave_out_incident(const typename PatchTree<Real>::Patch& p,
                        const typename PatchTree<Real>::Patch& q, PatchOverlaps& overlaps) {
  const auto clear = [](std::uint32_t rows, std::uint32_t columns, PatchOverlaps::Bits& bits) {
    for (; rows != 0; rows &= rows - 1)
      bits[static_cast<std::size_t>(std::countr_zero(rows))] &= ~columns;
  };
  const std::size_t first = p.particles.size(), second = q.particles.size();
  assert(p.having.size() == first && q.having.size() == second);
  for (std::size_t a = 0, b = 0; a < first && b < second;) {
    const Index i = p.particles[a], j = q.particles[b];
    if (i == j) {
      const PatchMarks &one = p.having[a], &two = q.having[b];
      clear(one.vertices, two.triangles, overlaps.first_vertices);
      clear(two.vertices, one.triangles, overlaps.second_vertices);
      clear(one.edges, two.edges, overlaps.first_edges);
    }
    a += i <= j ? 1 : 0;
    b += j <= i ? 1 : 0;
  }
}

WEFT_EXPORT_KERNEL(overlap_all);

template <class Real>
void overlap_patches(const PatchColumns<Real>& p, const PatchColumns<Real>& q,
                     const PatchMarks& marked_p, const PatchMarks& marked_q,
                     PatchOverlaps& overlaps) {
  WEFT_RUN(overlap_all, Real)(p, q, marked_p, marked_q, overlaps);
}

WEFT_INSTANTIATE_FUNCTIONS(overlap_patches)
template void leave_out_incident<float>(const PatchTree<float>::Patch&,
                                        const PatchTree<float>::Patch&, PatchOverlaps&);
template void leave_out_incident<double>(const PatchTree<double>::Patch&,
                                         const PatchTree<double>::Patch&, PatchOverlaps&);
template class PatchBoxes<float>;
template class PatchBoxes<double>;

}  // namespace weft
#endif
