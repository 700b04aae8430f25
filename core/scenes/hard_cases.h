#pragma once

#include <vector>

#include "core/scenes/scene_parts.h"

namespace weft {

/// Scenes that are hard to keep free of crossings, each with what it must keep to.
std::vector<SceneEntry> hard_cases();

/// The second list of them: ratios, ticks, forces and winds far beyond use.
std::vector<SceneEntry> more_hard_cases();

/// The third list of them: starts with cloth through cloth.
std::vector<SceneEntry> tangled_cases();

}  // namespace weft
