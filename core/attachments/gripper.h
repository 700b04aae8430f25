#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/contact/colliders/collider_state.h"
#include "core/definition.h"

// Grippers: pairs of jaws that close on cloth with bounded force.

namespace weft {

/// Commanded state of a gripper from an instant on.
struct GripperStep {
  double time = 0;               ///< [s], 0 to 3600, increasing from step to step
  Vec3d offset = Vec3d::Zero();  ///< of its middle from its defined position [m], within 1000
  double opening = 0;            ///< between its jaws [m], 0 to 1; 0 closes on the cloth between
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< relative to its definition
};

inline constexpr std::size_t kMostGrippers = 8, kMostGripperSteps = 100;

/// Two boxes that close along the gripper's x axis with bounded force.
struct GripperDef {
  std::string name = "gripper";   ///< its jaws are the colliders NAME.left and NAME.right
  Vec3d centre = Vec3d(0, 1, 0);  ///< of the space between the jaws [m], within 1000
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3d half_extents = Vec3d(0.005, 0.02, 0.02);  ///< of each jaw [m], each 0.001 to 1
  double opening = 0.04;                ///< between the jaws' faces at the start [m], 0 to 1
  double force = 5;                     ///< with which each jaw presses [N], 0 to 1000
  double max_force = 100;               ///< resistance beyond which it lags [N], 0.01 to 1e6
  double speed = 0.25;                  ///< limit of its middle [m/s], 0.001 to 20
  double turn_speed = 2;                ///< limit about its middle [rad/s], 0.001 to 60
  double closing_speed = 0.05;          ///< of each jaw [m/s], 0.001 to 1
  double friction_factor = 1;           ///< of the jaws, see ColliderDef; 0 to 10
  std::vector<GripperStep> steps = {};  ///< its schedule; at most kMostGripperSteps
};

/// A command, effective from the coming tick; omitted values stay as they are. The gripper no
/// longer follows its steps.
struct GripperCommand {
  std::optional<double> opening;               ///< [m], 0 to 1
  std::optional<double> force;                 ///< [N], 0 to 1000
  std::optional<Vec3d> position;               ///< of its middle [m], within 1000
  std::optional<Eigen::Quaterniond> rotation;  ///< relative to its definition; unit
  std::optional<double> speed;                 ///< limit of its middle [m/s], 0.001 to 20
  std::optional<double> turn_speed;            ///< limit [rad/s], 0.001 to 60
};

/// Present state of a gripper.
struct Gripper {
  GripperDef def;
  std::array<std::size_t, 2> jaw = {0, 0};  ///< its colliders: at -x and at +x
  Pose pose;                                ///< of its middle; rotation relative to its definition
  Pose target;
  double speed = 0.25, turn_speed = 2;
  double opening = 0, wanted = 0;  ///< [m]
  double force = 0;                ///< with which each jaw presses, at most [N]
  double facing = 0;               ///< thickness of the cloth in front of both jaws; 0: none [m]
  double closing = 0;      ///< speed with which what has yielded closes again, in kJawYield [1]
  bool stays = false;      ///< its middle does, so that the jaws can close
  bool commanded = false;  ///< follows commands instead of its steps
  bool gripping = false;   ///< the jaws are stopped by the cloth between them, and press it

  /// Its middle as an object, which stands, presses and yields as any other: what its jaws meet is
  /// what it meets.
  ColliderState middle;
};

/// The colliders of a gripper in its initial state.
std::array<ColliderDef, 2> jaws_of(const GripperDef& def);

/// The grippers in their initial state.
/// @param first_jaw  index of the first one's jaws among the colliders
std::vector<Gripper> initial_grippers(const std::vector<GripperDef>& defs, std::size_t first_jaw);

/// Throws DefinitionError if a field is out of range; `path` precedes the field's name.
void validate(const GripperDef& def, const std::string& path);
void validate(const GripperCommand& command, const std::string& path);

void command_gripper(const GripperCommand& command, Gripper& gripper);

/// Call before `plan_motion` of a tick: plans the motion of the jaws, and their pressing forces.
/// @param time      at the start of the tick [s]
/// @param seconds   length of the tick
/// @param thickest  thickness of the thickest cloth [m]
void plan_grippers(double time, double seconds, double thickest, std::vector<Gripper>& grippers,
                   ColliderStates& colliders);

/// Call after `finish_motion`: reads the jaws' poses, and whether they were stopped.
void finish_grippers(double seconds, const ColliderStates& colliders,
                     std::vector<Gripper>& grippers);

/// Direction in which a jaw presses: jaw 0 to +x, jaw 1 to -x of the gripper; unit.
Vec3d press_of(const Gripper& gripper, std::size_t jaw);

/// Passes each field of a gripper except name, orientation and steps to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_gripper(Def& gripper, Visitor&& visit) {
  visit(FieldInfo{"center", kPivotRange, "m", "middle between the jaws"}, gripper.centre);
  visit(FieldInfo{"half_extents", 1e-3, 1, "m", "half of each side of a jaw; it closes along x"},
        gripper.half_extents);
  visit(FieldInfo{"opening", kOpeningRange, "m", "between the jaws' faces at the start"},
        gripper.opening);
  visit(FieldInfo{"force", kGripRange, "N", "force of each jaw"}, gripper.force);
  visit(FieldInfo{"max_force", 0.01, 1e6, "N", "resistance beyond which it lags"},
        gripper.max_force);
  visit(FieldInfo{"speed", kMoveSpeedRange, "m/s", "speed limit of its middle"}, gripper.speed);
  visit(FieldInfo{"turn_speed", kTurnSpeedRange, "rad/s", "limit of its rotation"},
        gripper.turn_speed);
  visit(FieldInfo{"closing_speed", 1e-3, 1, "m/s", "closing speed of each jaw"},
        gripper.closing_speed);
  visit(FieldInfo{"friction_factor", kFrictionFactorRange, "", "of the jaws, times the cloth's"},
        gripper.friction_factor);
}

/// The same for a step, except its rotation.
template <class Def, class Visitor>
void visit_fields_of_gripper_step(Def& step, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "start time"}, step.time);
  visit(FieldInfo{"offset", -1000, 1000, "m", "offset from its defined position"}, step.offset);
  visit(FieldInfo{"opening", kOpeningRange, "m", "between the jaws; 0 closes on what is there"},
        step.opening);
}

}  // namespace weft
