#pragma once

#include <array>
#include <vector>

#include "core/contact/colliders/collider_state.h"

// Plans how colliders move in a tick: towards their goals, and as far as their force allows.

namespace weft {

/// Where an object is sent in a tick.
struct MotionGoal {
  Pose pose;
  double speed = 0;       ///< limit of its pivot [m/s]
  double turn_speed = 0;  ///< limit [rad/s]
  double press = 0;       ///< force with which it presses a layer in its way on another object [N]
  double slope = 0;       ///< it presses where its way leads more steeply into that layer [1]
};

/// Numbers of the colliders that an object consists of: its own, or those of both jaws of a
/// gripper. The second may be kNone.
using ColliderPair = std::array<Index, 2>;

/// Plans the coming tick: from the present poses towards those of keyframes or commands, within the
/// speed limits. Jaws are planned with their grippers.
/// @param time     at the start of the tick [s]
/// @param seconds  length of the tick
void plan_motion(const std::vector<ColliderDef>& colliders, double time, double seconds,
                 ColliderStates& states);

/// Plans the coming tick of one object.
/// @param goal     none: it stays
/// @param own      its colliders
/// @param seconds  length of the tick, and of the last one, whose impulses the object still has
/// @param states   of all colliders, for those that press against it
void plan_object(const std::optional<MotionGoal>& goal, const ColliderPair& own, double seconds,
                 const ColliderStates& states, ColliderState& object);

/// The same for one that goes to a pose whatever resists it, but for the limits of all objects.
void plan_carried(const Pose& goal, double seconds, ColliderState& object);

/// Ends the tick: slows colliders whose resistance exceeds their force, and lets those that stand
/// yield to it.
void finish_motion(const std::vector<ColliderDef>& colliders, double seconds,
                   ColliderStates& states);

/// Paces of an object in the next tick, by its impulses of the last one.
/// @param max_force  [N]
Pace next_paces(const ColliderState& object, double max_force, double seconds);

/// Speed at which an object yields to what resists with more than its force [m/s].
/// @param resistance  over its force, more than 1 [1]
double yield_speed(double resistance);

}  // namespace weft
