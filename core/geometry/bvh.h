#pragma once

#include <array>
#include <cassert>
#include <vector>

#include "core/geometry/aabb.h"
#include "core/types.h"

// A four-wide box hierarchy for overlap and nearest queries.

namespace weft {

/// Hierarchy of axis-aligned boxes over numbered primitives: four children per node, so that one
/// pass of vector code tests them all. Built once by splitting at the median of the longest side;
/// its boxes can be refitted as the primitives move.
template <class Real>
class Bvh {
 public:
  /// @param boxes  of the primitives; may be empty
  void build(const std::vector<Aabb<Real>>& boxes);

  /// Updates the boxes of the same primitives; keeps the structure of the tree.
  void refit(const std::vector<Aabb<Real>>& boxes);

  bool empty() const { return nodes_.empty(); }
  /// Box around all primitives; empty if there are none.
  const Aabb<Real>& bounds() const { return bounds_; }

  /// Calls visit(primitive) for each primitive whose box overlaps `box`, in a fixed order. The
  /// search also terminates for a box with infinite or NaN bounds.
  template <class Visit>
  void for_each_overlap(const Aabb<Real>& box, Visit&& visit) const;

  /// Searches nearest first: calls `narrow(primitive, bound)` while a box can be nearer than the
  /// bound; `narrow` returns the new bound.
  /// @param distance  distance(box) gives a lower bound for everything inside the box
  /// @return the final bound
  template <class Distance, class Narrow>
  Real nearest(Real bound, Distance&& distance, Narrow&& narrow) const;

 private:
  static constexpr std::size_t kWidth = 4;
  static constexpr std::size_t kDeepest = 64;  // entries of a search; 3 per level, 2^32 primitives
  static constexpr Index kNoChild = 0;         // the root is no node's child

  /// Boxes of up to four children, side by side. Boxes of missing children are empty.
  struct Node {
    std::array<std::array<Real, kWidth>, 3> lower, upper;
    std::array<Index, kWidth> child;  ///< a node, or ~primitive

    Aabb<Real> box(std::size_t k) const {
      Aabb<Real> box;
      box.lower = Vec3<Real>(lower[0][k], lower[1][k], lower[2][k]);
      box.upper = Vec3<Real>(upper[0][k], upper[1][k], upper[2][k]);
      return box;
    }
    void set_box(std::size_t k, const Aabb<Real>& box);
    Aabb<Real> bounds() const;
  };

  static void push(Index child, std::array<Index, kDeepest>& stack, std::size_t& size) {
    assert(size < kDeepest);
    stack[size++] = child;
  }
  void split(std::size_t node, Index begin, Index end, const std::vector<Aabb<Real>>& boxes);
  Index halve(Index begin, Index end, const std::vector<Aabb<Real>>& boxes);

  std::vector<Node> nodes_;
  std::vector<Index> order_;  ///< primitives, during construction
  Aabb<Real> bounds_;
};

template <class Real>
template <class Visit>
void Bvh<Real>::for_each_overlap(const Aabb<Real>& box, Visit&& visit) const {
  // The empty box of an empty tree overlaps an infinite box.
  if (nodes_.empty() || !bounds_.overlaps(box)) return;
  std::array<Index, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    std::array<std::uint8_t, kWidth> hit;
    for (std::size_t k = 0; k < kWidth; ++k) {
      // Without short circuits, so that the four tests become vector code.
      hit[k] = static_cast<std::uint8_t>(static_cast<int>(node.lower[0][k] <= box.upper[0]) &
                                         static_cast<int>(node.lower[1][k] <= box.upper[1]) &
                                         static_cast<int>(node.lower[2][k] <= box.upper[2]) &
                                         static_cast<int>(node.upper[0][k] >= box.lower[0]) &
                                         static_cast<int>(node.upper[1][k] >= box.lower[1]) &
                                         static_cast<int>(node.upper[2][k] >= box.lower[2]));
    }
    for (std::size_t k = 0; k < kWidth; ++k) {
      // The empty box of a missing child overlaps an infinite box.
      if (node.child[k] == kNoChild) break;
      if (!hit[k]) continue;
      if (node.child[k] < 0)
        visit(~node.child[k]);
      else
        push(node.child[k], stack, size);
    }
  }
}

template <class Real>
template <class Distance, class Narrow>
Real Bvh<Real>::nearest(Real bound, Distance&& distance, Narrow&& narrow) const {
  struct Entry {
    Index child;
    Real distance;
  };
  if (nodes_.empty()) return bound;
  std::array<Entry, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = {0, distance(bounds_)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.distance <= bound)) continue;
    if (entry.child < 0) {
      bound = narrow(~entry.child, bound);
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.child)];
    const std::size_t first = size;
    for (std::size_t k = 0; k < kWidth; ++k) {
      if (node.child[k] == kNoChild) break;
      const Entry child{node.child[k], distance(node.box(k))};
      if (!(child.distance <= bound)) continue;
      // Sorted so that the nearest is on top.
      assert(size < kDeepest);
      std::size_t at = size++;
      for (; at > first && stack[at - 1].distance < child.distance; --at) stack[at] = stack[at - 1];
      stack[at] = child;
    }
  }
  return bound;
}

extern template class Bvh<float>;
extern template class Bvh<double>;

}  // namespace weft
