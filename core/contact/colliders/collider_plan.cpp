// Plans the motion of objects within their force limits.

#include "core/contact/colliders/collider_plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "core/contact/colliders/constants.h"

namespace weft {
namespace {

/// Allowed fraction of a displacement.
double allowed_fraction(double displacement, double most) {
  assert(!(displacement < 0) && most >= 0);
  return displacement > most ? most / displacement : 1;
}

/// Where a collider is sent, for the end of the tick.
std::optional<MotionGoal> goal_of(const ColliderDef& def, double time, const ColliderState& state) {
  const auto to = [&state](const Pose& goal, double speed, double turn_speed) {
    return MotionGoal{goal, speed, turn_speed, state.max_force, 0};
  };
  if (state.move) return to(state.move->target, state.move->speed, state.move->turn_speed);
  if (def.motion.keyframes.empty()) return std::nullopt;
  // Where it only turns, or only shifts, it comes back to that at the speeds of a command.
  const TopSpeeds top = top_speeds(def.motion);
  const MoveDef usual;
  return to(keyframed_pose(def, time), top.linear > 0 ? top.linear * kColliderCatchUp : usual.speed,
            top.angular > 0 ? top.angular * kColliderCatchUp : usual.turn_speed);
}

/// The part of a displacement or velocity that goes into what resists.
Vec3d part_into(const Vec3d& motion, const Pace& pace) {
  return pace.against * std::max(0.0, motion.dot(pace.against));
}

/// Pace in the next tick. What layers resist with grows on while an object stands before them: it
/// yields until they resist with its force, and then goes back to them slowly. Jaws yield by their
/// opening.
/// @param pace        in the last tick
/// @param resistance  over its force [1]
/// @param speed       wanted [m/s]
/// @param yielded     how far it has yielded [m]
double next_pace(const ColliderState& state, double pace, double resistance, double speed,
                 double yielded, double seconds) {
  if (!(resistance > 1)) {
    const double regained = kPaceGain * seconds * (1 - std::max(0.0, resistance));
    const double most = std::min(1.0, std::max(pace, 0.0) + regained);
    if (!(yielded > 0)) return most;
    const double least = kTurningSpeed / speed;
    const double growth = std::pow(kPaceGrowth, seconds / kPaceSeconds);
    return std::min(most, pace > 0 ? std::max(pace, least) * growth : least);
  }
  const double slowed = pace / (1 + (resistance - 1) * std::min(seconds / kPaceSeconds, 1.0));
  if (slowed >= kLeastColliderPace && !state.blocked) return slowed;
  if (state.press.acts()) return 0;
  return -std::min(1.0, yield_speed(resistance) / speed);
}

bool contains(const ColliderPair& own, Index collider) {
  return collider != kNone && (collider == own[0] || collider == own[1]);
}

/// Of two objects that press a layer against each other the weaker one gives way slowly, and the
/// stronger one follows.
/// @param own   colliders of one of them
/// @param step  towards its goal, along the pinch [m]
/// @param most  that either moves [m]
/// @return how far it goes along its pinch [m]
double advance_against(const ColliderPair& own, double step, double most,
                       const ColliderStates& states, const ColliderState& object) {
  assert(object.pinches() && most >= 0);
  const ColliderState& other = states[at_index(object.pinch.other)];
  const bool opposed = object.press.other == object.pinch.other;
  if (!opposed || !contains(own, other.press.other)) return 0;
  if (object.max_force < other.max_force) return -most;
  return object.max_force > other.max_force ? std::clamp(step, 0.0, most) : 0;
}

/// What is left of the step towards its goal of an object that pinches a layer against another one
/// [m]: it goes no farther that way, but to where the layer has its thickness, and presses
/// with its force as long as its goal lies there. It moves on along the layer. Where layers beside
/// resist with its force it does not press besides.
Vec3d step_along_pinch(const MotionGoal& goal, const ColliderPair& own, double seconds,
                       const ColliderStates& states, ColliderState& object) {
  assert(seconds > 0 && goal.press >= 0);
  const Vec3d step = goal.pose.position - object.pose.position;
  const double most = kYieldSpeed * seconds;
  if (!object.pinches()) {
    // What has let go for a moment is met again slowly.
    const Vec3d& pressed = object.press.direction;
    const double ahead = object.forced ? 0 : std::max(step.dot(pressed) - most, 0.0);
    const Vec3d left = step - pressed * ahead;
    object.press = {};
    return left;
  }
  // By the rounding of rows it would be another direction in each tick, and slip to and fro.
  const Vec3d& before = object.press.direction;
  const bool same = before.dot(object.pinch.direction) > 1 - kSameDirection;
  const Vec3d pinch = same ? before : object.pinch.direction;
  const double into = step.dot(pinch);
  const double resistance = std::max(0.0, object.impulse.dot(pinch) / seconds);
  const bool stands = into > -kPressingDepth && !object.forced;
  const bool deep = into > kPressingDepth && into > goal.slope * step.norm();
  const bool presses = stands && deep && resistance < goal.press;
  const double advance = presses ? advance_against(own, into, most, states, object) : 0;
  object.press = {};
  if (presses) {
    object.press = {pinch, goal.press, goal.press - resistance, object.pinch.other};
    object.press.pushes = mean_pushes(object.pinch, seconds);
  }
  const double back = std::clamp(object.pinch.lack / 2, -most, most);
  return stands ? Vec3d(step - pinch * (into - advance + std::max(back, -into))) : step;
}

/// What its pace leaves of a motion. What yields fast does nothing else.
Twist slowed(const Twist& motion, double seconds, Pace& pace) {
  assert(seconds > 0);
  if (pace.is_full()) return motion;
  const double speed = motion.linear.norm(), yielding = std::max(0.0, -pace.into * speed);
  const double along = pace.along * std::max(0.0, 1 - yielding / kOnlyYields);
  const Vec3d into = part_into(motion.linear, pace);
  const Vec3d left = yielding > 0 ? Vec3d(pace.against * -yielding) : Vec3d(into * pace.into);
  pace.yielded = std::max(0.0, pace.yielded - left.dot(pace.against) * seconds);
  return {left + (motion.linear - into) * along, motion.angular * along};
}

/// Begins the tick of an object: where it is, and nothing of the last one.
void begin_tick(ColliderState& object) {
  object.start = object.goal = object.pose;
  object.start_overload = object.overload;
  object.wanted = object.twist = {};
  object.progress = 0;
  object.blocked = false;
  object.bracing = object.pinch.braces;
  object.pinch = {};
  clear_impulses(object);
}

/// Sends an object on its way within its speeds and at its pace.
/// @param left  of the step to its goal [m]
void head_for(const MotionGoal& goal, const Vec3d& left, double seconds, ColliderState& object) {
  const Vec3d step = goal.pose.position - object.pose.position;
  const Vec3d turn = rotation_vector(goal.pose.rotation * object.pose.rotation.conjugate());
  // Translation and rotation of a command take the same time, so that the path does not depend on
  // the tick.
  const auto fraction_of = [&](const Vec3d& part) {
    return std::min(allowed_fraction(part.norm(), goal.speed * seconds),
                    allowed_fraction(turn.norm(), goal.turn_speed * seconds));
  };
  const double all = fraction_of(step);
  object.wanted = {step * (all / seconds), turn * (all / seconds)};
  if (object.wanted.is_zero() || object.forced) object.pace = {};
  const Vec3d way = object.pace.yields() ? step : left;
  const double fraction = fraction_of(way);
  const bool arrives = fraction == 1 && object.pace.is_full();
  object.twist =
      slowed({way * (fraction / seconds), turn * (fraction / seconds)}, seconds, object.pace);
  object.goal = arrives ? goal.pose : moved(object.pose, object.twist, seconds);
  if (arrives && way != step) object.goal.position = object.pose.position + way;
}

}  // namespace

void plan_motion(const std::vector<ColliderDef>& colliders, double time, double seconds,
                 ColliderStates& states) {
  assert(states.size() == colliders.size());
  assert(time >= 0 && seconds > 0);
  for (std::size_t k = 0; k < states.size(); ++k) {
    ColliderState& state = states[k];
    if (state.is_jaw()) continue;
    state.forced = state.move ? state.move->force : colliders[k].force;
    const ColliderPair own = {static_cast<Index>(k), kNone};
    plan_object(goal_of(colliders[k], time + seconds, state), own, seconds, states, state);
    state.blocked = state.press.acts();
  }
}

void plan_object(const std::optional<MotionGoal>& goal, const ColliderPair& own, double seconds,
                 const ColliderStates& states, ColliderState& object) {
  assert(std::min(object.pace.into, object.pace.along) >= -1);
  assert(std::max(object.pace.into, object.pace.along) <= 1);
  const MotionGoal stay{object.pose, 0, 0, object.max_force, 0};
  const Vec3d left = step_along_pinch(goal.value_or(stay), own, seconds, states, object);
  begin_tick(object);
  if (goal) head_for(*goal, left, seconds, object);
}

void plan_carried(const Pose& goal, double seconds, ColliderState& object) {
  begin_tick(object);
  object.pace = {};
  const Vec3d step = goal.position - object.pose.position;
  head_for({goal, kMostColliderSpeed, kMostColliderTurnSpeed, 0, 0}, step, seconds, object);
}

void finish_motion(const std::vector<ColliderDef>& colliders, double seconds,
                   ColliderStates& states) {
  assert(states.size() == colliders.size());
  assert(seconds > 0);
  for (std::size_t k = 0; k < states.size(); ++k) {
    ColliderState& state = states[k];
    state.force = -(state.told.impulse + state.besides) / seconds;
    if (state.is_jaw() || state.wanted.is_zero()) continue;
    state.pace = next_paces(state, colliders[k].max_force, seconds);
  }
}

Pace next_paces(const ColliderState& object, double max_force, double seconds) {
  Pace next = object.pace;
  const double pushed = object.pushed.norm(), most = max_force * seconds;
  if (pushed > 0) next.against = object.pushed / pushed;
  const Vec3d into = part_into(object.wanted.linear, next);
  next.into = 1;
  if (!into.isZero(0) || pushed > most)  // it yields to more than its force wherever it goes
    next.into = next_pace(object, object.pace.into, pushed / most, object.wanted.linear.norm(),
                          next.yielded, seconds);
  const Vec3d along = object.wanted.linear - into;
  const double turn = object.wanted.angular.norm();
  const double speed = along.norm() + (turn > 0 ? turn * object.radius : 0);
  const double work = object.impulse.dot(along) + object.angular_impulse.dot(object.wanted.angular);
  const double resistance = speed > 0 ? work / (speed * most) : 0;
  next.along = next_pace(object, next.along, resistance, speed, 0, seconds);
  if (pushed == 0 && next.into == 1) {
    next.against.setZero();
    next.yielded = 0;
  }
  return next;
}

double yield_speed(double resistance) {
  assert(resistance > 1);
  return std::min(resistance - 1, kMostYielding) * kYieldSpeed;
}

}  // namespace weft
