#include "server/commands/list_scenes.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/scenes/scenes.h"
#include "server/options.h"
#include "server/scene/scene_file.h"
#include "server/scene/scene_library.h"
#include "server/scene/scene_schema.h"

namespace weft::server {

using Json = nlohmann::ordered_json;

int list_scenes(const ScenesOptions& options) {
  if (options.schema) {
    std::fputs(scene_schema().c_str(), stdout);
    return 0;
  }
  if (!options.name.empty()) {
    if (!options.json) throw OptionError("NAME", options.name, "a name together with --json");
    std::fputs(write_scene(SceneLibrary(beside_program("meshes")).opened(options.name)).c_str(),
               stdout);
    return 0;
  }
  Json list = Json::array();
  std::size_t longest = 0;
  for (const SceneInfo& scene : scenes()) {
    list.push_back({{"name", scene.name}, {"description", scene.description}});
    longest = std::max(longest, scene.name.size());
  }
  if (options.json) {
    std::printf("%s\n", Json{{"scenes", list}}.dump(2).c_str());
    return 0;
  }
  for (const SceneInfo& scene : scenes())
    std::printf("%-*s  %s\n", static_cast<int>(longest), scene.name.c_str(),
                scene.description.c_str());
  return 0;
}

}  // namespace weft::server
