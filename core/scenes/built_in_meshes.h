#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh_file.h"

namespace weft {

/// The meshes that any scene may name. Some are made by code, others are files that come with the
/// program's packages.
const std::vector<std::string>& built_in_mesh_names();

/// @param name       one of `built_in_mesh_names`
/// @param directory  where the installed ones are, as <name>.ply; may be empty if there are none
/// Throws DefinitionError on field "mesh" if there is none of this name, or if it is not installed.
MeshFile built_in_mesh(const std::string& name, const std::string& directory);

}  // namespace weft
