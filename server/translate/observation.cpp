#include "server/translate/observation.h"

#include <algorithm>

#include "core/attachments/gripper_load.h"

namespace weft::server {
namespace {

bool has(const std::vector<proto::Observed>& observe, proto::Observed what) {
  return std::find(observe.begin(), observe.end(), what) != observe.end();
}

std::vector<proto::GripperSample> gripper_samples(const ServedWorld& world) {
  std::vector<proto::GripperSample> samples;
  for (const Gripper& gripper : world.grippers()) {
    const Eigen::Quaternionf q = gripper.pose.rotation.cast<float>();
    const GripperLoad load = load_of(gripper, world.colliders(), world.tick_seconds());
    samples.push_back({static_cast<std::uint32_t>(gripper.jaw[0]),
                       gripper.gripping ? 1U : 0U,
                       to_wire_float(gripper.pose.position.cast<float>()),
                       {q.x(), q.y(), q.z(), q.w()},
                       static_cast<float>(gripper.opening),
                       static_cast<float>(gripper.force),
                       to_wire_float(load.force.cast<float>()),
                       to_wire_float(load.torque.cast<float>())});
  }
  return samples;
}

}  // namespace

bool observes_forces(const std::vector<proto::Observed>& observe) {
  return has(observe, proto::Observed::contacts) || has(observe, proto::Observed::reactions);
}

Observation observation_of(const ServedWorld& world, const std::vector<proto::Observed>& observe) {
  Observation seen;
  if (has(observe, proto::Observed::velocities)) seen.velocities = floats_of(world.state().v);
  if (world.reactions() && has(observe, proto::Observed::contacts))
    seen.contacts = contact_samples(world);
  if (world.reactions() && has(observe, proto::Observed::reactions))
    seen.reactions = reaction_samples(world);
  if (has(observe, proto::Observed::grippers)) seen.grippers = gripper_samples(world);
  return seen;
}

void show(const Observation& observation, proto::FrameView& frame) {
  frame.header.flags |= proto::kFrameObserved;
  frame.velocities = observation.velocities;
  frame.contacts = observation.contacts;
  frame.reactions = observation.reactions;
  frame.grippers = observation.grippers;
}

}  // namespace weft::server
