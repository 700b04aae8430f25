// Executes the planned motion of colliders, substep by substep.

#include "core/contact/colliders/collider_state.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/contact/colliders/constants.h"
#include "core/geometry/aabb.h"

namespace weft {
namespace {

/// Surface speed of the wanted twist, for the resistance against it [m/s].
double surface_speed(const ColliderState& state) {
  const double turn = state.wanted.angular.norm();
  return state.wanted.linear.norm() + (turn > 0 ? turn * state.radius : 0);
}

/// The work of what was given in a motion, per second of it [W s].
double power(const Given& given, const Twist& motion) {
  return given.impulse.dot(motion.linear) + given.angular.dot(motion.angular);
}

/// What has been given since the last call.
Given take_uncounted(ColliderState& state) {
  const Given given{state.impulse - state.counted, state.angular_impulse - state.angular_counted};
  state.counted = state.impulse;
  state.angular_counted = state.angular_impulse;
  return given;
}

/// The part of an impulse from what slows an object, if it is meant to go there [N s].
double resisted_push(const Vec3d& impulse, const Twist& wanted, const Pace& pace) {
  return wanted.linear.dot(pace.against) > 0 ? impulse.dot(pace.against) : 0;
}

/// Compares what resists a motion with the force [N s].
/// @param impact  what takes no longer is one [s]
/// @return whether it has exceeded the force for longer than an impact lasts
bool add_overload(double resisted, double seconds, double impact, ColliderState& state) {
  assert(seconds > 0 && state.max_force > 0);
  const double most = state.max_force * impact;
  state.overload =
      std::clamp(state.overload + resisted - state.max_force * seconds, 0.0, most * kMostOverload);
  return state.overload > most;
}

}  // namespace

Vec3d pivot_of(const ShapeDef& shape) {
  if (const auto* plane = std::get_if<PlaneDef>(&shape)) return plane->point;
  if (const auto* sphere = std::get_if<SphereDef>(&shape)) return sphere->centre;
  if (const auto* capsule = std::get_if<CapsuleDef>(&shape)) return (capsule->a + capsule->b) / 2;
  if (const auto* box = std::get_if<BoxDef>(&shape)) return box->centre;
  assert(!std::get<MeshDef>(shape).mesh.positions.empty());
  Aabb<double> bounds;
  for (const Vec3d& p : std::get<MeshDef>(shape).mesh.positions) bounds.add(p);
  return bounds.centre();
}

double radius_of(const ShapeDef& shape) {
  if (std::holds_alternative<PlaneDef>(shape)) return std::numeric_limits<double>::infinity();
  if (const auto* sphere = std::get_if<SphereDef>(&shape)) return sphere->radius;
  if (const auto* capsule = std::get_if<CapsuleDef>(&shape))
    return (capsule->b - capsule->a).norm() / 2 + capsule->radius;
  if (const auto* box = std::get_if<BoxDef>(&shape)) return box->half_extents.norm();
  const Vec3d pivot = pivot_of(shape);
  double farthest = 0;
  for (const Vec3d& p : std::get<MeshDef>(shape).mesh.positions)
    farthest = std::max(farthest, (p - pivot).norm());
  return farthest;
}

Pose keyframed_pose(const ColliderDef& def, double time) {
  Pose pose = offset_at(def.motion, time);
  pose.position += pivot_of(def.shape);
  return pose;
}

Pose rest_pose(const ShapeDef& shape) {
  return {pivot_of(shape), Eigen::Quaterniond::Identity()};
}

ColliderStates initial_states(const std::vector<ColliderDef>& colliders) {
  ColliderStates states(colliders.size());
  for (std::size_t k = 0; k < states.size(); ++k) {
    const ColliderDef& def = colliders[k];
    states[k].pose = def.motion.keyframes.empty() ? rest_pose(def.shape) : keyframed_pose(def, 0);
    states[k].start = states[k].goal = states[k].pose;
    states[k].radius = radius_of(def.shape);
    states[k].max_force = def.max_force;
  }
  return states;
}

void clear_impulses(ColliderState& state) {
  for (Vec3d* sum : {&state.impulse, &state.pushed, &state.angular_impulse, &state.counted,
                     &state.angular_counted, &state.besides})
    sum->setZero();
  state.told = {};
}

std::array<double, 2> mean_pushes(const Pinch& pinch, double seconds) {
  assert(seconds > 0);
  // What merely rubs pushes by rounding, to either side.
  return {std::max(0.0, pinch.pushes[0]) / seconds, std::max(0.0, pinch.pushes[1]) / seconds};
}

void take_back_motion(ColliderStates& states) {
  for (ColliderState& state : states) {
    state.pose = state.start;
    state.overload = state.start_overload;
    state.progress = 0;
    state.blocked = false;
    state.pinch = {};
    clear_impulses(state);
  }
}

bool count_resistance(double seconds, ColliderState& state) {
  const Given given = take_uncounted(state);
  if (state.wanted.is_zero()) return false;
  const double along = power(given, state.wanted) / surface_speed(state);
  const double resisted = std::max(along, resisted_push(given.impulse, state.wanted, state.pace));
  return add_overload(resisted, seconds, kImpactSeconds, state) && !state.pace.yields();
}

bool count_resistance(double seconds, ColliderState& jaw, ColliderState& mate) {
  const Given given = take_uncounted(jaw), by_mate = take_uncounted(mate);
  const Vec3d axis = (mate.pose.position - jaw.pose.position).normalized();
  const Vec3d apart = (jaw.wanted.linear - mate.wanted.linear) / 2;
  const Vec3d closing = axis * axis.dot(apart);
  const Twist wanted{jaw.wanted.linear - closing, jaw.wanted.angular};
  const Twist mates{mate.wanted.linear + closing, mate.wanted.angular};
  const Twist both{(wanted.linear + mates.linear) / 2, wanted.angular};
  const double speed =
      both.linear.norm() + (apart - closing).norm() + wanted.angular.norm() * jaw.radius;
  bool stands = false;
  if (speed > 0) {
    const double along = (power(given, wanted) + power(by_mate, mates)) / speed;
    const Vec3d pushed = given.impulse + by_mate.impulse;
    const double resisted = std::max(along, resisted_push(pushed, both, jaw.pace));
    const double impact = jaw.grips() ? kGripImpactSeconds : kImpactSeconds;
    stands = add_overload(resisted, seconds, impact, jaw) && !jaw.pace.yields();
  }
  if (!closing.isZero(0)) {
    const double resisted = (given.impulse - by_mate.impulse).dot(closing.normalized()) / 2;
    stands |= add_overload(resisted, seconds, kImpactSeconds, mate);
  }
  return stands;
}

void advance_collider(double seconds, double tick_seconds, ColliderState& state) {
  assert(seconds > 0 && tick_seconds > 0);
  if (!state.is_moving()) return;
  state.progress += seconds;
  const bool arrived = state.progress > tick_seconds * (1 - kTickEndSlack);
  state.pose = arrived ? state.goal : moved(state.start, state.twist, state.progress);
}

}  // namespace weft
