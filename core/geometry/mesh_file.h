#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace weft {

/// The bytes of a file that holds a mesh, as Wavefront OBJ or PLY by the ending of its name (".obj"
/// or ".ply"). Positions keep float precision. PLY keeps the order of the vertices; OBJ lists them
/// as the triangles name them first, and those at exactly one place become one. Throws
/// DefinitionError on another ending.
std::string encode_mesh(const TriangleMesh& mesh, const std::string& name);

/// What a file holds.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::array<double, 2>> uv;  ///< one a vertex, or none; v downwards is not undone
};

/// What a file may hold at most; checked before and after parsing.
struct MeshFileLimits {
  std::size_t bytes = 64 << 20;
  std::size_t vertices = 1'000'000;
  std::size_t triangles = 2'000'000;
};

/// Whether the name ends in .obj, .ply, .stl or .glb, in small letters.
bool is_mesh_file_name(std::string_view name);

/// Reads OBJ, PLY, STL or GLB. All meshes of the file become one, with their nodes'
/// transformations; polygons are cut into triangles, points and lines left out; vertices at exactly
/// one place become one, with the uv of the first, in the order in which the file names them.
///
/// The parser is not safe against every file: one that a stranger may have written is parsed in a
/// process of its own with limits (server/mesh_store.h).
///
/// @param bytes  the whole file
/// @param name   for its ending and for errors
/// Throws DefinitionError on field "mesh": another ending, too large, not readable, a vertex that
/// is not finite or farther than 1e6, or nothing in it. Areas are judged by validate(TriangleMesh).
MeshFile read_mesh(std::string_view bytes, const std::string& name,
                   const MeshFileLimits& limits = {});

}  // namespace weft
