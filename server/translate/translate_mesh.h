#pragma once

#include "core/world/world_def.h"
#include "proto/frames/mesh.h"

// How large the mesh message of a scene will be, in types of the wire.

namespace weft::server {

/// Of a scene that is not yet built.
proto::MeshSize mesh_size(const WorldDef& def);

}  // namespace weft::server
