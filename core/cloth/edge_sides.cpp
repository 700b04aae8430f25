// Lists the edges of triangles with what is beside them.

#include "core/cloth/edge_sides.h"

#include <algorithm>
#include <cassert>

#include "core/geometry/triangle_sides.h"

namespace weft {

std::vector<EdgeSides> sides_of(const std::vector<Triangle>& triangles) {
  std::vector<EdgeSides> edges;
  for (const TriangleSide& side : sorted_sides(triangles)) {
    if (edges.empty() || edges.back().ends != side.ends)
      edges.push_back({side.ends, {kNone, kNone}, {kNone, kNone}});
    EdgeSides& edge = edges.back();
    const std::size_t second = edge.triangle[0] == kNone ? 0 : 1;
    assert(edge.triangle[second] == kNone && "at most two triangles at an edge");
    edge.triangle[second] = side.triangle;
    edge.opposite[second] =
        triangles[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)];
  }
  return edges;
}

std::vector<std::array<Index, 3>> edges_of_triangles(const std::vector<EdgeSides>& edges,
                                                     const std::vector<Triangle>& triangles) {
  std::vector<std::array<Index, 3>> of(triangles.size(), {kNone, kNone, kNone});
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (edges[e].triangle[side] == kNone) continue;
      const auto t = static_cast<std::size_t>(edges[e].triangle[side]);
      const auto corner =
          std::find(triangles[t].begin(), triangles[t].end(), edges[e].opposite[side]);
      of[t][static_cast<std::size_t>(corner - triangles[t].begin())] = static_cast<Index>(e);
    }
  }
  return of;
}

}  // namespace weft
