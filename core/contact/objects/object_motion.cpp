// Plans and executes the motion of objects, substep by substep.

#include "core/contact/objects/object_motion.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/contact/objects/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Whether an object goes on into what it pinches, until the next tick presses instead.
bool goes_into_pinch(const ColliderState& state) {
  return !state.press.acts() && state.twist.linear.dot(state.pinch.direction) > 0;
}

/// The same of a jaw, by the motion of both: they close on what both have in front of them.
bool goes_into_pinch(const ColliderState& jaw, const ColliderState& mate) {
  if (jaw.stands || !jaw.pinches()) return false;
  return (jaw.twist.linear + mate.twist.linear).dot(jaw.pinch.direction) > kIntoPinch;
}

/// Whether both jaws of a gripper stand in the coming substep.
bool jaws_stand(double dt, ColliderState& jaw, ColliderState& mate) {
  return count_resistance(dt, jaw, mate) || goes_into_pinch(jaw, mate) ||
         goes_into_pinch(mate, jaw);
}

/// Objects that have been resisted by more than their force stand in the coming substep, and both
/// jaws if one does; and what has begun to pinch a layer.
template <class Real>
void stop_overloaded(double dt, ColliderStates& colliders, ObjectShapes<Real>& shapes) {
  const auto rest = [&shapes](std::size_t k) {
    shapes.frames[k].rest = std::max(shapes.frames[k].rest, 1);
  };
  for (std::size_t k = 0; k < shapes.frames.size(); ++k) {
    if (!shapes.frames[k].tracked) continue;
    if (!colliders[k].is_jaw()) {
      if (count_resistance(dt, colliders[k]) || goes_into_pinch(colliders[k])) rest(k);
      continue;
    }
    const std::size_t mate = at_index(colliders[k].mate);
    if (mate < k || !jaws_stand(dt, colliders[k], colliders[mate])) continue;
    rest(k);
    rest(mate);
  }
}

}  // namespace

template <class Real>
bool begin_motion(double tick_seconds, ColliderStates* colliders, ObjectShapes<Real>& shapes,
                  ObjectMotion<Real>& motion) {
  assert(tick_seconds > 0);
  motion.tick_seconds = static_cast<Real>(tick_seconds);
  motion.colliders = colliders;
  motion.work = 0;
  const bool moved = std::exchange(motion.any_tracked, false);
  const bool pressed = std::exchange(motion.any_press, false);
  motion.surface_speed = 0;
  if (!colliders) {
    for (ColliderFrame<Real>& frame : shapes.frames) frame.tracked = false;
    return false;
  }
  assert(colliders->size() == shapes.frames.size());
  bool rows_go = false;
  for (std::size_t k = 0; k < shapes.frames.size(); ++k) {
    ColliderFrame<Real>& frame = shapes.frames[k];
    ColliderState& state = (*colliders)[k];
    const bool moves = state.is_active() || state.bracing;
    // Jaws are asked what cloth does to them, also where they stand.
    const bool tracked = moves || state.is_jaw();
    rows_go |= tracked && !frame.tracked;  // the old ones do not follow it
    frame.tracked = tracked;
    motion.any_tracked = motion.any_tracked || moves;
    motion.any_press = motion.any_press || state.press.acts();
    state.facing = 0;
    // What slips out of jaws goes round their rims, where planes that stay would stop it for ever.
    rows_go |= state.press.hold > 0;
    const double turn = state.twist.angular.norm();
    const double speed = state.twist.linear.norm() + (turn > 0 ? turn * frame.radius : 0);
    motion.surface_speed = std::max(motion.surface_speed, static_cast<Real>(speed));
  }
  // Rows would keep the grip of what presses no longer.
  rows_go |= pressed && !motion.any_press;
  return rows_go || (motion.any_tracked && !moved);
}

template <class Real>
void plan_objects(Real dt, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion) {
  assert(dt > 0);
  motion.coming = motion.since_rows = motion.since_pairs = 0;
  if (!motion.colliders) return;
  ColliderStates& colliders = *motion.colliders;
  stop_overloaded(static_cast<double>(dt), colliders, shapes);
  for (std::size_t k = 0; k < shapes.frames.size(); ++k) {
    ColliderFrame<Real>& frame = shapes.frames[k];
    frame.wary = std::max(0, frame.wary - 1);
    frame.blocked = frame.tracked && frame.rest > 0 && !colliders[k].forced;
    if (frame.tracked && !frame.blocked)
      frame.plan(colliders[k], static_cast<double>(dt), static_cast<double>(motion.tick_seconds));
    else
      frame.stand();
    if (frame.blocked) colliders[k].blocked = true;
    frame.rest = frame.blocked ? frame.rest - 1 : 0;
    motion.coming = std::max(motion.coming, frame.travel);
    motion.since_rows = std::max(motion.since_rows, frame.travel_since_rows + frame.travel);
    motion.since_pairs = std::max(motion.since_pairs, frame.travel_since_pairs);
  }
}

template <class Real>
void advance_objects(Real dt, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion) {
  assert(motion.colliders);
  for (std::size_t k = 0; k < shapes.frames.size(); ++k) {
    ColliderFrame<Real>& frame = shapes.frames[k];
    ColliderState& state = (*motion.colliders)[k];
    if (!frame.tracked || frame.blocked) continue;
    advance_collider(static_cast<double>(dt), static_cast<double>(motion.tick_seconds), state);
    place_collider(k, state.pose, shapes);
    frame.travel_since_pairs += frame.travel;
    frame.travel_since_rows += frame.travel;
  }
}

template <class Real>
void block_object(std::size_t collider, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion) {
  assert(motion.colliders && collider < shapes.frames.size());
  const auto stop = [&](std::size_t k) {
    ColliderFrame<Real>& frame = shapes.frames[k];
    frame.stand();
    frame.blocked = true;
    frame.rest = kRest;
    frame.wary = kWary;
    (*motion.colliders)[k].blocked = true;
  };
  stop(collider);
  const Index mate = (*motion.colliders)[collider].mate;
  if (mate != kNone) stop(at_index(mate));
  motion.since_rows = 0;
  for (const ColliderFrame<Real>& frame : shapes.frames)
    motion.since_rows = std::max(motion.since_rows, frame.travel_since_rows + frame.travel);
}

WEFT_INSTANTIATE_FUNCTIONS(begin_motion, plan_objects, advance_objects, block_object)

}  // namespace weft
