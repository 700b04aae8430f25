#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft::proto::codec {

/// Which vertices of a triangle mesh share an edge. Triangles with two equal corners join nothing
/// by these.
class Adjacency {
 public:
  /// @param first      index of the first vertex in `triangles`; here it is vertex 0
  /// @param triangles  three indices per triangle, from `first` to below `first + vertices`
  Adjacency(std::uint32_t first, std::uint32_t vertices, std::span<const std::uint32_t> triangles);

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(starts_.size() - 1); }

  /// Its neighbours, each once, in ascending order.
  std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return {ends_.data() + starts_[vertex], starts_[vertex + 1] - starts_[vertex]};
  }

  bool are_joined(std::uint32_t a, std::uint32_t b) const;

  /// All vertices, component by component, each breadth first from a vertex at its rim (two
  /// searches, each from the last vertex that the one before found); among neighbours those of few
  /// neighbours first.
  std::vector<std::uint32_t> breadth_first() const;

 private:
  void search(std::uint32_t from, std::uint32_t mark, std::vector<std::uint32_t>& marks,
              std::vector<std::uint32_t>& found) const;

  std::vector<std::uint32_t> starts_, ends_;
};

}  // namespace weft::proto::codec
