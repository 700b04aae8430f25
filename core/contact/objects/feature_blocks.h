#pragma once

#include <cstddef>
#include <vector>

#include "core/contact/objects/feature_distance.h"
#include "core/geometry/aabb.h"
#include "core/geometry/bvh.h"
#include "core/types.h"

// Features of a mesh as the vector code reads them.

namespace weft {

/// Triangles, ridges or corners of a mesh in blocks of kFeatureLanes, near ones together. Made
/// once, and read wherever cloth is near.
template <class Real>
struct FeatureBlocks {
  std::vector<Index> feature;  ///< of each lane of each block; none where there is no more
  std::vector<Real> values;    ///< as FeatureTable::mesh has them
  std::vector<Aabb<Real>> boxes;
  Bvh<Real> tree;  ///< of the boxes
};

/// Puts features in blocks in the order in which they are given.
/// @param numbers  of a feature
/// @param values   values(feature) are its first numbers; others are left for later
/// @param box      box(feature) has all its points
template <class Real, class Values, class Box>
FeatureBlocks<Real> in_blocks(const std::vector<Index>& features, std::size_t numbers,
                              Values&& values, Box&& box) {
  // Where there is no feature one is far away, yet near enough for its square to be a number.
  constexpr Real kNoFeature = Real(1e9);
  FeatureBlocks<Real> blocks;
  const std::size_t count = (features.size() + kFeatureLanes - 1) / kFeatureLanes;
  blocks.feature.assign(count * kFeatureLanes, kNone);
  blocks.values.assign(count * numbers * kFeatureLanes, kNoFeature);
  blocks.boxes.resize(count);
  for (std::size_t n = 0; n < features.size(); ++n) {
    const std::size_t b = n / kFeatureLanes, lane = n % kFeatureLanes;
    blocks.feature[n] = features[n];
    blocks.boxes[b].add(box(features[n]));
    std::size_t k = b * numbers;
    for (const Vec3<Real>& v : values(features[n])) {
      for (const Real x : v) blocks.values[k++ * kFeatureLanes + lane] = x;
    }
  }
  blocks.tree.build(blocks.boxes);
  return blocks;
}

}  // namespace weft
