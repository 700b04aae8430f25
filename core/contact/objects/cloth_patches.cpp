// Groups the triangles of cloths into patches.

#include "core/contact/objects/cloth_patches.h"

#include <algorithm>

#include "core/geometry/aabb.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Triangles of a patch at most: two by two cells of a grid. Larger ones have more pairs to tell
/// apart, smaller ones more boxes to look up.
constexpr std::size_t kMostTriangles = 8;

/// Numbers the groups that triangles fall into, by splitting at the median.
template <class Real>
class Grouping {
 public:
  Grouping(const Vec3Array<Real>& positions, const std::vector<Triangle>& triangles)
      : group_(triangles.size()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Vec3<Real> sum = Vec3<Real>::Zero();
      for (const Index i : triangles[t]) sum += positions[at_index(i)];
      centres_.push_back(sum / Real(3));
      order_.push_back(t);
    }
    if (!order_.empty()) split(0, order_.size());
  }

  std::size_t count() const { return count_; }
  std::size_t of(std::size_t triangle) const { return group_[triangle]; }

 private:
  void split(std::size_t begin, std::size_t end) {
    if (end - begin <= kMostTriangles) {
      for (std::size_t n = begin; n < end; ++n) group_[order_[n]] = count_;
      ++count_;
      return;
    }
    Aabb<Real> box;
    for (std::size_t n = begin; n < end; ++n) box.add(centres_[order_[n]]);
    Index axis = 0;
    (box.upper - box.lower).maxCoeff(&axis);
    // Groups are full ones, but for the last.
    const std::size_t groups = (end - begin + kMostTriangles - 1) / kMostTriangles;
    const std::size_t middle = begin + (groups + 1) / 2 * kMostTriangles;
    const auto at = [&](std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
      const Real ca = centres_[a][axis], cb = centres_[b][axis];
      return ca < cb || (ca == cb && a < b);
    });
    split(begin, middle);
    split(middle, end);
  }

  Vec3Array<Real> centres_;
  std::vector<std::size_t> order_, group_;
  std::size_t count_ = 0;
};

/// Sorts features by group, stably, and says where each group's share lies.
template <class Feature>
std::vector<Feature> in_groups(const std::vector<Feature>& features,
                               const std::vector<std::size_t>& group, std::size_t groups,
                               std::vector<ClothPatch>& patches, IndexRange ClothPatch::*range) {
  std::vector<Index> first(groups + 1, 0);
  for (const std::size_t g : group) ++first[g + 1];
  for (std::size_t g = 0; g < groups; ++g) {
    patches[g].*range = {first[g], first[g + 1]};
    first[g + 1] += first[g];
  }
  std::vector<Feature> sorted(features.size());
  for (std::size_t k = 0; k < features.size(); ++k)
    sorted[at_index(first[group[k]]++)] = features[k];
  return sorted;
}

}  // namespace

template <class Real>
ClothPatches make_patches(const Vec3Array<Real>& positions, const std::vector<Edge>& edges,
                          const std::vector<Triangle>& triangles) {
  const Grouping<Real> grouping(positions, triangles);
  std::size_t groups = grouping.count();
  constexpr std::size_t kNoGroup = static_cast<std::size_t>(-1);
  std::vector<std::size_t> of_particle(positions.size(), kNoGroup), of_triangle, of_edge;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    of_triangle.push_back(grouping.of(t));
    for (const Index i : triangles[t]) {
      std::size_t& group = of_particle[at_index(i)];
      if (group == kNoGroup) group = grouping.of(t);
    }
  }
  for (std::size_t& group : of_particle) {
    if (group == kNoGroup) group = groups++;
  }
  for (const Edge& e : edges) of_edge.push_back(of_particle[at_index(e[0])]);

  ClothPatches patches;
  patches.list.resize(groups);
  std::vector<Index> all;
  for (std::size_t i = 0; i < positions.size(); ++i) all.push_back(static_cast<Index>(i));
  patches.particles = in_groups(all, of_particle, groups, patches.list, &ClothPatch::particles);
  patches.edges = in_groups(edges, of_edge, groups, patches.list, &ClothPatch::edges);
  patches.triangles =
      in_groups(triangles, of_triangle, groups, patches.list, &ClothPatch::triangles);
  patches.neighbours = Neighbours(positions.size(), edges);
  return patches;
}

WEFT_INSTANTIATE_FUNCTIONS(make_patches)

}  // namespace weft
