#pragma once

#include <string>

#include "core/geometry/triangle_mesh.h"

namespace weft {

/// Writes a mesh as Wavefront OBJ or PLY, by the ending of `path` (".obj" or ".ply"), replacing a
/// file of that name. Positions keep float precision. PLY keeps the order of the vertices; OBJ
/// lists them as the triangles name them first, and those at exactly one place become one. Throws
/// DefinitionError on another ending or if the file cannot be written.
void write_mesh(const TriangleMesh& mesh, const std::string& path);

}  // namespace weft
