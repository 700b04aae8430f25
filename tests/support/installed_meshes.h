#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include "core/scenes/scenes.h"

namespace weft::test {

/// Where the build puts the meshes of installed packages; not there when only core is built.
inline std::string mesh_directory() {
  const char* build = std::getenv("WEFT_BUILD_DIR");
  return build ? std::string(build) + "/meshes" : std::string();
}

inline bool has_mesh(const std::string& name) {
  return std::ifstream(mesh_directory() + "/" + name + ".ply").good();
}

/// Whether the mesh that a scene wants is there, if it wants one.
inline bool is_installed(const SceneInfo& scene) {
  return scene.installed.empty() || has_mesh(scene.installed);
}

}  // namespace weft::test
