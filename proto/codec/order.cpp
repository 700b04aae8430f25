#include "proto/codec/order.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "proto/binary.h"
#include "proto/codec/adjacency.h"

namespace weft::proto::codec {
namespace {

constexpr std::uint32_t kMissing = 0xffffffff;
// Weight of a parallelogram's size against how well it closes: large ones predict worse.
constexpr double kSizeWeight = 0.001;

/// @param first  place of its first vertex
/// @param none   place of what is missing
void append_grid(const ClothRange& cloth, std::uint32_t first, std::uint32_t none,
                 CodingOrder& order) {
  const std::uint32_t n = cloth.columns;
  for (std::uint32_t i = 0; i < cloth.vertices; ++i) {
    const std::uint32_t at = first + i;
    const bool left = i % n > 0, above = i >= n;
    Neighbours near{none, none, none};
    if (left)
      near.a = at - 1;
    else if (above)
      near.a = at - n;
    if (left && above) near.b = at - n, near.c = at - n - 1;
    order.vertices.push_back(cloth.first_vertex + i);
    order.neighbours.push_back(near);
  }
}

/// Chooses the neighbours of one vertex of a mesh after another.
class MeshNeighbours {
 public:
  MeshNeighbours(const Adjacency& adjacency, std::span<const float> rest, std::uint32_t none)
      : adjacency_(adjacency), rest_(rest), none_(none), place_(adjacency.vertices(), none) {}

  void take(std::uint32_t vertex, std::uint32_t place) { place_[vertex] = place; }

  /// The best for a vertex that has not been taken yet.
  Neighbours choose(std::uint32_t vertex) {
    before_.clear();
    for (const std::uint32_t other : adjacency_.of(vertex))
      if (place_[other] != none_) before_.push_back(other);
    std::sort(before_.begin(), before_.end(),
              [&](std::uint32_t p, std::uint32_t q) { return place_[p] > place_[q]; });
    if (before_.empty()) return {none_, none_, none_};
    if (before_.size() == 1) return {place_[before_[0]], none_, none_};
    Neighbours best{place_[before_[0]], place_[before_[1]], place_[before_[1]]};
    double least = -1;
    for (std::size_t j = 1; j < before_.size(); ++j)
      for (std::size_t i = 0; i < j; ++i) try_pair(vertex, before_[i], before_[j], least, best);
    return best;
  }

 private:
  void try_pair(std::uint32_t vertex, std::uint32_t a, std::uint32_t b, double& least,
                Neighbours& best) const {
    for (const std::uint32_t c : adjacency_.of(a)) {
      if (c == vertex || place_[c] == none_ || !adjacency_.are_joined(b, c)) continue;
      const double cost = misfit(vertex, a, b, c);
      const Neighbours found{place_[a], place_[b], place_[c]};
      const bool later = std::min({found.a, found.b, found.c}) > std::min({best.a, best.b, best.c});
      if (least >= 0 && (cost > least || (cost == least && !later))) continue;
      least = cost;
      best = found;
    }
  }

  double misfit(std::uint32_t i, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    double open = 0, size = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double xa = rest_[3 * a + k], xb = rest_[3 * b + k], xc = rest_[3 * c + k];
      const double gap = rest_[3 * i + k] - xa - xb + xc;
      open += gap * gap;
      size += (xa - xc) * (xa - xc) + (xb - xc) * (xb - xc);
    }
    return open + kSizeWeight * size;
  }

  const Adjacency& adjacency_;
  std::span<const float> rest_;
  std::uint32_t none_;
  std::vector<std::uint32_t> place_;   // of each vertex; none_: not taken yet
  std::vector<std::uint32_t> before_;  // neighbours taken before, the latest first
};

void append_mesh(const ClothRange& cloth, std::span<const float> rest,
                 std::span<const std::uint32_t> triangles, std::uint32_t none, CodingOrder& order) {
  const Adjacency adjacency(
      cloth.first_vertex, cloth.vertices,
      triangles.subspan(3 * std::size_t{cloth.first_triangle}, 3 * std::size_t{cloth.triangles}));
  MeshNeighbours neighbours(adjacency, rest.subspan(3 * std::size_t{cloth.first_vertex}), none);
  for (const std::uint32_t vertex : adjacency.breadth_first()) {
    order.neighbours.push_back(neighbours.choose(vertex));
    neighbours.take(vertex, order.size());
    order.vertices.push_back(cloth.first_vertex + vertex);
  }
}

bool is_natural(const CodingOrder& order) {
  for (std::uint32_t i = 0; i < order.size(); ++i)
    if (order.vertices[i] != i) return false;
  return true;
}

}  // namespace

bool all_grids(std::span<const ClothRange> cloths) {
  return std::all_of(cloths.begin(), cloths.end(), [](const ClothRange& cloth) {
    return cloth.columns > 0 && std::uint64_t{cloth.rows} * cloth.columns == cloth.vertices;
  });
}

CodingOrder make_order(std::span<const float> rest, std::span<const std::uint32_t> triangles,
                       std::span<const ClothRange> cloths) {
  CodingOrder order;
  const auto none = static_cast<std::uint32_t>(rest.size() / 3);
  order.vertices.reserve(none);
  order.neighbours.reserve(none);
  for (const ClothRange& cloth : cloths) {
    if (all_grids({&cloth, 1}))
      append_grid(cloth, order.size(), none, order);
    else
      append_mesh(cloth, rest, triangles, none, order);
  }
  order.natural = is_natural(order);
  return order;
}

std::vector<std::uint32_t> order_words(const CodingOrder& order) {
  std::vector<std::uint32_t> words;
  words.reserve(4 * std::size_t{order.size()});
  const auto word = [&order](std::uint32_t at) { return at == order.size() ? kMissing : at; };
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Neighbours& near = order.neighbours[i];
    words.insert(words.end(), {order.vertices[i], word(near.a), word(near.b), word(near.c)});
  }
  return words;
}

Result<CodingOrder> read_order(std::span<const std::uint32_t> words, std::uint32_t vertices) {
  if (words.size() != 4 * std::size_t{vertices})
    return binary_error("the order does not fit the mesh");
  CodingOrder order;
  order.vertices.reserve(vertices);
  order.neighbours.reserve(vertices);
  std::vector<bool> taken(vertices, false);
  for (std::uint32_t i = 0; i < vertices; ++i) {
    const std::uint32_t vertex = words[4 * std::size_t{i}];
    if (vertex >= vertices || taken[vertex]) return binary_error("the order is none of vertices");
    taken[vertex] = true;
    std::array<std::uint32_t, 3> near{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t at = words[4 * std::size_t{i} + 1 + k];
      if (at >= i && at != kMissing) return binary_error("a neighbour does not come before");
      near[k] = at == kMissing ? vertices : at;
    }
    order.vertices.push_back(vertex);
    order.neighbours.push_back({near[0], near[1], near[2]});
  }
  order.natural = is_natural(order);
  return order;
}

}  // namespace weft::proto::codec
