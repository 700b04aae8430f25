#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/contact/colliders/collider.h"
#include "core/contact/colliders/collider_motion.h"

// State of moving colliders.

namespace weft {

/// Single layers of cloth between a collider and other ones.
struct Pinch {
  Vec3d direction = Vec3d::Zero();  ///< unit, towards the other collider; zero: there is none
  double lack = 0;                  ///< most that the layer lacks of its thickness [m]
  Index other = kNone;              ///< the other collider
  bool braces = false;              ///< another one pinches cloth against it
  /// What the layer's rows push with in a tick in which the collider presses it, on its own side
  /// and on the other one; not what it is pressed with besides [N s].
  std::array<double, 2> pushes = {0, 0};
};

/// How a jaw of a gripper presses cloth on the other jaw in a tick, or an object or a jaw a single
/// layer on another object.
struct Press {
  Vec3d direction = Vec3d::Zero();  ///< unit; zero: it does not press
  /// Force with which it presses in all; of one side of a layer the normal force there [N].
  double hold = 0;
  double squeeze = 0;   ///< its part that the cloth does not resist yet [N]
  Index other = kNone;  ///< the object that it presses on; kNone: the other jaw
  int parts = 1;        ///< jaws of a gripper that press so, each with these forces
  /// What the rows of a pressed layer push with besides the squeeze, on the presser's side and on
  /// the other one, mean of the last tick [N].
  std::array<double, 2> pushes = {0, 0};
  double room = 0;  ///< of a jaw that presses on the other one: half the gap between them [m]

  bool acts() const { return !direction.isZero(0); }
};

/// Fractions of a collider's speed that the resistance of the cloth leaves, -1..1; less than 0: it
/// yields. Layers that bear it resist with many times what sliding over them takes, so motion into
/// what resists and motion along it are slowed apart.
struct Pace {
  Vec3d against = Vec3d::Zero();  ///< unit, into what resists; zero: nothing does
  double into = 1;                ///< that way
  double along = 1;               ///< across it, and of its rotation
  double yielded = 0;             ///< that way, and not regained yet [m]

  bool is_full() const { return into == 1 && along == 1; }
  bool yields() const { return into < 0 || along < 0; }
};

/// What a collider has given to the cloth.
struct Given {
  Vec3d impulse = Vec3d::Zero();  ///< [N s]
  Vec3d angular = Vec3d::Zero();  ///< about its pivot [N m s]
};

/// Present state of a collider. Its motion is planned for a tick, with a constant twist, and
/// executed per substep by contact, which may hold it back.
struct ColliderState {
  Pose pose;
  std::optional<MoveDef> move;  ///< the command that overrides its keyframes
  Pace pace;

  // The running tick.
  Pose start, goal;      ///< at its start; at its end, unless the collider is held back
  Twist wanted;          ///< towards the pose of keyframes or command, at full pace
  Twist twist;           ///< from start to goal
  double progress = 0;   ///< along the twist [s]
  bool blocked = false;  ///< held back, because cloth could not yield
  bool forced = false;   ///< not held back in this tick
  bool voided = false;   ///< has moved on through cloth since the start: nothing is promised
  Vec3d impulse = Vec3d::Zero();          ///< given to the cloth's velocities so far [N s]
  Vec3d pushed = Vec3d::Zero();           ///< its part along the normals of contacts [N s]
  Vec3d angular_impulse = Vec3d::Zero();  ///< about the pivot [N m s]
  Given told;  ///< the same with what drag takes of forces: see Collision::before_drift

  // What it pinches, of the last substep.
  Pinch pinch;
  bool bracing = false;  ///< another object did in the last tick

  Press press;
  Vec3d besides = Vec3d::Zero();  ///< what counts in its force alone, so far in the tick [N s]
  bool layered = false;           ///< a jaw grips several layers, which resist it
  bool stands = false;            ///< on a layer that a jaw pinches, with its gripper
  double facing = 0;              ///< thickness of the cloth in front of a jaw; 0: none [m]

  // Its force limit within a substep: beyond it, the collider stands.
  double radius = 0;              ///< of the surface about the pivot [m]
  double max_force = 0;           ///< [N]
  Index mate = kNone;             ///< stands together with this one: the other jaw
  Vec3d counted = Vec3d::Zero();  ///< part of `impulse` already compared with the limit
  Vec3d angular_counted = Vec3d::Zero();
  double overload = 0;        ///< impulse beyond the limit, not yet compensated [N s]
  double start_overload = 0;  ///< the same at the start of the tick

  Vec3d force = Vec3d::Zero();  ///< of the cloth on it, mean of the last tick [N]

  bool is_moving() const { return !twist.is_zero(); }
  bool pinches() const { return pinch.other != kNone; }
  bool is_jaw() const { return mate != kNone; }
  /// Whether it is a jaw that presses cloth on the other one.
  bool grips() const { return is_jaw() && press.other == kNone && press.hold > 0; }
  /// Whether it moves, or is meant to.
  bool is_active() const { return !wanted.is_zero() || press.hold > 0; }
};

using ColliderStates = std::vector<ColliderState>;

/// Reference point of a collider's pose and rotation: the centre of a sphere or box, the middle of
/// a capsule, the point of a plane, the centre of the box around a mesh [m].
Vec3d pivot_of(const ShapeDef& shape);

/// Largest distance of a surface point from the pivot [m]; infinite for a plane.
double radius_of(const ShapeDef& shape);

/// Pose by the keyframes, for a collider that has some.
Pose keyframed_pose(const ColliderDef& def, double time);

/// The pose as defined.
Pose rest_pose(const ShapeDef& shape);

/// All colliders as defined, or at time 0 of their keyframes.
ColliderStates initial_states(const std::vector<ColliderDef>& colliders);

/// Forgets what the cloth has been given in the tick.
void clear_impulses(ColliderState& state);

/// Mean forces of the rows of what is pinched, on both sides, not negative [N].
std::array<double, 2> mean_pushes(const Pinch& pinch, double seconds);

/// Returns to the start of the running tick.
void take_back_motion(ColliderStates& states);

/// Compares the resistance since the last call with the collider's force.
/// @param seconds  since then
/// @return whether it must stand: the resistance exceeds its force, for longer than an impact
///         lasts, and it does not yield to that already
bool count_resistance(double seconds, ColliderState& state);

/// The same for both jaws of a gripper, whose force is that of one: what resists their motion
/// together exceeds it, or what resists each of them as they close or open. The overload of the
/// first is that of the former, the second one's that of the latter.
bool count_resistance(double seconds, ColliderState& jaw, ColliderState& mate);

/// Moves a collider by part of the tick [s]; it ends exactly at its goal.
void advance_collider(double seconds, double tick_seconds, ColliderState& state);

}  // namespace weft
