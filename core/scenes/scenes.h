#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

namespace weft {

struct SceneInfo {
  std::string name;
  std::string description;     ///< one sentence on what to look at
  std::string installed = {};  ///< mesh that has to be installed for it; empty: none
};

/// The built-in scenes, the default first.
const std::vector<SceneInfo>& scenes();

/// A built-in scene by name.
/// @param mesh_directory  of the meshes that are installed with packages; see built_in_mesh
/// Throws DefinitionError on an unknown name, or if its mesh is not installed.
WorldDef make_scene(const std::string& name, const std::string& mesh_directory = {});

}  // namespace weft
