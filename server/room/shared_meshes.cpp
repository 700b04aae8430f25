#include "server/room/shared_meshes.h"

namespace weft::server {

std::shared_ptr<const MeshShape<float>> SharedMeshes::prepared(const TriangleMesh& mesh) {
  const auto shape_of = [](const std::shared_ptr<const Entry>& entry) {
    return std::shared_ptr<const MeshShape<float>>(entry, &entry->shape);
  };
  {
    const std::scoped_lock lock(mutex_);
    if (const auto known = find(mesh)) return shape_of(known);
  }
  // Others go on meanwhile, and may prepare the same.
  auto made = std::make_shared<const Entry>(Entry{mesh, prepare_mesh<float>(mesh)});
  const std::scoped_lock lock(mutex_);
  if (const auto known = find(mesh)) return shape_of(known);
  entries_.push_back(made);
  return shape_of(made);
}

std::shared_ptr<const SharedMeshes::Entry> SharedMeshes::find(const TriangleMesh& mesh) {
  std::erase_if(entries_, [](const auto& entry) { return entry.expired(); });
  for (const std::weak_ptr<const Entry>& held : entries_) {
    const std::shared_ptr<const Entry> entry = held.lock();
    if (entry && entry->mesh.triangles == mesh.triangles && entry->mesh.positions == mesh.positions)
      return entry;
  }
  return nullptr;
}

}  // namespace weft::server
