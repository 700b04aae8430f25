#pragma once

#include <vector>

#include "core/types.h"

// Sides of triangles, for finding neighbours.

namespace weft {

/// An edge in the orientation of one of its triangles.
struct TriangleSide {
  Edge ends = {kNone, kNone};
  Index triangle = kNone;
  Index corner = 0;  ///< of the triangle, opposite to the edge: 0 to 2
};

/// The sides of all triangles, sorted by their ends and then by triangle, so that shared sides are
/// adjacent.
std::vector<TriangleSide> sorted_sides(const std::vector<Triangle>& triangles);

}  // namespace weft
