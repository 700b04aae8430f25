#pragma once

#include <cstddef>

#include "core/geometry/triangle_mesh.h"

// Repairs meshes of objects so that contact can use them.

namespace weft {

/// Summary of a repair.
struct MeshRepair {
  std::size_t dropped = 0;    ///< triangles without area
  std::size_t triangles = 0;  ///< before
  bool opened = false;        ///< closed before, but open after the removal
  bool turned = false;        ///< its triangles faced inwards
};

/// Whether a triangle is too small for contact (a doubled area of at most 1e-14 m^2). Its indices
/// must be valid.
bool is_degenerate(const TriangleMesh& mesh, const Triangle& triangle);

/// Makes an object's mesh fit for contact where its meaning is clear. Triangles without area are
/// removed. If one lies flat along a neighbour's side, that neighbour is split at its middle
/// corner, so that a closed surface stays closed. A closed mesh that encloses a negative volume is
/// turned inside out, because its inside would be the rest of the world. Everything else stays,
/// including wrong indices, which validate() reports.
MeshRepair repair(TriangleMesh& mesh);

}  // namespace weft
