#include "server/translate/translate_mesh.h"

#include <algorithm>
#include <variant>

namespace weft::server {
namespace {

std::size_t count_of(int number) {
  return static_cast<std::size_t>(std::max(number, 0));
}

void add_cloth(const ClothDef& cloth, proto::MeshSize& size) {
  if (cloth.mesh) {
    size.vertices += cloth.mesh->mesh.positions.size();
    size.triangles += cloth.mesh->mesh.triangles.size();
    size.has_order = true;
    return;
  }
  size.vertices += count_of(cloth.rows) * count_of(cloth.columns);
  size.triangles += 2 * count_of(cloth.rows - 1) * count_of(cloth.columns - 1);
}

}  // namespace

proto::MeshSize mesh_size(const WorldDef& def) {
  proto::MeshSize size;
  for (const ClothDef& cloth : def.cloths) add_cloth(cloth, size);
  for (const ColliderDef& collider : def.colliders) {
    if (const auto* mesh = std::get_if<MeshDef>(&collider.shape))
      size.colliders.push_back({mesh->mesh.positions.size(), mesh->mesh.triangles.size()});
  }
  return size;
}

}  // namespace weft::server
