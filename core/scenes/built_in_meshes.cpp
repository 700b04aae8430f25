#include "core/scenes/built_in_meshes.h"

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/scenes/dress_form.h"

namespace weft {

const std::vector<std::string>& built_in_mesh_names() {
  static const std::vector<std::string> names = {"dress-form", "bunny"};
  return names;
}

MeshFile built_in_mesh(const std::string& name, const std::string& directory) {
  if (name == "dress-form") return {make_dress_form(), {}};
  if (name != "bunny") {
    std::string names;
    for (const std::string& each : built_in_mesh_names())
      names += (names.empty() ? "" : ", ") + each;
    throw DefinitionError("mesh", name, "one of " + names);
  }
  const std::string path = directory + "/" + name + ".ply";
  std::ifstream file(path, std::ios::binary);
  if (directory.empty() || !file)
    throw DefinitionError("mesh", name, "a mesh that is installed",
                          "its package comes with ./dev setup and is converted by the build");
  return read_mesh(std::string(std::istreambuf_iterator<char>(file), {}), path);
}

}  // namespace weft
