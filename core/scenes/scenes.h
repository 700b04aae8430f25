#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

// Built-in scenes by name.

namespace weft {

struct SceneInfo {
  std::string name;
  std::string description;     ///< one sentence on what to look at
  std::string installed = {};  ///< required mesh of the packages; empty: none
};

/// The built-in scenes, the default first.
const std::vector<SceneInfo>& scenes();

/// A built-in scene by name.
/// @param mesh_directory  of the meshes from packages; see built_in_mesh
/// Throws DefinitionError if the name is unknown or the mesh not installed.
WorldDef make_scene(const std::string& name, const std::string& mesh_directory = {});

}  // namespace weft
