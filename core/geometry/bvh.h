#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/geometry/aabb.h"
#include "core/types.h"

namespace weft {

/// Hierarchy of axis-aligned boxes over primitives known by their number. Built once by splitting
/// at the median of the longest side; its boxes can be refitted when the primitives move.
template <class Real>
class Bvh {
 public:
  /// @param boxes  of the primitives; none is fine
  void build(const std::vector<Aabb<Real>>& boxes);

  /// New boxes for the same primitives; keeps the shape of the tree.
  void refit(const std::vector<Aabb<Real>>& boxes);

  bool empty() const { return nodes_.empty(); }
  /// Box around everything; empty if there is nothing.
  Aabb<Real> bounds() const { return nodes_.empty() ? Aabb<Real>{} : nodes_[0].box; }

  /// Calls visit(primitive) for each primitive whose box overlaps `box`, in a fixed order.
  template <class Visit>
  void for_each_overlap(const Aabb<Real>& box, Visit&& visit) const;

  /// Walks nearest-first: calls `narrow(primitive, bound)` while a box can be nearer than the bound;
  /// `narrow` returns the new bound.
  /// @param distance  distance(box) gives a lower bound for all that is inside it
  /// @return the final bound
  template <class Distance, class Narrow>
  Real nearest(Real bound, Distance&& distance, Narrow&& narrow) const;

 private:
  /// An inner node's children stand at `first` and `first + 1`; a leaf has `count` primitives from
  /// `first` in `order_`.
  struct Node {
    Aabb<Real> box;
    Index first = 0;
    Index count = 0;
  };
  static constexpr Index kLeafSize = 4;
  static constexpr int kDeepest = 64;

  void split(std::size_t node, Index begin, Index end, const std::vector<Aabb<Real>>& boxes);

  std::vector<Node> nodes_;
  std::vector<Index> order_;             ///< primitives, leaf by leaf
  std::vector<Aabb<Real>> leaf_boxes_;   ///< their boxes, in that order
};

template <class Real>
template <class Visit>
void Bvh<Real>::for_each_overlap(const Aabb<Real>& box, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::array<Index, kDeepest> stack;
  int size = 0;
  stack[0] = 0;
  ++size;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[static_cast<std::size_t>(--size)])];
    if (!node.box.overlaps(box)) continue;
    if (node.count > 0) {
      for (Index k = 0; k < node.count; ++k) {
        const auto at = static_cast<std::size_t>(node.first + k);
        if (leaf_boxes_[at].overlaps(box)) visit(order_[at]);
      }
      continue;
    }
    stack[static_cast<std::size_t>(size++)] = node.first + 1;
    stack[static_cast<std::size_t>(size++)] = node.first;
  }
}

template <class Real>
template <class Distance, class Narrow>
Real Bvh<Real>::nearest(Real bound, Distance&& distance, Narrow&& narrow) const {
  if (nodes_.empty()) return bound;
  struct Entry {
    Index node;
    Real distance;
  };
  std::array<Entry, kDeepest> stack;
  int size = 0;
  stack[0] = {0, distance(nodes_[0].box)};
  ++size;
  while (size > 0) {
    const Entry entry = stack[static_cast<std::size_t>(--size)];
    if (!(entry.distance <= bound)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      for (Index k = 0; k < node.count; ++k)
        bound = narrow(order_[static_cast<std::size_t>(node.first + k)], bound);
      continue;
    }
    Entry near{node.first, distance(nodes_[static_cast<std::size_t>(node.first)].box)};
    Entry far{node.first + 1, distance(nodes_[static_cast<std::size_t>(node.first + 1)].box)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[static_cast<std::size_t>(size++)] = far;
    stack[static_cast<std::size_t>(size++)] = near;
  }
  return bound;
}

extern template class Bvh<float>;
extern template class Bvh<double>;

}  // namespace weft
