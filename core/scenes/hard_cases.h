#pragma once

#include <vector>

#include "core/scenes/scene_parts.h"

namespace weft {

/// Guards a scene's cloth against itself, and says what it must keep to (see VerdictDef).
/// @param strain       largest one allowed, above 0 to 1000
/// @param lost_motion  part of the wanted motion that the guard may take, 0 to 1
/// @param clear_after  from when on nothing may cross [s], 0 to 3600
void judge(WorldDef& def, double strain, double lost_motion = 0.2, double clear_after = 0);

/// Scenes that are hard to keep free of crossings, each with what it must keep to.
std::vector<SceneEntry> hard_cases();

/// The second list of them: ratios, ticks, forces and winds far beyond use.
std::vector<SceneEntry> more_hard_cases();

/// The third list of them: starts with cloth through cloth.
std::vector<SceneEntry> tangled_cases();

/// The fourth list of them: cloth that hands fold and unfold.
std::vector<SceneEntry> folding_cases();

}  // namespace weft
