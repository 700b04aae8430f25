// Cloth that starts through cloth: what ClothGuard promises nothing about until it is apart.

#include <algorithm>

#include "core/contact/cloth_guard.h"

namespace weft {
namespace {

bool share_particle(const Edge& edge, const Triangle& t) {
  return std::any_of(edge.begin(), edge.end(),
                     [&](Index i) { return i == t[0] || i == t[1] || i == t[2]; });
}

}  // namespace

/// Looks for edges that pass through triangles now. The tree has to be fitted.
template <class Real>
void ClothGuard<Real>::find_tangles(const ClothState<Real>& state) {
  tangles_.clear();
  tree_.for_each_near_pair([&](Index p, Index q) {
    if (resting_[static_cast<std::size_t>(p)] && resting_[static_cast<std::size_t>(q)]) return;
    look_through(p, q);
    if (p != q) look_through(q, p);
  });
  tangles_.decide(legal_, state.inverse_mass);
}

/// Edges of one patch and triangles of another one.
template <class Real>
void ClothGuard<Real>::look_through(Index p, Index q) {
  const auto& edges = tree_.patch(p).edges;
  const auto& triangles = tree_.patch(q).triangles;
  const auto box_of = [&](const auto& particles) {
    QuadBox<Real> box;
    for (const Index i : particles) box.add(legal_[static_cast<std::size_t>(i)]);
    return box;
  };
  std::array<QuadBox<Real>, kMostPatchFeatures> boxes;
  QuadBox<Real> all;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    boxes[k] = box_of(triangles_[static_cast<std::size_t>(triangles[k])]);
    all.add(boxes[k].lower);
    all.add(boxes[k].upper);
  }
  for (const Index e : edges) {
    const Edge& edge = edges_[static_cast<std::size_t>(e)];
    const QuadBox<Real> box = box_of(edge);
    if (!box.overlaps(all)) continue;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const Index t = triangles[k];
      if (!box.overlaps(boxes[k]) || share_particle(edge, triangles_[static_cast<std::size_t>(t)]))
        continue;
      tangles_.look_at(e, t, legal_);
    }
  }
}

/// Pairs that touch are none that cross, and nothing tells their sides.
template <class Real>
void ClothGuard<Real>::note_touches() {
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open && !(pair.bound > 0) && !tangles_.frees(pair.kind, pair.particle))
      tangles_.note_touch(pair.kind, pair.particle, legal_);
  }
}

template <class Real>
std::vector<std::array<Index, 2>> ClothGuard<Real>::tangled_cloths() const {
  std::vector<std::array<Index, 2>> list;
  const auto add = [&](Index i, Index j) {
    const auto [p, q] = std::minmax({part_of(i), part_of(j)});
    list.push_back({p, q});
  };
  for (const TangleCrossing& c : tangles_.crossings())
    add(edges_[static_cast<std::size_t>(c.edge)][0],
        triangles_[static_cast<std::size_t>(c.triangle)][0]);
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open && !pair.gone) add(pair.particle[0], pair.particle[3]);
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

#define WEFT_INSTANTIATE(Real)                                                         \
  template void ClothGuard<Real>::find_tangles(const ClothState<Real>&);               \
  template void ClothGuard<Real>::look_through(Index, Index);                          \
  template std::vector<std::array<Index, 2>> ClothGuard<Real>::tangled_cloths() const; \
  template void ClothGuard<Real>::note_touches();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
