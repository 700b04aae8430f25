#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

namespace weft {

/// Repairs the meshes of a scene's objects where there is no doubt what is meant (mesh_repair.h),
/// and says what was done: a sentence each, for people, with the object's name.
std::vector<std::string> repair_objects(WorldDef& def);

}  // namespace weft
