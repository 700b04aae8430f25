#pragma once

#include <cstddef>

#include "core/geometry/triangle_mesh.h"

namespace weft {

/// What was done to a mesh.
struct MeshRepair {
  std::size_t dropped = 0;    ///< triangles without area
  std::size_t triangles = 0;  ///< before
  bool opened = false;        ///< it was closed with them, and is not without
  bool turned = false;        ///< its triangles faced inwards
};

/// Whether a triangle spans no area that contact could use (a doubled area of at most 1e-14 m^2).
/// Its indices have to be those of vertices.
bool is_degenerate(const TriangleMesh& mesh, const Triangle& triangle);

/// Makes an object's mesh fit for contact where there is no doubt what is meant. Triangles without
/// area go. Of one that lies flat along a neighbour's side, the neighbour is cut in two at its
/// middle corner, so that a closed surface stays closed. A closed mesh that encloses a negative
/// volume is turned, because its inside would be the rest of the world. Everything else stays as it
/// is, wrong indices too, which validate() refuses by name.
MeshRepair repair(TriangleMesh& mesh);

}  // namespace weft
