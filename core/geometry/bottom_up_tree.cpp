// Builds and refits the seed's binary box hierarchy.

#include "core/geometry/bottom_up_tree.h"

#include <algorithm>
#include <cassert>

#include "core/geometry/constants.h"

namespace weft {
namespace {

template <class Primitive>
std::vector<Edge> touching(const std::vector<Primitive>& primitives) {
  Index largest = kNone;
  for (const Primitive& p : primitives)
    largest = std::max(largest, *std::max_element(p.begin(), p.end()));
  std::vector<std::vector<Index>> around(static_cast<std::size_t>(largest + 1));
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    for (const Index v : primitives[p]) {
      assert(v >= 0);
      around[static_cast<std::size_t>(v)].push_back(static_cast<Index>(p));
    }
  }
  std::vector<Edge> pairs;
  for (const std::vector<Index>& fan : around) {
    const std::size_t reach = fan.size() > kWidestFan ? 1 : fan.size();
    for (std::size_t k = 0; k < fan.size(); ++k) {
      for (std::size_t n = k + 1; n < fan.size() && n <= k + reach; ++n)
        pairs.push_back({fan[k], fan[n]});
    }
  }
  return pairs;
}

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// For each primitive its neighbours, in ascending order.
std::vector<std::vector<Index>> neighbour_lists(const std::vector<Edge>& pairs, std::size_t count) {
  std::vector<std::vector<Index>> lists(count);
  for (const Edge& pair : pairs) {
    assert(pair[0] >= 0 && static_cast<std::size_t>(pair[0]) < count);
    assert(pair[1] >= 0 && static_cast<std::size_t>(pair[1]) < count);
    lists[static_cast<std::size_t>(pair[0])].push_back(pair[1]);
    lists[static_cast<std::size_t>(pair[1])].push_back(pair[0]);
  }
  for (std::vector<Index>& list : lists) sort_unique(list);
  return lists;
}

/// Neighbours of groups, derived from those of their members.
/// @param group_of  group of each member
std::vector<std::vector<Index>> merge_neighbours(const std::vector<std::vector<Index>>& members,
                                                 const std::vector<Index>& group_of,
                                                 std::size_t groups) {
  assert(group_of.size() == members.size());
  std::vector<std::vector<Index>> merged(groups);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Index own = group_of[m];
    for (const Index n : members[m]) {
      const Index other = group_of[static_cast<std::size_t>(n)];
      if (other != own) merged[static_cast<std::size_t>(own)].push_back(other);
    }
  }
  for (std::vector<Index>& list : merged) sort_unique(list);
  return merged;
}

/// Size of a box: half its surface, which also orders flat boxes.
template <class Real>
Real half_surface(const Aabb<Real>& box) {
  const Vec3<Real> d = box.upper - box.lower;
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

}  // namespace

template <class Real>
void BottomUpTree<Real>::set_box(const Aabb<Real>& box, Node& node) {
  node.box = box;
  node.volume = (box.upper - box.lower).prod();
}

template <class Real>
void BottomUpTree<Real>::pull_up(Node& n) const {
  assert(n.left != kNone && "an inner node");
  Aabb<Real> box = node(n.left).box;
  if (n.right != kNone) box.add(node(n.right).box);
  set_box(box, n);
}

/// Makes the parents of the nodes from `first` on: pairs each node with its best unpaired
/// neighbour, and nodes without one with the next such node.
/// @return the group of each node of the level, counted from 0
template <class Real>
std::vector<Index> BottomUpTree<Real>::group_level(
    Index first, const std::vector<std::vector<Index>>& neighbours) {
  std::vector<Index> group_of(neighbours.size(), kNone);
  Index groups = 0, waiting = kNone;
  const auto join = [&](Index a, Index b) {
    assert(a != b && group_of[static_cast<std::size_t>(a)] == kNone);
    Node parent;
    parent.left = first + a;
    if (b != kNone) parent.right = first + b;
    pull_up(parent);
    nodes_.push_back(parent);
    group_of[static_cast<std::size_t>(a)] = groups;
    if (b != kNone) group_of[static_cast<std::size_t>(b)] = groups;
    ++groups;
  };
  std::vector<Index> alone;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    if (group_of[k] != kNone) continue;
    const auto own = static_cast<Index>(k);
    Index best = kNone;
    Real least = 0;
    for (const Index n : neighbours[k]) {
      if (group_of[static_cast<std::size_t>(n)] != kNone) continue;
      Aabb<Real> common = node(first + own).box;
      common.add(node(first + n).box);
      const Real size = half_surface(common);
      if (best != kNone && !(size < least)) continue;
      best = n;
      least = size;
    }
    if (best == kNone)
      alone.push_back(own);
    else
      join(own, best);
  }
  for (const Index k : alone) {
    if (waiting == kNone) {
      waiting = k;
      continue;
    }
    join(waiting, k);
    waiting = kNone;
  }
  if (waiting != kNone) join(waiting, kNone);
  return group_of;
}

template <class Real>
void BottomUpTree<Real>::build(const std::vector<Aabb<Real>>& boxes,
                               const std::vector<Edge>& pairs) {
  nodes_.clear();
  first_of_level_.clear();
  if (boxes.empty()) return;
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    Node leaf;
    leaf.primitive = static_cast<Index>(p);
    set_box(boxes[p], leaf);
    nodes_.push_back(leaf);
  }
  std::vector<std::vector<Index>> neighbours = neighbour_lists(pairs, boxes.size());
  Index first = 0;
  first_of_level_.push_back(first);
  while (neighbours.size() > 1) {
    const auto next = static_cast<Index>(nodes_.size());
    const std::vector<Index> group_of = group_level(first, neighbours);
    const auto groups = nodes_.size() - static_cast<std::size_t>(next);
    neighbours = merge_neighbours(neighbours, group_of, groups);
    first = next;
    first_of_level_.push_back(first);
  }
  std::reverse(first_of_level_.begin(), first_of_level_.end());
}

template <class Real>
void BottomUpTree<Real>::refit(const std::vector<Aabb<Real>>& boxes) {
  assert(boxes.size() == leaf_count());
  for (Node& n : nodes_) {
    if (n.is_leaf())
      set_box(boxes[static_cast<std::size_t>(n.primitive)], n);
    else
      pull_up(n);
  }
}

template <class Real>
std::size_t BottomUpTree<Real>::leaf_count() const {
  const std::size_t levels = first_of_level_.size();
  return levels > 1 ? static_cast<std::size_t>(first_of_level_[levels - 2]) : nodes_.size();
}

template <class Real>
std::vector<Aabb<Real>> BottomUpTree<Real>::boxes_of_level(int level) const {
  std::vector<Aabb<Real>> boxes;
  if (level < 0 || level >= level_count()) return boxes;
  const auto k = static_cast<std::size_t>(level);
  const Index end = k == 0 ? static_cast<Index>(nodes_.size()) : first_of_level_[k - 1];
  for (Index n = first_of_level_[k]; n < end; ++n) boxes.push_back(node(n).box);
  return boxes;
}

std::vector<Edge> pairs_that_touch(const std::vector<Edge>& edges) {
  return touching(edges);
}

std::vector<Edge> pairs_that_touch(const std::vector<Triangle>& triangles) {
  return touching(triangles);
}

std::vector<Aabb<float>> boxes_of_level(const BottomUpTree<float>& tree, int level) {
  return tree.boxes_of_level(level);
}

std::vector<Aabb<float>> boxes_of_level(const BottomUpTree<double>& tree, int level) {
  std::vector<Aabb<float>> boxes;
  for (const Aabb<double>& box : tree.boxes_of_level(level))
    boxes.push_back({box.lower.cast<float>(), box.upper.cast<float>()});
  return boxes;
}

template class BottomUpTree<float>;
template class BottomUpTree<double>;

}  // namespace weft
