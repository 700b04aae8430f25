#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/types.h"

// Commands that send colliders, pins and grippers somewhere.

namespace weft::proto {

inline constexpr Field kMovedCollider{"collider", "its name, or its place in the list of `mesh`"};
inline constexpr Field kMovedPin{"pin", "id of any pin, the scene's too", kIdRange};
inline constexpr Field kPivotTarget{"position", "target of its pivot; without it, as it is now",
                                    kPivotRange, "m"};
inline constexpr Field kTurn{"rotation", "relative to its definition; without it, as it is now",
                             kUnitRange, "", Form::rotation};

/// Sends a collider to a pose; omitted values stay as they are.
struct Move {
  ColliderRef collider;
  std::optional<Vec3> position;
  std::optional<Quat> rotation;
  double speed = 0.5;
  double turn_speed = 2;
  bool force = false;
  bool operator==(const Move&) const = default;

  static constexpr const char* kOp = "move";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& move) {
    io.required(kMovedCollider, move.collider);
    io.excludes("collider", {"seconds", "max_force", "stop"});
    io.constant("release", false);
    io.optional(kPivotTarget, move.position);
    io.optional(kTurn, move.rotation);
    io.optional(Field{"speed", "at most", kMoveSpeedRange, "m/s"}, move.speed);
    io.optional(Field{"turn_speed", "at most", kTurnSpeedRange, "rad/s"}, move.turn_speed);
    io.flag(Field{"force", "go on through cloth that cannot give way"}, move.force, false);
    io.rule(move.position || move.rotation, ErrorCode::missing_field, "position",
            "move needs position, rotation or release");
  }
};

/// Returns a collider to its keyframes; one without keyframes stays where it is.
struct MoveEnd {
  ColliderRef collider;
  bool operator==(const MoveEnd&) const = default;

  static constexpr const char* kOp = "move";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& end) {
    io.required(kMovedCollider, end.collider);
    io.excludes("collider", {"seconds", "max_force", "stop"});
    io.constant("release", true);
    io.excludes("release", {"position", "rotation", "speed", "turn_speed", "force"});
  }
};

/// Sends a pin to a place, no faster than `speed` or, if given, within `seconds`.
struct MovePin {
  std::uint32_t pin = 0;
  Vec3 position{};
  double speed = 2;
  std::optional<double> seconds;
  double max_force = 50;
  bool operator==(const MovePin&) const = default;

  static constexpr const char* kOp = "move";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& move) {
    io.required(kMovedPin, move.pin);
    io.excludes("pin", {"collider", "rotation", "turn_speed", "force", "release"});
    io.constant("stop", false);
    io.required(Field{"position", "target of its `particle`", kPositionRange, "m"}, move.position);
    io.excludes("seconds", {"speed"});
    io.optional(Field{"seconds", "duration, in place of a speed", kMoveSecondsRange, "s"},
                move.seconds);
    io.optional(Field{"speed", "at most", kMoveSpeedRange, "m/s"}, move.speed);
    io.optional(Field{"max_force", "on the cloth during the motion", kForceRange, "N"},
                move.max_force);
  }
};

/// Stops a moving pin and fixes it where it is.
struct StopPin {
  std::uint32_t pin = 0;
  bool operator==(const StopPin&) const = default;

  static constexpr const char* kOp = "move";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& stop) {
    io.required(kMovedPin, stop.pin);
    io.excludes("pin", {"collider", "rotation", "turn_speed", "force", "release"});
    io.constant("stop", true);
    io.excludes("stop", {"position", "speed", "seconds", "max_force"});
  }
};

/// Commands a gripper; omitted values stay as they are.
struct Gripper {
  std::string gripper;
  std::optional<double> opening, force;
  std::optional<Vec3> position;
  std::optional<Quat> rotation;
  std::optional<double> speed, turn_speed;
  bool operator==(const Gripper&) const = default;

  static constexpr const char* kOp = "gripper";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& gripper) {
    io.required(Field{"name", "of the gripper", {1, kMostGripperBytes}, "bytes", Form::bytes},
                gripper.gripper);
    io.optional(Field{"opening", "between its jaws; 0 closes on what is there", kOpeningRange, "m"},
                gripper.opening);
    io.optional(Field{"force", "with which each jaw presses", kGripRange, "N"}, gripper.force);
    io.optional(Field{"position", "target of its middle", kPivotRange, "m"}, gripper.position);
    io.optional(kTurn, gripper.rotation);
    io.optional(Field{"speed", "of its middle, at most", kMoveSpeedRange, "m/s"}, gripper.speed);
    io.optional(Field{"turn_speed", "at most", kTurnSpeedRange, "rad/s"}, gripper.turn_speed);
    io.one_at_least("gripper has nothing to do");
  }
};

}  // namespace weft::proto
