#include "core/geometry/bvh.h"

#include <algorithm>
#include <numeric>

namespace weft {

template <class Real>
void Bvh<Real>::build(const std::vector<Aabb<Real>>& boxes) {
  nodes_.clear();
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  if (boxes.empty()) return;
  nodes_.emplace_back();
  split(0, 0, static_cast<Index>(boxes.size()), boxes);
  leaf_boxes_.clear();
  for (const Index primitive : order_) leaf_boxes_.push_back(boxes[static_cast<std::size_t>(primitive)]);
}

template <class Real>
void Bvh<Real>::split(std::size_t node, Index begin, Index end,
                      const std::vector<Aabb<Real>>& boxes) {
  Aabb<Real> box, centres;
  for (Index k = begin; k < end; ++k) {
    const Aabb<Real>& b = boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])];
    box.add(b);
    centres.add(b.centre());
  }
  nodes_[node].box = box;
  if (end - begin <= kLeafSize) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  int axis = 0;
  const Vec3<Real> side = centres.upper - centres.lower;
  if (side[1] > side[axis]) axis = 1;
  if (side[2] > side[axis]) axis = 2;
  const Index middle = begin + (end - begin) / 2;
  // Ties by number: the tree must not depend on the library's sort.
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](Index a, Index b) {
                     const Real ca = boxes[static_cast<std::size_t>(a)].centre()[axis];
                     const Real cb = boxes[static_cast<std::size_t>(b)].centre()[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  std::sort(order_.begin() + begin, order_.begin() + middle);
  std::sort(order_.begin() + middle, order_.begin() + end);
  const std::size_t children = nodes_.size();
  nodes_.resize(children + 2);
  nodes_[node].first = static_cast<Index>(children);
  nodes_[node].count = 0;
  split(children, begin, middle, boxes);
  split(children + 1, middle, end, boxes);
}

template <class Real>
void Bvh<Real>::refit(const std::vector<Aabb<Real>>& boxes) {
  // Children stand behind their parents, so one backward pass meets them first.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    node.box = Aabb<Real>{};
    if (node.count > 0) {
      for (Index k = 0; k < node.count; ++k) {
        const auto at = static_cast<std::size_t>(node.first + k);
        leaf_boxes_[at] = boxes[static_cast<std::size_t>(order_[at])];
        node.box.add(leaf_boxes_[at]);
      }
    } else {
      node.box.add(nodes_[static_cast<std::size_t>(node.first)].box);
      node.box.add(nodes_[static_cast<std::size_t>(node.first + 1)].box);
    }
  }
}

template class Bvh<float>;
template class Bvh<double>;

}  // namespace weft
