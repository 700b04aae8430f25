#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/error.h"

// In which order the codec takes the vertices of a scene, and which earlier ones predict each.
// README.md section 10.

namespace weft::proto::codec {

/// Places of earlier vertices from which one is predicted: along two edges and at the corner that
/// these span. A place that is missing is the number of vertices, where all values are 0.
struct Neighbours {
  std::uint32_t a = 0, b = 0, c = 0;
  bool operator==(const Neighbours&) const = default;
};

/// One cloth of a scene, as the text message `mesh` describes it.
struct ClothRange {
  std::uint32_t first_vertex = 0, vertices = 0;
  std::uint32_t first_triangle = 0, triangles = 0;
  std::uint32_t rows = 0, columns = 0;  ///< of a grid, whose vertices are row by row; else 0
};

struct CodingOrder {
  std::vector<std::uint32_t> vertices;  ///< the vertex at each place
  std::vector<Neighbours> neighbours;   ///< of each place; each before it, or missing
  bool natural = true;                  ///< every vertex stands at the place of its own number
  bool operator==(const CodingOrder&) const = default;
  std::uint32_t size() const { return static_cast<std::uint32_t>(vertices.size()); }
};

/// Grids are taken row by row; other cloths breadth first from a vertex at their rim, each
/// predicted by the earlier parallelogram that fits best at rest.
/// @param rest       three per vertex [m]
/// @param triangles  three per triangle, indices of the scene, in range
/// @param cloths     ranges that follow each other and together cover all vertices
CodingOrder make_order(std::span<const float> rest, std::span<const std::uint32_t> triangles,
                       std::span<const ClothRange> cloths);

/// Whether all cloths are grids, whose order clients work out by themselves.
bool all_grids(std::span<const ClothRange> cloths);

/// The payload of the mesh's section `order`: vertex, a, b, c of each place; missing: 2^32 - 1.
std::vector<std::uint32_t> order_words(const CodingOrder& order);

/// Reads such a payload. Refuses a vertex that is absent or there twice, and a neighbour that does
/// not come before.
Result<CodingOrder> read_order(std::span<const std::uint32_t> words, std::uint32_t vertices);

}  // namespace weft::proto::codec
