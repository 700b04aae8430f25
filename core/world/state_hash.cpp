// Hashes the state of a world.

#include "core/world/state_hash.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <type_traits>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace weft {
namespace {

template <class T>
void feed(XXH64_state_t& hash, const T* values, std::size_t count) {
  if (count > 0) XXH64_update(&hash, values, count * sizeof(T));
}

std::array<double, 9> numbers_of(const Pose& pose, double first, double second) {
  const auto& p = pose.position;
  const auto& q = pose.rotation;
  return {first, second, p[0], p[1], p[2], q.x(), q.y(), q.z(), q.w()};
}

/// What the plan of the next tick depends on: nothing for one that nothing resists.
void feed_plan(XXH64_state_t& hash, const ColliderState& state) {
  if (state.pace.into != 1) {
    feed(hash, &state.pace.into, 1);
    feed(hash, state.pace.against.data(), 3);
    feed(hash, &state.pace.yielded, 1);
  }
  if (state.pinches()) {
    feed(hash, state.pinch.direction.data(), 3);
    feed(hash, &state.pinch.lack, 1);
    feed(hash, &state.pinch.other, 1);
    feed(hash, state.pinch.pushes.data(), 2);
    feed(hash, &state.press.other, 1);
    feed(hash, &state.impulse, 1);  // which is left of its force
  }
}

/// A collider that never moved adds nothing.
void feed(XXH64_state_t& hash, std::size_t number, const ColliderDef& def,
          const ColliderState& state) {
  if (state.pose == rest_pose(def.shape) && !state.move && state.pace.is_full()) return;
  const auto own = numbers_of(state.pose, static_cast<double>(number), state.pace.along);
  feed(hash, own.data(), own.size());
  if (state.overload > 0) feed(hash, &state.overload, 1);
  feed_plan(hash, state);
  if (state.is_jaw() && state.press.hold > 0)
    feed(hash, &state.impulse, 1);                      // to which the jaw may yield
  if (state.layered) feed(hash, &state.press.hold, 1);  // to tell it from one that is not
  if (!state.move) return;
  const auto wanted = numbers_of(state.move->target, state.move->speed, state.move->turn_speed);
  feed(hash, wanted.data(), wanted.size());
}

void feed(XXH64_state_t& hash, const Gripper& gripper) {
  const auto pose = numbers_of(gripper.pose, gripper.opening, gripper.wanted);
  const auto target = numbers_of(gripper.target, gripper.speed, gripper.turn_speed);
  feed(hash, pose.data(), pose.size());
  feed(hash, target.data(), target.size());
  if (gripper.closing > 0) feed(hash, &gripper.closing, 1);
  if (gripper.stays) feed(hash, &gripper.speed, 1);  // once more, to tell it
  if (gripper.middle.pace.along != 1) feed(hash, &gripper.middle.pace.along, 1);
  feed_plan(hash, gripper.middle);
  const std::array<double, 4> rest = {gripper.force, gripper.facing, gripper.commanded ? 1.0 : 0.0,
                                      gripper.gripping ? 1.0 : 0.0};
  feed(hash, rest.data(), rest.size());
}

/// A pin at rest adds nothing.
void feed(XXH64_state_t& hash, const Pin& pin) {
  if (!pin.path) return;
  const PinPath& path = *pin.path;
  feed(hash, path.start.data(), path.start.size());
  feed(hash, &path.offset, 1);
  feed(hash, &path.move.target, 1);
  const std::array<double, 4> rest = {path.move.speed, path.move.max_force, path.pace,
                                      static_cast<double>(pin.id)};
  feed(hash, rest.data(), rest.size());
}

/// All numbers of an environment, those of its fans at the end.
std::vector<double> numbers_of(const EnvironmentDef& environment) {
  std::vector<double> numbers;
  const auto note = [&numbers](const FieldInfo&, const auto& value) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
      numbers.push_back(static_cast<double>(value));
    else
      numbers.insert(numbers.end(), value.data(), value.data() + value.size());
  };
  visit_fields_of_environment(environment, note);
  for (const FanDef& fan : environment.fans) visit_fields_of_fan(fan, note);
  return numbers;
}

std::vector<double> numbers_of(const FabricDef& fabric) {
  std::vector<double> numbers;
  visit_fields_of_fabric(fabric,
                         [&numbers](const FieldInfo&, double value) { numbers.push_back(value); });
  return numbers;
}

/// Conditions that are as defined add nothing.
void feed(XXH64_state_t& hash, const Conditions& conditions) {
  const std::vector<double> present = numbers_of(conditions.present);
  if (present != numbers_of(conditions.defined)) feed(hash, present.data(), present.size());
  if (!conditions.gusts_ahead.isZero(0)) feed(hash, &conditions.gusts_ahead, 1);
  if (conditions.softness != 1) feed(hash, &conditions.softness, 1);
  assert(conditions.cloths.size() == conditions.scene_fabrics.size());
  for (std::size_t k = 0; k < conditions.cloths.size(); ++k) {
    std::vector<double> fabric = numbers_of(conditions.cloths[k].fabric);
    if (fabric == numbers_of(conditions.scene_fabrics[k])) continue;
    fabric.push_back(static_cast<double>(k));
    feed(hash, fabric.data(), fabric.size());
  }
}

}  // namespace

template <class Real>
std::uint64_t state_hash(const ClothState<Real>& state, const Pins& pins, const Grabs<Real>& grabs,
                         const std::vector<ColliderDef>& defs, const ColliderStates& colliders,
                         const std::vector<Gripper>& grippers, const std::vector<char>& asleep,
                         const Conditions& conditions, std::uint64_t tick) {
  static_assert(sizeof(Vec3<Real>) == 3 * sizeof(Real), "positions are hashed as plain numbers");
  assert(state.x.size() == state.v.size());
  assert(defs.size() == colliders.size());
  XXH64_state_t hash;
  XXH64_reset(&hash, 0);
  const auto awake = static_cast<std::size_t>(std::count(asleep.begin(), asleep.end(), 0));
  if (awake > 0) feed(hash, &tick, 1);
  if (awake < asleep.size()) feed(hash, asleep.data(), asleep.size());
  feed(hash, state.x.data(), state.x.size());
  feed(hash, state.v.data(), state.v.size());
  feed(hash, pins.pin_count.data(), pins.pin_count.size());
  for (const Pin& pin : pins.list) feed(hash, pin);
  for (const Grab<Real>& grab : grabs.list) {
    feed(hash, grab.particles.data(), grab.particles.size());
    feed(hash, grab.weights.data(), grab.weights.size());
    feed(hash, &grab.path_begin, 1);
    feed(hash, &grab.target, 1);
    feed(hash, &grab.def.stiffness, 1);
    feed(hash, &grab.def.max_force, 1);
    feed(hash, &grab.offset, 1);
    if (grab.def.mode == GrabMode::live) feed(hash, &grab.force, 1);  // where the next one begins
    if (grab.def.mode == GrabMode::sling) feed(hash, &grab.def.mode, 1);
  }
  for (const SlingImpulse<Real>& impulse : grabs.impulses) {
    feed(hash, impulse.particles.data(), impulse.particles.size());
    feed(hash, impulse.weights.data(), impulse.weights.size());
    feed(hash, &impulse.force, 1);
    feed(hash, &impulse.ticks_left, 1);
  }
  for (std::size_t k = 0; k < colliders.size(); ++k) feed(hash, k, defs[k], colliders[k]);
  for (const Gripper& gripper : grippers) feed(hash, gripper);
  feed(hash, conditions);
  return XXH64_digest(&hash);
}

template std::uint64_t state_hash(const ClothState<float>&, const Pins&, const Grabs<float>&,
                                  const std::vector<ColliderDef>&, const ColliderStates&,
                                  const std::vector<Gripper>&, const std::vector<char>&,
                                  const Conditions&, std::uint64_t);
template std::uint64_t state_hash(const ClothState<double>&, const Pins&, const Grabs<double>&,
                                  const std::vector<ColliderDef>&, const ColliderStates&,
                                  const std::vector<Gripper>&, const std::vector<char>&,
                                  const Conditions&, std::uint64_t);

}  // namespace weft
