// Validates and interpolates keyframes.

#include "core/contact/colliders/collider_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/colliders/constants.h"
#include "core/definition.h"
#include "core/error.h"

namespace weft {
namespace {

/// The steepest slope of the easing cubic.
constexpr double kSteepestEase = 1.5;

struct Difference {
  Vec3d step, turn;
};

/// From one keyframe to another by the shortest rotation.
Difference between(const Keyframe& from, const Keyframe& to) {
  return {to.offset - from.offset,
          rotation_vector(to.rotation.normalized() * from.rotation.normalized().conjugate())};
}

double fastest(const MotionDef& def) {
  return def.interpolation == Interpolation::smooth ? kSteepestEase : 1;
}

/// Refuses a jump from keyframe k - 1 to keyframe k.
void check_stretch(const MotionDef& def, std::size_t k, const std::string& path) {
  const Keyframe &from = def.keyframes[k - 1], &to = def.keyframes[k];
  const double seconds = to.time - from.time;
  if (!(seconds > 0))
    throw DefinitionError(path + "time", number_text(to.time),
                          "later than " + number_text(from.time) + " s",
                          "keyframes stand in the order of their times");
  const Difference difference = between(from, to);
  const auto check_speed = [&](const char* field, double speed, double most, const char* unit) {
    if (!(speed <= most))
      throw DefinitionError(path + field, "reached at " + number_text(speed) + " " + unit,
                            "at most " + number_text(most) + " " + unit,
                            "a collider moves and never jumps: give it more time");
  };
  check_speed("offset", difference.step.norm() / seconds * fastest(def), kMostColliderSpeed, "m/s");
  check_speed("rotation", difference.turn.norm() / seconds * fastest(def), kMostColliderTurnSpeed,
              "rad/s");
}

}  // namespace

void validate(const MotionDef& def, const std::string& path) {
  const std::size_t count = def.keyframes.size();
  check_field(path, {"keyframes", 0, kMostKeyframes, "", "number of keyframes"},
              static_cast<double>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const std::string at = path + "keyframes[" + std::to_string(k) + "].";
    visit_fields_of_keyframe(def.keyframes[k], [&at](const FieldInfo& info, const auto& value) {
      check_field(at, info, value);
    });
    check_unit(at + "rotation", def.keyframes[k].rotation);
    if (k > 0) check_stretch(def, k, at);
  }
  if (!def.loop) return;
  if (count < 2)
    throw DefinitionError(path + "loop", "true", "false with fewer than two keyframes",
                          "a loop needs a way to go");
  const Difference gap = between(def.keyframes.back(), def.keyframes.front());
  if (gap.step.norm() > kSamePose || gap.turn.norm() > kSamePose)
    throw DefinitionError(path + "loop", "true", "false unless the last pose is the first one",
                          "a collider moves and never jumps: end where it began");
}

void validate(const MoveDef& def, const std::string& path) {
  check_field(path, {"position", kPivotRange, "m", "target of the pivot"}, def.target.position);
  check_unit(path + "rotation", def.target.rotation);
  check_field(path, {"speed", kMoveSpeedRange, "m/s", "of the pivot"}, def.speed);
  check_field(path, {"turn_speed", kTurnSpeedRange, "rad/s", "of the turn"}, def.turn_speed);
}

Pose offset_at(const MotionDef& def, double time) {
  assert(!def.keyframes.empty());
  assert(time >= 0);
  const Keyframe &first = def.keyframes.front(), &last = def.keyframes.back();
  const auto pose_of = [](const Keyframe& k) { return Pose{k.offset, k.rotation.normalized()}; };
  if (def.loop && time > first.time) {
    const double period = last.time - first.time;
    assert(period > 0);
    const double since = time - first.time;
    time = first.time + (since - period * std::floor(since / period));
  }
  if (time <= first.time) return pose_of(first);
  if (time >= last.time) return pose_of(last);
  const auto next =
      std::upper_bound(def.keyframes.begin(), def.keyframes.end(), time,
                       [](double t, const Keyframe& frame) { return t < frame.time; });
  const Keyframe &from = *(next - 1), &to = *next;
  double fraction = (time - from.time) / (to.time - from.time);
  if (def.interpolation == Interpolation::smooth)
    fraction = fraction * fraction * (3 - 2 * fraction);
  const Difference difference = between(from, to);
  return moved(pose_of(from), {difference.step, difference.turn}, fraction);
}

TopSpeeds top_speeds(const MotionDef& def) {
  TopSpeeds top;
  for (std::size_t k = 1; k < def.keyframes.size(); ++k) {
    const Keyframe &from = def.keyframes[k - 1], &to = def.keyframes[k];
    assert(to.time > from.time);
    const double rate = fastest(def) / (to.time - from.time);
    const Difference difference = between(from, to);
    top.linear = std::max(top.linear, difference.step.norm() * rate);
    top.angular = std::max(top.angular, difference.turn.norm() * rate);
  }
  return top;
}

}  // namespace weft
