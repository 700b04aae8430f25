#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/geometry/mesh_file.h"
#include "core/world/world_def.h"

namespace weft::server {

inline constexpr std::size_t kMostSceneBytes = 1 << 20;

/// Finds the mesh that a scene names. Throws DefinitionError on field "mesh" if there is none, or
/// if the scene's author may not use it.
using MeshSource = std::function<MeshFile(const std::string& name)>;

/// Reads a scene file: JSON as server/scene.schema.json says, at most kMostSceneBytes, at most 8
/// levels deep. Omitted values keep their defaults.
///
/// Throws DefinitionError whose field is the path of the key, e.g. "cloths[0].fabric.shear", on
/// anything that the schema does not allow, and on errors that only the whole scene can show: a
/// mesh that does not exist or is degenerate, two cloths of one name, a pin without its cloth, a
/// shear stiffness too large for the cells.
WorldDef read_scene(std::string_view text, const MeshSource& meshes);

/// The scene as a file that `read_scene` turns back into the same definition. Throws
/// DefinitionError if a mesh in it has no name.
std::string write_scene(const WorldDef& def);

}  // namespace weft::server
