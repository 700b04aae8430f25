#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/constants.h"
#include "core/geometry/triangle_mesh.h"

// Reads and writes triangle meshes in common file formats.

namespace weft {

/// A mesh of a file with several.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
  std::vector<CornerUv> corner_uv = {};  ///< by triangle, or empty
};

/// Encodes meshes as Wavefront OBJ or PLY, by the extension of the file's name (".obj" or ".ply").
/// Numbers keep float precision. PLY keeps the order of the vertices, without names and uv; OBJ
/// lists them in the order of first use by the triangles, and merges those at exactly the same
/// position. Each mesh is a group `g` of an OBJ. Throws DefinitionError on another extension.
std::string encode_meshes(const std::vector<NamedMesh>& meshes, const std::string& name);

/// Content of a mesh file.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::array<double, 2>> uv;  ///< one per vertex, or empty; a downward v is not flipped
  std::vector<CornerUv> corner_uv = {};   ///< by triangle; empty unless a vertex has several
  std::string flat_face = {};             ///< names the first polygon without area, if any
};

/// Largest accepted file; checked before and after parsing.
struct MeshFileLimits {
  std::size_t bytes = 64 << 20;
  std::size_t vertices = kMostMeshVertices;
  std::size_t triangles = kMostMeshTriangles;
};

/// Whether the name ends in .obj, .ply, .stl or .glb, in whatever case.
bool is_mesh_file_name(std::string_view name);

/// Reads OBJ, PLY, STL or GLB. All meshes of the file are merged, with their nodes' transformations
/// applied; polygons are cut into triangles (polygon_cut.h), points and lines dropped; vertices at
/// exactly the same position are merged, in the order of first use in the file, and those of seams
/// that rounding has opened (mesh_seams.h). Their uv is that of the first; where
/// others have another, at a seam, `corner_uv` keeps what each triangle has at its corners. A face
/// without uv in a file with some has all three corners in one place there.
///
/// The parser is not safe for every file: one from an untrusted source is parsed in a separate
/// process with limits (server/scene/mesh_child.h).
///
/// @param bytes  the whole file
/// @param name   for its ending and for errors
/// Throws DefinitionError on field "mesh": another extension, too large, unreadable, a vertex that
/// is not finite or farther than 1e6, a polygon that cannot be cut, or no triangles.
/// validate(TriangleMesh) checks areas.
MeshFile read_mesh(std::string_view bytes, const std::string& name,
                   const MeshFileLimits& limits = {});

}  // namespace weft
