#pragma once

#include <string>

#include "core/scenes/scenes.h"

// What built-in scenes are put together from.

namespace weft {

/// A built-in scene: what it is called and how it is made.
struct SceneEntry {
  SceneInfo info;
  void (*build)(WorldDef& def, const std::string& mesh_directory);
};

/// Ground at y = 0.
ColliderDef ground();

/// A cloth that hangs in the plane z = `depth`, its upper edge centred at height `top`.
ClothDef hanging_cloth(int rows, int columns, double width, double height, double top,
                       double depth);

/// A square sheet that lies at `height`, centred over the origin.
ClothDef lying_cloth(int particles, double side, double height);

/// A built-in mesh in its place.
/// @param mesh_directory  see built_in_mesh
MeshDef mesh_object(const std::string& name, const std::string& mesh_directory,
                    MeshPlacement placement);

}  // namespace weft
