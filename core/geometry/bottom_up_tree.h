#pragma once

#include <array>
#include <cassert>
#include <vector>

#include "core/geometry/aabb.h"
#include "core/types.h"

// The box hierarchy of the seed's collision detection, which also serves pictures of boxes.

namespace weft {

/// The seed's hierarchy of axis-aligned boxes: binary, built bottom-up by pairing neighbouring
/// primitives (particles, edges, triangles), then neighbouring groups, until one box is left. The
/// grouping is made once; `refit` updates the boxes as the primitives move.
///
/// Levels count from the root: level 0 is one box around everything, the last level has a box per
/// primitive.
template <class Real>
class BottomUpTree {
 public:
  /// Pairs each primitive with the neighbour that gives the smallest common box.
  /// @param boxes  of the primitives; may be empty
  /// @param pairs  of neighbouring primitives
  void build(const std::vector<Aabb<Real>>& boxes, const std::vector<Edge>& pairs);

  /// Updates the boxes of the same primitives.
  void refit(const std::vector<Aabb<Real>>& boxes);

  bool empty() const { return nodes_.empty(); }
  int level_count() const { return static_cast<int>(first_of_level_.size()); }

  /// The boxes of one level, 0 to level_count() - 1.
  std::vector<Aabb<Real>> boxes_of_level(int level) const;

  /// Calls visit(p, q) for every primitive p of this and q of the other tree whose boxes overlap,
  /// once per pair. For two leaves, the primitives' boxes are tested; for a leaf and an inner node,
  /// the inner node is descended; for two inner nodes, the smaller one is tested against the
  /// children of the larger one (van den Bergen 1997).
  template <class Visit>
  void for_each_pair(const BottomUpTree& other, Visit&& visit) const;

  /// The same within this tree: visits every two different primitives once, in either order.
  template <class Visit>
  void for_each_own_pair(Visit&& visit) const;

 private:
  static constexpr std::size_t kDeepest = 512;  // entries of a search; two or three per level

  struct Node {
    Aabb<Real> box;
    Real volume = 0;
    Index left = kNone, right = kNone;  ///< nodes; right is none for an unpaired node
    Index primitive = kNone;            ///< of a leaf

    bool is_leaf() const { return primitive != kNone; }
  };
  struct NodePair {
    Index a, b;
  };
  using Stack = std::array<NodePair, kDeepest>;

  const Node& node(Index k) const { return nodes_[static_cast<std::size_t>(k)]; }
  std::size_t leaf_count() const;
  Index root() const { return static_cast<Index>(nodes_.size()) - 1; }
  static void set_box(const Aabb<Real>& box, Node& node);
  void pull_up(Node& node) const;
  std::vector<Index> group_level(Index first, const std::vector<std::vector<Index>>& neighbours);
  template <class Visit>
  static void walk(const BottomUpTree& a, const BottomUpTree& b, Stack& stack, std::size_t size,
                   Visit&& visit);

  std::vector<Node> nodes_;            ///< level by level, leaves first, the root last
  std::vector<Index> first_of_level_;  ///< first node of each level, the root's first
};

/// Pairs of edges, or of triangles, that share a vertex: neighbours for a tree over them.
std::vector<Edge> pairs_that_touch(const std::vector<Edge>& edges);
std::vector<Edge> pairs_that_touch(const std::vector<Triangle>& triangles);

/// Boxes of one level of a tree as floats, for drawing; empty if there is no such level.
std::vector<Aabb<float>> boxes_of_level(const BottomUpTree<float>& tree, int level);
std::vector<Aabb<float>> boxes_of_level(const BottomUpTree<double>& tree, int level);

template <class Real>
template <class Visit>
void BottomUpTree<Real>::for_each_pair(const BottomUpTree& other, Visit&& visit) const {
  if (empty() || other.empty()) return;
  Stack stack;
  stack[0] = {root(), other.root()};
  walk(*this, other, stack, 1, visit);
}

template <class Real>
template <class Visit>
void BottomUpTree<Real>::for_each_own_pair(Visit&& visit) const {
  Stack stack;
  // Pairs within a node are those within each child and those between the children.
  for (const Node& n : nodes_) {
    if (n.is_leaf() || n.right == kNone) continue;
    stack[0] = {n.left, n.right};
    walk(*this, *this, stack, 1, visit);
  }
}

template <class Real>
template <class Visit>
void BottomUpTree<Real>::walk(const BottomUpTree& a, const BottomUpTree& b, Stack& stack,
                              std::size_t size, Visit&& visit) {
  while (size > 0) {
    const NodePair pair = stack[--size];
    assert(size + 2 <= kDeepest);
    const Node &na = a.node(pair.a), &nb = b.node(pair.b);
    if (!na.box.overlaps(nb.box)) continue;
    if (na.is_leaf() && nb.is_leaf()) {
      visit(na.primitive, nb.primitive);
    } else if (nb.is_leaf() || (!na.is_leaf() && na.volume >= nb.volume)) {
      if (na.right != kNone) stack[size++] = {na.right, pair.b};
      stack[size++] = {na.left, pair.b};
    } else {
      if (nb.right != kNone) stack[size++] = {pair.a, nb.right};
      stack[size++] = {pair.a, nb.left};
    }
  }
}

extern template class BottomUpTree<float>;
extern template class BottomUpTree<double>;

}  // namespace weft
