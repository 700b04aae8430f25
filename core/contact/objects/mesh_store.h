#pragma once

#include <memory>

#include "core/contact/objects/mesh_shape.h"
#include "core/geometry/triangle_mesh.h"

// Interface to what worlds share of their objects.

namespace weft {

/// Keeps meshes that have been prepared for contact, so that worlds with the same mesh share one:
/// in many worlds by turns it stays in the cache. Its owner guards it where it builds worlds on
/// several threads.
class MeshStore {
 public:
  virtual ~MeshStore() = default;

  /// What `prepare_mesh` makes of a mesh, made now or before.
  virtual std::shared_ptr<const MeshShape<float>> prepared(const TriangleMesh& mesh) = 0;
};

}  // namespace weft
