#include "proto/parse_move.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

namespace weft::proto {
namespace {

void read_rotation(FieldReader& in, std::optional<Quat>& rotation) {
  in.read_if_there("rotation", rotation, kUnitRange);
  if (!in.ok() || !rotation) return;
  double norm2 = 0;
  for (const double q : *rotation) norm2 += q * q;
  if (!(std::abs(std::sqrt(norm2) - 1) <= kUnitTolerance))
    in.fail(ErrorCode::out_of_range, "rotation", "rotation must have the norm 1",
            "a unit quaternion [x, y, z, w]");
}

/// Fields that mean nothing beside another are refused, not ignored, because their sender expects
/// an effect.
void refuse_beside(FieldReader& in, const char* other, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (in.ok() && in.has(key))
      in.fail(ErrorCode::conflicting_fields, key,
              std::string(key) + " cannot be combined with " + other);
  }
}

Command read_move_pin(FieldReader& in) {
  MovePin move;
  in.read("pin", move.pin, kIdRange);
  refuse_beside(in, "pin", {"collider", "rotation", "turn_speed", "force", "release"});
  bool stop = false;
  in.read_if_there("stop", stop);
  if (stop) {
    refuse_beside(in, "stop", {"position", "speed", "seconds", "max_force"});
    return StopPin{move.pin};
  }
  in.read("position", move.position, kPositionRange);
  if (in.has("seconds")) refuse_beside(in, "seconds", {"speed"});
  in.read_if_there("speed", move.speed, kMoveSpeedRange);
  in.read_if_there("seconds", move.seconds, kMoveSecondsRange);
  in.read_if_there("max_force", move.max_force, kForceRange);
  return move;
}

}  // namespace

Command read_move(FieldReader& in) {
  if (in.has("pin")) return read_move_pin(in);
  Move move;
  in.read("collider", move.collider);
  refuse_beside(in, "collider", {"seconds", "max_force", "stop"});
  bool release = false;
  in.read_if_there("release", release);
  if (release) {
    refuse_beside(in, "release", {"position", "rotation", "speed", "turn_speed", "force"});
    return MoveEnd{move.collider};
  }
  in.read_if_there("position", move.position, kPivotRange);
  read_rotation(in, move.rotation);
  in.read_if_there("speed", move.speed, kMoveSpeedRange);
  in.read_if_there("turn_speed", move.turn_speed, kTurnSpeedRange);
  in.read_if_there("force", move.force);
  if (in.ok() && !move.position && !move.rotation)
    in.fail(ErrorCode::missing_field, "position", "move needs position, rotation or release");
  return move;
}

Command read_gripper(FieldReader& in) {
  Gripper gripper;
  in.read("name", gripper.gripper);
  if (in.ok() && (gripper.gripper.empty() || gripper.gripper.size() > kMostGripperBytes))
    in.fail(ErrorCode::wrong_length, "name", "name must have 1 to 56 bytes");
  in.read_if_there("opening", gripper.opening, kOpeningRange);
  in.read_if_there("force", gripper.force, kGripRange);
  in.read_if_there("position", gripper.position, kPivotRange);
  read_rotation(in, gripper.rotation);
  in.read_if_there("speed", gripper.speed, kMoveSpeedRange);
  in.read_if_there("turn_speed", gripper.turn_speed, kTurnSpeedRange);
  Gripper nothing;
  nothing.gripper = gripper.gripper;
  if (in.ok() && gripper == nothing) {
    Error error = make_error(ErrorCode::missing_field, "gripper has nothing to do");
    error.limit =
        Limit{{}, {}, {}, {"opening", "force", "position", "rotation", "speed", "turn_speed"}};
    in.fail(std::move(error));
  }
  return gripper;
}

}  // namespace weft::proto
