#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/contact/objects/mesh_store.h"

namespace weft::server {

/// Prepared meshes of the objects of all rooms, each for as long as a world has it. Callable from
/// any thread.
class SharedMeshes : public MeshStore {
 public:
  std::shared_ptr<const MeshShape<float>> prepared(const TriangleMesh& mesh) override;

 private:
  struct Entry {
    TriangleMesh mesh;
    MeshShape<float> shape;
  };

  /// The entry of an equal mesh; null if there is none. The caller holds the lock.
  std::shared_ptr<const Entry> find(const TriangleMesh& mesh);

  std::mutex mutex_;
  std::vector<std::weak_ptr<const Entry>> entries_;
};

}  // namespace weft::server
