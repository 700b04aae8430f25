// Builds and refits the four-wide box hierarchy.

#include "core/geometry/bvh.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace weft {

template <class Real>
void Bvh<Real>::Node::set_box(std::size_t k, const Aabb<Real>& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis][k] = box.lower[static_cast<Eigen::Index>(axis)];
    upper[axis][k] = box.upper[static_cast<Eigen::Index>(axis)];
  }
}

template <class Real>
Aabb<Real> Bvh<Real>::Node::bounds() const {
  Aabb<Real> all;
  for (std::size_t k = 0; k < kWidth; ++k) all.add(box(k));
  return all;
}

template <class Real>
void Bvh<Real>::build(const std::vector<Aabb<Real>>& boxes) {
  nodes_.clear();
  bounds_ = Aabb<Real>{};
  if (boxes.empty()) return;
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.emplace_back();
  split(0, 0, static_cast<Index>(boxes.size()), boxes);
  order_ = {};
  refit(boxes);
}

/// Splits a range of primitives at the median of their centres along the longest side.
/// @return where the second half begins
template <class Real>
Index Bvh<Real>::halve(Index begin, Index end, const std::vector<Aabb<Real>>& boxes) {
  assert(end - begin >= 2);
  const auto centre = [&](Index primitive) {
    return boxes[static_cast<std::size_t>(primitive)].centre();
  };
  Aabb<Real> centres;
  for (Index k = begin; k < end; ++k) centres.add(centre(order_[static_cast<std::size_t>(k)]));
  const Vec3<Real> side = centres.upper - centres.lower;
  int axis = 0;
  if (side[1] > side[axis]) axis = 1;
  if (side[2] > side[axis]) axis = 2;
  const Index middle = begin + (end - begin) / 2;
  // Ties are broken by index: the tree must not depend on the library's sort.
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](Index a, Index b) {
                     const Real ca = centre(a)[axis], cb = centre(b)[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  std::sort(order_.begin() + begin, order_.begin() + middle);
  std::sort(order_.begin() + middle, order_.begin() + end);
  return middle;
}

template <class Real>
void Bvh<Real>::split(std::size_t node, Index begin, Index end,
                      const std::vector<Aabb<Real>>& boxes) {
  assert(begin < end && static_cast<std::size_t>(end) <= order_.size());
  nodes_[node].child.fill(kNoChild);
  std::array<Index, kWidth + 1> border{begin, end, end, end, end};
  std::size_t children = 1;
  if (end - begin <= static_cast<Index>(kWidth)) {
    for (children = 0; begin + static_cast<Index>(children) < end; ++children)
      border[children] = begin + static_cast<Index>(children);
  } else {
    const Index middle = halve(begin, end, boxes);
    border = {begin, halve(begin, middle, boxes), middle, halve(middle, end, boxes), end};
    children = kWidth;
  }
  for (std::size_t k = 0; k < children; ++k) {
    const Index from = border[k], to = border[k + 1];
    if (to - from == 1) {
      nodes_[node].child[k] = ~order_[static_cast<std::size_t>(from)];
      continue;
    }
    const std::size_t child = nodes_.size();
    nodes_.emplace_back();
    nodes_[node].child[k] = static_cast<Index>(child);
    split(child, from, to, boxes);
  }
}

template <class Real>
void Bvh<Real>::refit(const std::vector<Aabb<Real>>& boxes) {
  const auto box_of = [&](Index primitive) -> const Aabb<Real>& {
    assert(static_cast<std::size_t>(primitive) < boxes.size());
    return boxes[static_cast<std::size_t>(primitive)];
  };
  // Children follow their parents, so a backward pass visits them first.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    for (std::size_t k = 0; k < kWidth; ++k) {
      const Index child = node.child[k];
      if (child == kNoChild)
        node.set_box(k, {});
      else if (child < 0)
        node.set_box(k, box_of(~child));
      else
        node.set_box(k, nodes_[static_cast<std::size_t>(child)].bounds());
    }
  }
  bounds_ = nodes_.empty() ? Aabb<Real>{} : nodes_[0].bounds();
}

template class Bvh<float>;
template class Bvh<double>;

}  // namespace weft
