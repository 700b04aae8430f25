// Plans the motion of colliders within their force limits.

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

struct Wish {
  Pose goal;
  double speed, turn_speed;  // limits
};

/// Target pose at the end of the tick.
std::optional<Wish> wish_of(const ColliderDef& def, double time, const ColliderState& state) {
  if (state.move) return Wish{state.move->target, state.move->speed, state.move->turn_speed};
  if (def.motion.keyframes.empty()) return std::nullopt;
  // Where it only turns, or only shifts, it comes back to that at the speeds of a command.
  const TopSpeeds top = top_speeds(def.motion);
  const MoveDef usual;
  return Wish{keyframed_pose(def, time),
              top.linear > 0 ? top.linear * kColliderCatchUp : usual.speed,
              top.angular > 0 ? top.angular * kColliderCatchUp : usual.turn_speed};
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
  return -std::min(1.0, std::min(resistance - 1, kMostYielding) * kYieldSpeed / speed);
}

/// Paces in the next tick, by the impulses of the last one.
Pace next_paces(const ColliderState& state, double max_force, double seconds) {
  Pace next = state.pace;
  const double pushed = state.pushed.norm(), most = max_force * seconds;
  if (pushed > 0) next.against = state.pushed / pushed;
  const Vec3d into = part_into(state.wanted.linear, next);
  next.into = 1;
  if (!into.isZero(0) || pushed > most)  // it yields to more than its force wherever it goes
    next.into = next_pace(state, state.pace.into, pushed / most, state.wanted.linear.norm(),
                          next.yielded, seconds);
  const Vec3d along = state.wanted.linear - into;
  const double turn = state.wanted.angular.norm();
  const double speed = along.norm() + (turn > 0 ? turn * state.radius : 0);
  const double work = state.impulse.dot(along) + state.angular_impulse.dot(state.wanted.angular);
  const double resistance = speed > 0 ? work / (speed * most) : 0;
  next.along = next_pace(state, next.along, resistance, speed, 0, seconds);
  if (pushed == 0 && next.into == 1) {
    next.against.setZero();
    next.yielded = 0;
  }
  return next;
}

/// Of two objects that press a layer against each other the weaker one gives way slowly, and the
/// stronger one follows.
/// @param k     number of one of them
/// @param step  towards its goal, along the pinch [m]
/// @param most  that either moves [m]
/// @return how far it goes along its pinch [m]
double advance_against(std::size_t k, double step, double most, const ColliderStates& states) {
  const ColliderState& state = states[k];
  assert(state.pinches() && most >= 0);
  const ColliderState& other = states[at_index(state.pinch.other)];
  const bool opposed = state.press.other == state.pinch.other;
  if (!opposed || other.press.other != static_cast<Index>(k)) return 0;
  if (state.max_force < other.max_force) return -most;
  return state.max_force > other.max_force ? std::clamp(step, 0.0, most) : 0;
}

/// What is left of the step towards its goal of an object that pinches a layer against another one
/// [m]: it goes no farther that way, but to where the layer has its thickness, and presses
/// with its force as long as its goal lies there. It moves on along the layer. Where layers beside
/// resist with its force it does not press besides.
/// @param k        its number
/// @param seconds  of the last tick, whose impulses the state still has
Vec3d step_along_pinch(std::size_t k, const Vec3d& step, double seconds, ColliderStates& states) {
  ColliderState& state = states[k];
  assert(!state.is_jaw() && seconds > 0);
  const double most = kYieldSpeed * seconds;
  if (!state.pinches()) {
    // What has let go for a moment is met again slowly.
    const double ahead = state.forced ? 0 : std::max(step.dot(state.press.direction) - most, 0.0);
    const Vec3d left = step - state.press.direction * ahead;
    state.press = {};
    return left;
  }
  const Vec3d& pinch = state.pinch.direction;
  const double into = step.dot(pinch);
  const double resistance = std::max(0.0, state.impulse.dot(pinch) / seconds);
  const bool stands = into > kPressingDepth && !state.forced;
  const bool presses = stands && resistance < state.max_force;
  const double advance = presses ? advance_against(k, into, most, states) : 0;
  state.press = {};
  if (presses)
    state.press = {pinch, state.max_force, state.max_force - resistance, state.pinch.other};
  const double back = std::clamp(state.pinch.lack / 2, -most, most);
  const Vec3d left = stands ? Vec3d(step - pinch * (into - advance + std::max(back, -into))) : step;
  state.pinch = {};
  return left;
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

}  // namespace

void plan_motion(const std::vector<ColliderDef>& colliders, double time, double seconds,
                 ColliderStates& states) {
  assert(states.size() == colliders.size());
  assert(time >= 0 && seconds > 0);
  for (std::size_t k = 0; k < states.size(); ++k) {
    ColliderState& state = states[k];
    assert(std::min(state.pace.into, state.pace.along) >= -1);
    assert(std::max(state.pace.into, state.pace.along) <= 1);
    state.start = state.goal = state.pose;
    state.start_overload = state.overload;
    state.wanted = state.twist = {};
    state.progress = 0;
    state.forced = state.move ? state.move->force : colliders[k].force;
    state.bracing = std::exchange(state.pinch.braces, false);
    const std::optional<Wish> wish = wish_of(colliders[k], time + seconds, state);
    const Vec3d step = wish ? Vec3d(wish->goal.position - state.pose.position) : Vec3d::Zero();
    Vec3d left = state.is_jaw() ? step : step_along_pinch(k, step, seconds, states);
    clear_impulses(state);
    state.blocked = !state.is_jaw() && state.press.acts();
    if (!wish) continue;
    const Vec3d turn = rotation_vector(wish->goal.rotation * state.pose.rotation.conjugate());
    // Translation and rotation of a command take the same time, so that the path does not depend on
    // the tick.
    const auto fraction_of = [&](const Vec3d& part) {
      return std::min(allowed_fraction(part.norm(), wish->speed * seconds),
                      allowed_fraction(turn.norm(), wish->turn_speed * seconds));
    };
    const double all = fraction_of(step);
    state.wanted = {step * (all / seconds), turn * (all / seconds)};
    if (state.wanted.is_zero() || state.forced) state.pace = {};
    if (state.pace.yields()) left = step;
    const double fraction = fraction_of(left);
    const bool arrives = fraction == 1 && state.pace.is_full();
    state.twist =
        slowed({left * (fraction / seconds), turn * (fraction / seconds)}, seconds, state.pace);
    state.goal = arrives ? wish->goal : moved(state.pose, state.twist, seconds);
    if (arrives && left != step) state.goal.position = state.pose.position + left;
  }
}

void finish_motion(const std::vector<ColliderDef>& colliders, double seconds,
                   ColliderStates& states) {
  assert(states.size() == colliders.size());
  assert(seconds > 0);
  for (std::size_t k = 0; k < states.size(); ++k) {
    ColliderState& state = states[k];
    state.force = -(state.impulse + state.besides) / seconds;
    if (state.wanted.is_zero()) continue;
    state.pace = next_paces(state, colliders[k].max_force, seconds);
  }
}

}  // namespace weft
