#pragma once

#include <vector>

#include "core/types.h"

namespace weft {

/// An edge as one of its triangles sees it.
struct TriangleSide {
  Edge ends = {kNone, kNone};
  Index triangle = kNone;
  Index corner = 0;  ///< of the triangle, opposite to the edge: 0 to 2
};

/// The three sides of all triangles, ordered by their ends and then by triangle: those of
/// neighbours stand side by side.
std::vector<TriangleSide> sorted_sides(const std::vector<Triangle>& triangles);

}  // namespace weft
