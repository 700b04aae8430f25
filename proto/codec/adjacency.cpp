#include "proto/codec/adjacency.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace weft::proto::codec {

Adjacency::Adjacency(std::uint32_t first, std::uint32_t vertices,
                     std::span<const std::uint32_t> triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(2 * triangles.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t + k] - first, b = triangles[t + (k + 1) % 3] - first;
      if (a == b) continue;
      edges.emplace_back(a, b);
      edges.emplace_back(b, a);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  starts_.assign(std::size_t{vertices} + 1, 0);
  ends_.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++starts_[from + 1];
    ends_.push_back(to);
  }
  for (std::size_t i = 0; i < vertices; ++i) starts_[i + 1] += starts_[i];
}

bool Adjacency::are_joined(std::uint32_t a, std::uint32_t b) const {
  const auto others = of(a);
  return std::binary_search(others.begin(), others.end(), b);
}

/// @param mark   what the marks of this component's vertices become; others are smaller
/// @param found  the component, in the order of the search
void Adjacency::search(std::uint32_t from, std::uint32_t mark, std::vector<std::uint32_t>& marks,
                       std::vector<std::uint32_t>& found) const {
  const auto by_degree = [this](std::uint32_t a, std::uint32_t b) {
    return std::pair(of(a).size(), a) < std::pair(of(b).size(), b);
  };
  found.assign(1, from);
  marks[from] = mark;
  for (std::size_t next = 0; next < found.size(); ++next) {
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    for (const std::uint32_t other : of(found[next])) {
      if (marks[other] >= mark) continue;
      marks[other] = mark;
      found.push_back(other);
    }
    std::sort(found.begin() + begin, found.end(), by_degree);
  }
}

std::vector<std::uint32_t> Adjacency::breadth_first() const {
  std::vector<std::uint32_t> order, found;
  order.reserve(vertices());
  std::vector<std::uint32_t> marks(vertices(), 0);
  for (std::uint32_t vertex = 0; vertex < vertices(); ++vertex) {
    if (marks[vertex] > 0) continue;
    search(vertex, 1, marks, found);
    search(found.back(), 2, marks, found);
    search(found.back(), 3, marks, found);
    order.insert(order.end(), found.begin(), found.end());
  }
  return order;
}

}  // namespace weft::proto::codec
