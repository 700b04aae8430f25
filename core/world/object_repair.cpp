// Repairs objects' meshes and reports what was done.

#include "core/world/object_repair.h"

#include <variant>

#include "core/geometry/mesh_repair.h"
#include "core/world/object_name.h"

namespace weft {

std::vector<std::string> repair_objects(WorldDef& def) {
  std::vector<std::string> told;
  for (std::size_t k = 0; k < def.colliders.size(); ++k) {
    auto* const shape = std::get_if<MeshDef>(&def.colliders[k].shape);
    if (!shape) continue;
    const std::string name = object_name(def, k);
    const MeshRepair done = repair(shape->mesh);
    if (done.dropped > 0)
      told.push_back(
          name + ": " + std::to_string(done.dropped) + " of its " + std::to_string(done.triangles) +
          " triangles have no area and are left out" +
          (done.opened ? "; it is not closed without them, so cloth inside is not led out" : ""));
    if (done.turned)
      told.push_back(name + ": its triangles faced inwards and are turned, so that it is solid");
  }
  return told;
}

}  // namespace weft
