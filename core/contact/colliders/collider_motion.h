#pragma once

#include <string>
#include <vector>

#include "core/contact/colliders/pose.h"
#include "core/definition.h"

// Keyframes and commands that move colliders.

namespace weft {

/// Pose of a collider at an instant, relative to its definition: moved by an offset and rotated
/// about its pivot.
struct Keyframe {
  double time = 0;               ///< [s], 0 to 3600, increasing from keyframe to keyframe
  Vec3d offset = Vec3d::Zero();  ///< of the pivot [m], within 1000
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
};

/// Interpolation of poses between two keyframes.
enum class Interpolation {
  linear,  ///< constant velocity, and shortest rotation at constant rate (slerp)
  smooth,  ///< the same path, at rest at each keyframe; time eased by the cubic 3 s^2 - 2 s^3
};

/// Keyframes of a collider. It stays at the first before its time and, unless it loops, at the
/// last.
struct MotionDef {
  std::vector<Keyframe> keyframes;  ///< none: no motion of its own; at most kMostKeyframes
  Interpolation interpolation = Interpolation::linear;
  bool loop = false;  ///< from the last keyframe back to the first, which must be the same pose
};

inline constexpr std::size_t kMostKeyframes = 1000;

/// Limits of a commanded speed [m/s] and rotation [rad/s].
inline constexpr double kMostColliderSpeed = kMoveSpeedRange.maximum;
inline constexpr double kMostColliderTurnSpeed = kTurnSpeedRange.maximum;

/// A command: move to a pose at no more than these speeds, and stay there.
struct MoveDef {
  Pose target;            ///< position within 1000 m, rotation unit
  double speed = 0.5;     ///< of the pivot [m/s], 0.001 to kMostColliderSpeed
  double turn_speed = 2;  ///< [rad/s], 0.001 to kMostColliderTurnSpeed
  bool force = false;     ///< move on even if cloth cannot yield; its guarantee is then void
};

/// Throws DefinitionError, with `path` in front of the field's name, if a keyframe is out of range,
/// not later than the previous one, or so far from it that it would be a jump.
void validate(const MotionDef& def, const std::string& path);

/// Throws DefinitionError if a field is out of range.
void validate(const MoveDef& def, const std::string& path);

/// Offset and rotation of the keyframes, of which there must be at least one.
/// @param time  [s], at least 0
Pose offset_at(const MotionDef& def, double time);

/// Passes each field of a keyframe except the rotation to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_keyframe(Def& keyframe, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it is reached"}, keyframe.time);
  visit(FieldInfo{"offset", -1000, 1000, "m", "offset from its defined position"}, keyframe.offset);
}

/// The same for the motion, except the keyframes.
template <class Def, class Visitor>
void visit_fields_of_motion(Def& motion, Visitor&& visit) {
  visit(choice("interpolation", "linear|smooth", "smooth: at rest at each keyframe"),
        motion.interpolation);
  visit(FieldInfo{"loop", 0, 1, "", "from the last keyframe on to the first, the same pose"},
        motion.loop);
}

/// Fastest motion between two keyframes [m/s], [rad/s].
struct TopSpeeds {
  double linear = 0, angular = 0;
};
TopSpeeds top_speeds(const MotionDef& def);

}  // namespace weft
