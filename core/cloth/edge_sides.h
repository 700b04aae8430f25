#pragma once

#include <array>
#include <vector>

#include "core/types.h"

// What lies on both sides of the edges of a mesh.

namespace weft {

/// An edge and the one or two triangles at it.
struct EdgeSides {
  Edge ends = {kNone, kNone};
  std::array<Index, 2> triangle = {kNone, kNone};
  std::array<Index, 2> opposite = {kNone, kNone};  ///< their third corners

  bool is_border() const { return triangle[1] == kNone; }
};

/// All edges of triangles, at most two of which share one, sorted by their ends.
std::vector<EdgeSides> sides_of(const std::vector<Triangle>& triangles);

/// The edges of each triangle, opposite to its corners.
/// @param edges  of these triangles, all of them
std::vector<std::array<Index, 3>> edges_of_triangles(const std::vector<EdgeSides>& edges,
                                                     const std::vector<Triangle>& triangles);

}  // namespace weft
