#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

namespace weft {

struct SceneInfo {
  std::string name;
  std::string description;  ///< one sentence on what to look at
};

/// The built-in scenes, the default first.
const std::vector<SceneInfo>& scenes();

/// A built-in scene by name. Throws DefinitionError on an unknown one.
WorldDef make_scene(const std::string& name);

}  // namespace weft
