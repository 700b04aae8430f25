// Cloth that starts through cloth: what ClothGuard promises nothing about until it is apart.

#include <algorithm>

#include "core/contact/guard/cloth_guard.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// A cloth with more crossings than this part of its particles, and than so many, is a heap: work
/// would have no bound.
constexpr std::size_t kHeapPart = 2, kFewCrossings = 600;

bool share_particle(const Edge& edge, const Triangle& t) {
  return std::any_of(edge.begin(), edge.end(),
                     [&](Index i) { return i == t[0] || i == t[1] || i == t[2]; });
}

}  // namespace

/// Looks for edges that pass through triangles now. The tree has to be fitted.
template <class Real>
void ClothGuard<Real>::find_tangles(const ClothState<Real>& state) {
  tangles_.clear();
  is_heap_.assign(is_heap_.size(), 0);
  crossings_of_.assign(crossings_of_.size(), 0);
  heaps_ = 0;
  std::size_t looked = 0;
  tree_.for_each_near_pair([&](Index p, Index q) {
    if (resting_[static_cast<std::size_t>(p)] && resting_[static_cast<std::size_t>(q)]) return;
    if (in_heap(p) || in_heap(q)) return;
    stop_point(looked++);
    const std::size_t before = tangles_.size();
    look_through(p, q);
    if (p != q) look_through(q, p);
    if (tangles_.size() > before) note_crossings(p, q, tangles_.size() - before);
  });
  if (heaps_ > 0) {
    tangles_.leave_out([&](const TangleCrossing& c) {
      const Index one = edges_[static_cast<std::size_t>(c.edge)][0],
                  other = triangles_[static_cast<std::size_t>(c.triangle)][0];
      return is_heap(static_cast<std::size_t>(part_of(one))) ||
             is_heap(static_cast<std::size_t>(part_of(other)));
    });
  }
  tangles_.decide(legal_, state.inverse_mass);
}

/// Counts crossings for the cloths of two patches.
template <class Real>
void ClothGuard<Real>::note_crossings(Index p, Index q, std::size_t count) {
  for (const std::size_t k : {cloth_of(p), cloth_of(q)}) {
    const auto particles = static_cast<std::size_t>(particles_of_[k].count);
    crossings_of_[k] += count;
    if (is_heap(k) || crossings_of_[k] <= std::max(kFewCrossings, particles / kHeapPart)) continue;
    is_heap_[k] = 1;
    ++heaps_;
  }
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
    if (pair.open && !tangles_.frees(pair.kind, pair.particle))
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
  for (std::size_t k = 0; k < is_heap_.size(); ++k) {
    if (is_heap(k)) list.push_back({static_cast<Index>(k), static_cast<Index>(k)});
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

#define WEFT_INSTANTIATE(Real)                                                         \
  template void ClothGuard<Real>::find_tangles(const ClothState<Real>&);               \
  template void ClothGuard<Real>::note_crossings(Index, Index, std::size_t);           \
  template void ClothGuard<Real>::look_through(Index, Index);                          \
  template std::vector<std::array<Index, 2>> ClothGuard<Real>::tangled_cloths() const; \
  template void ClothGuard<Real>::note_touches();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
