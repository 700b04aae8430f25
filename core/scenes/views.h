#pragma once

#include <optional>
#include <string>

#include "core/world/view_def.h"

// First views of built-in scenes.

namespace weft {

/// Where a built-in scene is best looked at from; nothing if the viewer had better choose.
std::optional<ViewDef> view_of_scene(const std::string& name);

}  // namespace weft
