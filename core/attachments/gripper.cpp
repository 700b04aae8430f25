// Plans the motion of grippers and reads their contact.

#include "core/attachments/gripper.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/attachments/constants.h"
#include "core/contact/colliders/collider_plan.h"
#include "core/contact/colliders/constants.h"
#include "core/error.h"

namespace weft {
namespace {

/// Offset of a jaw's middle from the gripper's, as defined [m].
Vec3d offset_of_jaw(const GripperDef& def, std::size_t jaw, double opening) {
  assert(jaw < 2 && opening >= 0);
  const double x = opening / 2 + def.half_extents[0];
  return def.orientation * Vec3d(jaw == 0 ? -x : x, 0, 0);
}

/// Whether a jaw and its gripper pinch layers in much the same direction.
bool is_alike(const Pinch& jaw, const Pinch& middle) {
  return jaw.other != kNone && jaw.direction.dot(middle.direction) > kAlikePinches;
}

/// What a gripper pinches by its jaws: of both the mean, or what it is sent into more.
Pinch joint_pinch(const Pinch& left, const Pinch& right, const Vec3d& wanted) {
  if (left.other == kNone) return right;
  if (right.other == kNone) return left;
  if (!is_alike(left, right))
    return wanted.dot(left.direction) < wanted.dot(right.direction) ? right : left;
  return {(left.direction + right.direction).normalized(), std::max(left.lack, right.lack),
          left.other, left.braces || right.braces};
}

/// What cloth has done to both jaws in the tick, as what it has done to their middle.
void join_jaws(const ColliderStates& colliders, Gripper& gripper) {
  ColliderState& middle = gripper.middle;
  const ColliderState &left = colliders[gripper.jaw[0]], &right = colliders[gripper.jaw[1]];
  clear_impulses(middle);
  for (const ColliderState* jaw : {&left, &right}) {
    const Vec3d lever = jaw->pose.position - gripper.pose.position;
    middle.impulse += jaw->impulse;
    middle.pushed += jaw->pushed;
    middle.angular_impulse += jaw->angular_impulse + lever.cross(jaw->impulse);
  }
  middle.blocked = left.blocked || right.blocked;
  middle.pinch = joint_pinch(left.pinch, right.pinch, middle.wanted.linear);
}

/// Whether what jaws hold has jammed under them, so that it cannot yield and stops them with less
/// than their force.
bool is_jammed(const Gripper& gripper, const ColliderState& jaw) {
  const ColliderState& middle = gripper.middle;
  const double moved = (gripper.pose.position - middle.start.position).norm();
  return gripper.gripping && middle.blocked && jaw.overload == 0 && moved < kArrivalDistance;
}

/// How far a gripper that stays yields in a tick to cloth that jams under it, as it does on its way
/// to more than its force [m].
Vec3d yielding(const ColliderState& middle, double max_force, double seconds) {
  const double resistance = middle.pushed.norm() / (max_force * seconds);
  if (!(resistance > 1)) return Vec3d::Zero();
  return -middle.pushed.normalized() * (yield_speed(resistance) * seconds);
}

/// How far a gripper goes back in a tick, wherever it was sent [m]: to yield where it stays, and to
/// get free of what stops it.
/// @param stops  its jaws cannot close because they stand
Vec3d way_back(const Gripper& gripper, const ColliderState& jaw, bool stops, double thickest,
               double seconds) {
  const Vec3d ahead = (gripper.target.position - gripper.pose.position).normalized();
  Vec3d back = Vec3d::Zero();
  if (gripper.stays) back += yielding(gripper.middle, gripper.def.max_force, seconds);
  if (stops) back -= ahead * (kJawRetreat * thickest);
  if (is_jammed(gripper, jaw)) back -= ahead * (kJamRetreat * thickest);
  return back;
}

/// Paces of the middle after the tick. Where what it carries has stopped it within the tick, it
/// goes on at the mean speed of that: at full speed for a while and standing for a while it would
/// give its load an impulse and take it back, and not get going.
Pace paces_of(const Gripper& gripper, double seconds, const ColliderState& jaw) {
  const Pace& before = gripper.middle.pace;
  Pace next = next_paces(gripper.middle, gripper.def.max_force, seconds);
  const double gone = jaw.progress / seconds;
  if (jaw.overload > 0 && gone < 1 - kTickEndSlack && next.along > 0)
    next.along = std::min(next.along, std::max(0.0, before.along) * gone);
  return next;
}

/// Plans the tick of the middle. Jaws that cannot close because they stand, as where they have been
/// sent into cloth on a table, draw back until they can, and stay there until they are sent
/// elsewhere. From what jams under them they draw back for a tick. Jaws that do not grip press
/// layers in their way on other objects; those that close with no more than they will grip with:
/// they rub, and bunch cloth as they close.
void plan_middle(double seconds, double thickest, const ColliderStates& colliders,
                 Gripper& gripper) {
  ColliderState& middle = gripper.middle;
  const bool closes = gripper.wanted < gripper.opening;
  const bool stops = closes && !gripper.gripping && middle.blocked;
  gripper.stays = closes && (gripper.stays || stops);
  const double most = gripper.def.max_force;
  const double hold = gripper.gripping ? 0 : closes ? std::min(gripper.force, most) : most;
  MotionGoal goal{gripper.target, gripper.speed, gripper.turn_speed, hold, kPressingSlope};
  const Vec3d back = way_back(gripper, colliders[gripper.jaw[0]], stops, thickest, seconds);
  if (gripper.stays || !back.isZero(0))
    goal.pose = {gripper.pose.position + back, gripper.pose.rotation};
  middle.pose = gripper.pose;
  middle.max_force = hold;
  const ColliderPair own = {static_cast<Index>(gripper.jaw[0]), static_cast<Index>(gripper.jaw[1])};
  plan_object(goal, own, seconds, colliders, middle);
}

/// Whether the jaws were stopped by more than the layer that both have in front of them: by
/// several, or by one that is bunched or lies across their rims. Where that is all, they stand at
/// its two sides and its impulses cancel.
/// @param resistance  of the cloth to both [N]
/// @param was         whether they were in the last tick
bool grips_layers(const Gripper& gripper, double resistance, bool was) {
  if (!gripper.gripping) return false;
  if (gripper.opening > 2 * gripper.facing * (1 + kJawFacingSlack)) return true;
  return resistance > gripper.force * (was ? kJawLeaves : 1);
}

/// Resistance of the cloth to both jaws in the last tick, without what they squeeze with [N].
double resistance_of(const Gripper& gripper, const ColliderStates& colliders, double seconds) {
  const auto of_jaw = [&](std::size_t k) {
    return colliders[gripper.jaw[k]].impulse.dot(press_of(gripper, k)) / seconds;
  };
  return std::max(0.0, std::min(of_jaw(0), of_jaw(1)));
}

/// Opening of jaws at the end of the tick that layers resist [m]. What they resist with changes
/// within the thickness of one of them, so jaws yield at once, and come back slowly. Jaws that meet
/// several layers close too far in the tick in which these resist, and layers that were pressed
/// resist less after a while.
/// @param resistance  of the cloth to both [N]
/// @param most        change of the opening [m]
double opening_on_layers(double resistance, double most, double thickest, Gripper& gripper) {
  const double excess = (resistance - gripper.force) / std::max(gripper.force, kLeastGrip);
  if (excess > 0) {
    gripper.closing = 0;
    return gripper.opening + std::min(most, std::min(excess, kMostJawYield) * kJawYield * thickest);
  }
  gripper.closing = std::min(std::max(gripper.closing * kJawGrowth, kJawTurning), -excess);
  const double step = std::min(most, gripper.closing * kJawYield * thickest);
  return std::max(gripper.opening - step, 2 * gripper.facing);
}

/// Opening of the jaws at the end of the tick [m].
/// @param resistance  of the cloth to both [N]
/// @param layered     more resists than one layer
double next_opening(double resistance, bool layered, double seconds, double thickest,
                    Gripper& gripper) {
  assert(gripper.opening >= 0 && gripper.facing >= 0 && resistance >= 0);
  double step = 2 * gripper.def.closing_speed * seconds;
  if (gripper.wanted >= gripper.opening) return std::min(gripper.wanted, gripper.opening + step);
  if (gripper.gripping) {
    if (layered) return opening_on_layers(resistance, step, thickest, gripper);
    // They were nearer than the layer when they found it, and give it room.
    return std::max(gripper.opening, std::min(gripper.opening + step, 2 * gripper.facing));
  }
  if (gripper.opening < kJawNearOpening * thickest) step = std::min(step, kJawNearStep * thickest);
  double least = gripper.wanted;
  // Two faces that both have cloth in front leave a gap for that cloth, and for no less.
  least = std::max(least, 2 * gripper.facing);
  return std::max(std::min(least, gripper.opening), gripper.opening - step);
}

/// Jaws press layers on other objects with what their gripper does, in equal shares.
/// @param pinch  of the gripper
void press_layers(const Pinch& pinch, const Gripper& gripper, double seconds,
                  ColliderStates& colliders) {
  const Press& press = gripper.middle.press;
  int pressing = 0;
  for (const std::size_t k : gripper.jaw) {
    colliders[k].stands = is_alike(colliders[k].pinch, pinch);
    if (colliders[k].stands) ++pressing;
  }
  for (const std::size_t k : gripper.jaw) {
    ColliderState& jaw = colliders[k];
    jaw.press = {};
    if (press.acts() && jaw.stands)
      jaw.press = {press.direction,
                   press.hold / pressing,
                   press.squeeze / pressing,
                   jaw.pinch.other,
                   pressing,
                   mean_pushes(jaw.pinch, seconds)};
  }
}

/// Plans the tick of a jaw, which goes with the middle.
/// @param offset  from it, as defined, at the end of the tick [m]
void plan_jaw(const Gripper& gripper, const Vec3d& offset, double seconds, ColliderState& jaw) {
  const ColliderState& middle = gripper.middle;
  const Vec3d lever = jaw.pose.position - middle.pose.position;
  const Pose& goal = middle.goal;
  plan_carried({goal.position + goal.rotation * offset, goal.rotation}, seconds, jaw);
  // What resists the middle resists the jaws, wherever it stands or yields.
  const Vec3d turn = middle.wanted.angular - middle.twist.angular;
  jaw.wanted.linear += middle.wanted.linear - middle.twist.linear + turn.cross(lever);
  jaw.wanted.angular += turn;
  jaw.pace = middle.pace;
}

}  // namespace

std::array<ColliderDef, 2> jaws_of(const GripperDef& def) {
  std::array<ColliderDef, 2> jaws;
  for (std::size_t k = 0; k < 2; ++k) {
    jaws[k].name = def.name + (k == 0 ? ".left" : ".right");
    jaws[k].shape =
        BoxDef{def.centre + offset_of_jaw(def, k, def.opening), def.half_extents, def.orientation};
    jaws[k].max_force = def.max_force;
    jaws[k].friction_factor = def.friction_factor;
  }
  return jaws;
}

std::vector<Gripper> initial_grippers(const std::vector<GripperDef>& defs, std::size_t first_jaw) {
  std::vector<Gripper> grippers;
  for (const GripperDef& def : defs) {
    Gripper gripper;
    gripper.def = def;
    gripper.jaw = {first_jaw, first_jaw + 1};
    first_jaw += 2;
    gripper.pose.position = gripper.target.position = def.centre;
    gripper.opening = gripper.wanted = def.opening;
    gripper.speed = def.speed;
    gripper.turn_speed = def.turn_speed;
    gripper.force = def.force;
    gripper.middle.radius = offset_of_jaw(def, 0, def.opening).norm() + def.half_extents.norm();
    grippers.push_back(gripper);
  }
  return grippers;
}

void validate(const GripperDef& def, const std::string& path) {
  visit_fields_of_gripper(
      def, [&path](const FieldInfo& info, const auto& value) { check_field(path, info, value); });
  if (def.name.empty() || def.name.size() > 56)
    throw DefinitionError(path + "name", def.name, "1 to 56 characters");
  check_unit(path + "orientation", def.orientation);
  check_field(path, {"steps", 0, kMostGripperSteps, "", "number of steps"},
              static_cast<double>(def.steps.size()));
  for (std::size_t k = 0; k < def.steps.size(); ++k) {
    const std::string at = path + "steps[" + std::to_string(k) + "].";
    visit_fields_of_gripper_step(def.steps[k], [&at](const FieldInfo& info, const auto& value) {
      check_field(at, info, value);
    });
    check_unit(at + "rotation", def.steps[k].rotation);
    if (k > 0 && !(def.steps[k].time > def.steps[k - 1].time))
      throw DefinitionError(at + "time", number_text(def.steps[k].time),
                            "more than that of the step before");
  }
}

void validate(const GripperCommand& command, const std::string& path) {
  const auto check = [&path](const FieldInfo& info, const auto& value) {
    if (value) check_field(path, info, *value);
  };
  check({"opening", kOpeningRange, "m", "between the jaws"}, command.opening);
  check({"force", kGripRange, "N", "force of each jaw"}, command.force);
  check({"position", kPivotRange, "m", "of its middle"}, command.position);
  check({"speed", kMoveSpeedRange, "m/s", "of its middle"}, command.speed);
  check({"turn_speed", kTurnSpeedRange, "rad/s", "at most"}, command.turn_speed);
  if (command.rotation) check_unit(path + "rotation", *command.rotation);
}

void command_gripper(const GripperCommand& command, Gripper& gripper) {
  if (!gripper.commanded)
    gripper.target = gripper.pose;  // it stays where its steps have brought it
  gripper.commanded = true;
  if (command.opening) gripper.wanted = *command.opening;
  if (command.force) gripper.force = *command.force;
  if (command.position || command.rotation) gripper.stays = false;
  if (command.position) gripper.target.position = *command.position;
  if (command.rotation) gripper.target.rotation = command.rotation->normalized();
  if (command.speed) gripper.speed = *command.speed;
  if (command.turn_speed) gripper.turn_speed = *command.turn_speed;
}

void plan_grippers(double time, double seconds, double thickest, std::vector<Gripper>& grippers,
                   ColliderStates& colliders) {
  assert(time >= 0 && seconds > 0);
  assert(grippers.empty() || thickest > 0);
  for (Gripper& gripper : grippers) {
    assert(gripper.jaw[0] < colliders.size() && gripper.jaw[1] < colliders.size());
    for (const GripperStep& step : gripper.def.steps) {
      if (gripper.commanded || step.time > time) break;
      const Pose target{gripper.def.centre + step.offset, step.rotation.normalized()};
      gripper.stays = gripper.stays && gripper.target == target;
      gripper.target = target;
      gripper.wanted = step.opening;
    }
    if (gripper.wanted >= gripper.opening) gripper.gripping = false;
    const Pinch pinch = gripper.middle.pinch;
    plan_middle(seconds, thickest, colliders, gripper);
    const double resistance = resistance_of(gripper, colliders, seconds);
    const bool was = colliders[gripper.jaw[0]].layered;
    const bool layered = grips_layers(gripper, resistance, was);
    const double opening = next_opening(resistance, layered, seconds, thickest, gripper);
    press_layers(pinch, gripper, seconds, colliders);
    for (std::size_t k = 0; k < 2; ++k) {
      ColliderState& jaw = colliders[gripper.jaw[k]];
      jaw.mate = static_cast<Index>(gripper.jaw[1 - k]);
      jaw.layered = layered;
      plan_jaw(gripper, offset_of_jaw(gripper.def, k, opening), seconds, jaw);
      if (jaw.press.acts()) continue;  // on another object
      const double hold = gripper.gripping ? gripper.force : 0;
      const double squeeze = hold - (jaw.layered ? std::min(resistance, hold) : 0);
      jaw.press = {press_of(gripper, k), hold, squeeze};
      jaw.press.room = opening / 2;
    }
  }
}

void finish_grippers(double seconds, const ColliderStates& colliders,
                     std::vector<Gripper>& grippers) {
  assert(seconds > 0);
  for (Gripper& gripper : grippers) {
    assert(gripper.jaw[0] < colliders.size() && gripper.jaw[1] < colliders.size());
    const ColliderState &left = colliders[gripper.jaw[0]], &right = colliders[gripper.jaw[1]];
    const Vec3d axis = left.pose.rotation * (gripper.def.orientation * Vec3d::UnitX());
    const Vec3d between = right.pose.position - left.pose.position;
    // A jaw that was held back holds the middle back by half as much.
    gripper.pose.position = (left.pose.position + right.pose.position) / 2;
    gripper.pose.rotation = left.pose.rotation;
    if ((gripper.pose.position - gripper.target.position).norm() < kArrivalDistance)
      gripper.pose.position = gripper.target.position;
    gripper.opening = std::max(0.0, axis.dot(between) - 2 * gripper.def.half_extents[0]);
    if (std::abs(gripper.opening - gripper.wanted) < kArrivalDistance)
      gripper.opening = gripper.wanted;  // by rounding it would be closing for ever
    gripper.facing = std::min(left.facing, right.facing);
    join_jaws(colliders, gripper);
    if (!gripper.middle.wanted.is_zero()) gripper.middle.pace = paces_of(gripper, seconds, left);
    if (gripper.wanted >= gripper.opening) continue;
    const double clearance = 2 * gripper.facing * (1 + kJawFacingSlack);
    const bool stopped = gripper.opening <= clearance || left.blocked || right.blocked ||
                         resistance_of(gripper, colliders, seconds) > gripper.force;
    gripper.gripping = gripper.facing > 0 && (gripper.gripping || stopped);
  }
}

Vec3d press_of(const Gripper& gripper, std::size_t jaw) {
  assert(jaw < 2);
  const Vec3d axis = (gripper.pose.rotation * gripper.def.orientation) * Vec3d::UnitX();
  return jaw == 0 ? axis : Vec3d(-axis);
}

}  // namespace weft
