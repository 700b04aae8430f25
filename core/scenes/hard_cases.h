#pragma once

#include <vector>

#include "core/scenes/scene_parts.h"

// Scenes that try to break the promise that nothing crosses.

namespace weft {

/// Guards a scene's cloth against itself, and sets its limits (see VerdictDef).
/// @param strain       largest allowed, above 0 to 1000
/// @param lost_motion  fraction of the wanted motion that the guard may take, 0 to 1
/// @param clear_after  time after which nothing may cross [s], 0 to 3600
void judge(WorldDef& def, double strain, double lost_motion = 0.2, double clear_after = 0);

/// Scenes that are hard to keep free of crossings, with their limits.
std::vector<SceneEntry> hard_cases();

/// The second list: ratios, ticks, forces and winds far beyond normal use.
std::vector<SceneEntry> more_hard_cases();

/// The third list: starts with cloth through cloth.
std::vector<SceneEntry> tangled_cases();

/// The fourth list: cloth that hands fold and unfold.
std::vector<SceneEntry> folding_cases();

}  // namespace weft
