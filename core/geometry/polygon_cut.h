#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.h"

// Cuts the polygons of mesh files into triangles.

namespace weft {

/// Triangles of a polygon, or why there are none.
struct PolygonCut {
  std::vector<Triangle> triangles;  ///< of the numbers of its corners, turning as it does
  bool has_area = true;             ///< without area the triangles are flat
  std::string limit = {};           ///< what it breaks, if it cannot be cut
};

/// Cuts a polygon, convex or concave, into triangles that cover it and have all its corners. No
/// triangle reaches outside, and none is flat where corners lie in a row, as long as the polygon
/// can be cut otherwise; well-shaped ones are cut off first. A polygon that is not plane is cut as
/// seen along its mean normal. One of four corners is cut from its concave or flat corner, else
/// from its first. Consecutive corners in one place count as one. Sides may lie on each other, as
/// where a cut joins a hole to the border, but not cross.
PolygonCut cut_polygon(std::span<const Vec3d> corners);

}  // namespace weft
