#pragma once

#include <array>
#include <vector>

#include "core/cloth/cloth_def.h"

// Places of a mesh in its fabric, from the (u, v) of its file.

namespace weft {

/// Places in the fabric [m].
struct MeshMaterial {
  std::vector<std::array<double, 2>> of_vertices;
  std::vector<CornerUv> of_corners;  ///< by triangle; empty: those of their vertices
};

/// Throws DefinitionError if there are not as many (u, v) as vertices, or as triangles.
void refuse_other_uv(const ClothMesh& cloth);

/// Whether a vertex has several (u, v). The mesh must be valid, and refuse_other_uv() accept it.
bool has_seams(const ClothMesh& cloth);

/// Places in the fabric of a mesh that is at rest as it lies: the (u, v), scaled equally in both
/// directions so that the areas agree. Triangles without an area there, of at most half of the mesh
/// in all, continue the threads of what lies beside them. Without usable ones it is the projection
/// along the axis that the mesh faces most, with v downwards.
MeshMaterial material_of(const ClothMesh& cloth);

/// The same mesh, laid flat by its (u, v); it must have no seams. Throws DefinitionError if a
/// triangle has no area there or is turned over.
ClothDef laid_out(const ClothDef& def);

/// Places in the fabric of a mesh with seams whose triangles rest as they lie there, each on its
/// own. Throws DefinitionError if one has no area.
MeshMaterial pieces_of(const ClothMesh& cloth);

/// The doubled area of a triangle in (u, v), negative where it is turned over.
double doubled_area(const CornerUv& corners);

}  // namespace weft
