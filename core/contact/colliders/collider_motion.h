#pragma once

#include <string>
#include <vector>

#include "core/contact/colliders/pose.h"
#include "core/definition.h"

namespace weft {

/// Where a collider shall be at an instant, told from how it is defined: moved by an offset and
/// turned about its pivot.
struct Keyframe {
  double time = 0;               ///< [s], 0 to 3600, growing from one to the next
  Vec3d offset = Vec3d::Zero();  ///< of the pivot [m], within 1000
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
};

/// How poses between two keyframes are found.
enum class Interpolation {
  linear,  ///< at constant velocity, and by the shortest turn at constant rate (slerp)
  smooth,  ///< the same path; at rest at each keyframe, time eased by the cubic 3 s^2 - 2 s^3
};

/// Keyframes of a collider. Before the first and, unless it loops, after the last it stays there.
struct MotionDef {
  std::vector<Keyframe> keyframes;  ///< none: it does not move by itself; at most kMostKeyframes
  Interpolation interpolation = Interpolation::linear;
  bool loop = false;  ///< from the last keyframe on to the first one, which must be the same pose
};

inline constexpr std::size_t kMostKeyframes = 1000;

/// Fastest that a collider may be asked to move [m/s] and turn [rad/s].
inline constexpr double kMostColliderSpeed = 20, kMostColliderTurnSpeed = 60;

/// A command: go to a pose at no more than these speeds, and stay there.
struct MoveDef {
  Pose target;            ///< position within 1000 m, rotation unit
  double speed = 0.5;     ///< of the pivot [m/s], 0.001 to kMostColliderSpeed
  double turn_speed = 2;  ///< [rad/s], 0.001 to kMostColliderTurnSpeed
  bool force = false;     ///< go on where cloth cannot give way; what it promised is void then
};

/// Throws DefinitionError, with `path` before the field's name, if a keyframe is out of range, not
/// later than the one before it, or so far from it that it would be a jump.
void validate(const MotionDef& def, const std::string& path);

/// Throws DefinitionError if a field is out of range.
void validate(const MoveDef& def, const std::string& path);

/// The offset and rotation that the keyframes, of which there is at least one, ask for.
/// @param time  [s], at least 0
Pose offset_at(const MotionDef& def, double time);

/// Describes each field of a keyframe to `visit(info, value)`, but for the rotation.
template <class Def, class Visitor>
void visit_fields_of_keyframe(Def& keyframe, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it is reached"}, keyframe.time);
  visit(FieldInfo{"offset", -1000, 1000, "m", "offset from its defined position"}, keyframe.offset);
}

/// The same for the motion, but for the keyframes.
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
