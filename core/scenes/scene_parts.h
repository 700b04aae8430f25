#pragma once

#include <string>

#include "core/scenes/scenes.h"

// Building blocks of built-in scenes.

namespace weft {

/// A built-in scene: its description and its builder.
struct SceneEntry {
  SceneInfo info;
  void (*build)(WorldDef& def, const std::string& mesh_directory);
};

/// Ground at y = 0.
ColliderDef ground();

/// A cloth hanging in the plane z = `depth`, with its upper edge centred at height `top`.
ClothDef hanging_cloth(int rows, int columns, double width, double height, double top,
                       double depth);

/// A square sheet lying at `height`, centred over the origin.
ClothDef lying_cloth(int particles, double side, double height);

/// A built-in mesh, placed in the scene.
/// @param mesh_directory  see built_in_mesh
MeshDef mesh_object(const std::string& name, const std::string& mesh_directory,
                    MeshPlacement placement);

}  // namespace weft
