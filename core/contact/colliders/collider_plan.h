#pragma once

#include <vector>

#include "core/contact/colliders/collider_state.h"

// Plans how colliders move in a tick: towards their goals, and as far as their force allows.

namespace weft {

/// Plans the coming tick: from the present poses towards those of keyframes or commands, within the
/// speed limits.
/// @param time     at the start of the tick [s]
/// @param seconds  length of the tick
void plan_motion(const std::vector<ColliderDef>& colliders, double time, double seconds,
                 ColliderStates& states);

/// Ends the tick: slows colliders whose resistance exceeds their force, and lets those that stand
/// yield to it.
void finish_motion(const std::vector<ColliderDef>& colliders, double seconds,
                   ColliderStates& states);

}  // namespace weft
