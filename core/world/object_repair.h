#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

// Repair of objects' meshes at the start of a world.

namespace weft {

/// Repairs the meshes of a scene's objects where their meaning is clear (mesh_repair.h). Returns
/// one sentence per repair, with the object's name.
std::vector<std::string> repair_objects(WorldDef& def);

}  // namespace weft
