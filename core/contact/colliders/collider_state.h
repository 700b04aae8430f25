#pragma once

#include <optional>
#include <vector>

#include "core/contact/colliders/collider.h"
#include "core/contact/colliders/collider_motion.h"

namespace weft {

/// A collider as it stands and moves now. Its motion is planned for a tick, with a constant twist,
/// and made a substep at a time by the contact, which may hold it back.
struct ColliderState {
  Pose pose;
  std::optional<MoveDef> move;  ///< the command that it follows, instead of its keyframes
  double pace = 1;              ///< part of its speed that the resistance of the cloth leaves, 0..1

  // The tick under way.
  Pose start, goal;      ///< at its beginning; at its end, if nothing holds the collider back
  Twist wanted;          ///< towards what keyframes or command ask for, at full pace
  Twist twist;           ///< from start to goal
  double progress = 0;   ///< of the twist [s]
  bool blocked = false;  ///< held back, because cloth could not give way
  bool forced = false;   ///< is not held back in this tick
  bool voided = false;   ///< has gone on through cloth since the start: nothing is promised
  Vec3d impulse = Vec3d::Zero();          ///< given to the cloth so far [N s]
  Vec3d angular_impulse = Vec3d::Zero();  ///< about the pivot [N m s]

  // Of a jaw of a gripper.
  Vec3d press = Vec3d::Zero();     ///< unit direction in which it presses; zero: it is none
  double squeeze = 0;              ///< with which it presses what is before it in this tick [N]
  Vec3d squeezed = Vec3d::Zero();  ///< impulse of that on the cloth so far in the tick [N s]
  double facing = 0;  ///< thickness of the cloth that is before it; 0: there is none [m]

  // Its force, in a substep: beyond it, it stands.
  double radius = 0;              ///< of the surface about the pivot [m]
  double max_force = 0;           ///< [N]
  Index mate = kNone;             ///< stands when this one does: the other jaw
  Vec3d counted = Vec3d::Zero();  ///< of `impulse`, so much has been held against the force
  Vec3d angular_counted = Vec3d::Zero();
  double overload = 0;        ///< impulse above what the force gives, not yet made good [N s]
  double start_overload = 0;  ///< the same at the beginning of the tick

  Vec3d force = Vec3d::Zero();  ///< of the cloth on it, mean of the last tick [N]

  bool is_moving() const { return !twist.is_zero(); }
  /// It moves, or would like to.
  bool is_active() const { return !wanted.is_zero() || squeeze > 0; }
};

using ColliderStates = std::vector<ColliderState>;

/// The point of a collider that its pose places and about which it turns: the centre of a sphere or
/// box, the middle of a capsule, the point of a plane, the centre of the box around a mesh [m].
Vec3d pivot_of(const ShapeDef& shape);

/// Farthest that a point of the surface is from the pivot [m]; infinite for a plane.
double radius_of(const ShapeDef& shape);

/// Where the keyframes want a collider that has some [s].
Pose keyframed_pose(const ColliderDef& def, double time);

/// The pose as defined.
Pose rest_pose(const ShapeDef& shape);

/// All colliders where their definitions put them, or at time 0 of their keyframes.
ColliderStates initial_states(const std::vector<ColliderDef>& colliders);

/// Plans the coming tick: from where they are to where keyframes or commands want them at its end,
/// no faster than they may.
/// @param time     at the start of the tick [s]
/// @param seconds  length of the tick
void plan_motion(const std::vector<ColliderDef>& colliders, double time, double seconds,
                 ColliderStates& states);

/// Back to the start of the tick under way.
void take_back_motion(ColliderStates& states);

/// Holds what has resisted a collider since the last time against its force.
/// @param seconds  since then
/// @return whether it is to stand: it has been resisted by more than its force, and for longer than
///         an impact lasts
bool count_resistance(double seconds, ColliderState& state);

/// Moves a collider on by part of the tick [s]; it ends exactly at its goal.
void advance_collider(double seconds, double tick_seconds, ColliderState& state);

/// Ends the tick: slows what is resisted by more than its force allows.
void finish_motion(const std::vector<ColliderDef>& colliders, double seconds,
                   ColliderStates& states);

}  // namespace weft
