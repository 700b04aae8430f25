#pragma once

#include <string>

#include "core/geometry/triangle_mesh.h"

namespace weft {

/// Writes a mesh as Wavefront OBJ or PLY, by the ending of `path` (".obj" or ".ply"), replacing a file
/// of that name.
/// Throws DefinitionError on another ending or if the file cannot be written.
void write_mesh(const TriangleMesh& mesh, const std::string& path);

}  // namespace weft
