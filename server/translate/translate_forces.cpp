#include "server/translate/translate_forces.h"

#include <algorithm>
#include <cmath>

#include "core/attachments/gripper_load.h"

namespace weft::server {
namespace {

/// The particle of the first side with the largest weight in a contact.
std::uint32_t heaviest(const ContactPoint& contact) {
  const auto end = contact.weight.begin() + contact.first_side;
  const auto place = std::max_element(contact.weight.begin(), end) - contact.weight.begin();
  return static_cast<std::uint32_t>(contact.particle[static_cast<std::size_t>(place)]);
}

proto::Vec3f floats(const Vec3d& v) {
  return to_wire_float(v.cast<float>());
}

}  // namespace

std::vector<proto::ContactInfo> contacts_of(const ServedWorld& world, const Reactions& reactions) {
  std::vector<proto::ContactInfo> list;
  for (const ContactPoint& contact : reactions.contacts) {
    proto::ContactInfo info;
    if (contact.collider != kNone)
      info.collider = world.def().colliders[static_cast<std::size_t>(contact.collider)].name;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
      info.particles.push_back(static_cast<std::uint32_t>(contact.particle[k]));
      info.weights.push_back(contact.weight[k]);
    }
    info.point = to_wire(contact.point);
    info.normal = to_wire(contact.normal);
    info.gap = contact.gap;
    info.normal_force = contact.normal_force;
    info.friction = to_wire(contact.friction);
    list.push_back(std::move(info));
  }
  return list;
}

proto::ReactionInfo reactions_of(const ServedWorld& world, const Reactions& reactions) {
  proto::ReactionInfo info;
  if (solver_of(world.def()) != SolverKind::relaxation) {
    info.pins.emplace();
    for (const PinReaction& pin : reactions.pins)
      info.pins->push_back({pin.pin, to_wire(pin.force)});
  }
  for (std::size_t k = 0; k < reactions.colliders.size(); ++k)
    info.colliders.push_back({world.def().colliders[k].name, to_wire(reactions.colliders[k])});
  return info;
}

proto::Result<std::size_t> find_gripper(const ServedWorld& world, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < world.grippers().size(); ++k) {
    if (world.grippers()[k].def.name == name) return k;
    names.push_back(world.grippers()[k].def.name);
  }
  proto::Error error = proto::word_error("name", name, std::move(names));
  error.code = proto::ErrorCode::unknown_gripper;
  return error;
}

GripperCommand gripper_command(const proto::Gripper& command) {
  GripperCommand out;
  out.opening = command.opening;
  out.force = command.force;
  if (command.position) out.position = from_wire(*command.position);
  if (command.rotation) {
    const proto::Quat& q = *command.rotation;
    out.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  }
  out.speed = command.speed;
  out.turn_speed = command.turn_speed;
  return out;
}

std::vector<proto::GripperInfo> grippers_of(const ServedWorld& world) {
  std::vector<proto::GripperInfo> list;
  for (const Gripper& gripper : world.grippers()) {
    const Eigen::Quaterniond& q = gripper.pose.rotation;
    const GripperLoad load = load_of(gripper, world.colliders(), world.tick_seconds());
    list.push_back({gripper.def.name,
                    to_wire(gripper.pose.position),
                    {q.x(), q.y(), q.z(), q.w()},
                    gripper.opening,
                    gripper.force,
                    gripper.gripping,
                    to_wire(load.force),
                    to_wire(load.torque)});
  }
  return list;
}

std::vector<proto::ContactSample> contact_samples(const ServedWorld& world) {
  std::vector<proto::ContactSample> samples;
  for (const ContactPoint& contact : world.reactions()->contacts) {
    const bool cloth = contact.collider == kNone;
    samples.push_back({cloth ? proto::kNoCollider : static_cast<std::uint32_t>(contact.collider),
                       heaviest(contact), floats(contact.point), floats(contact.normal),
                       static_cast<float>(contact.gap), static_cast<float>(contact.normal_force),
                       floats(contact.friction)});
  }
  return samples;
}

std::vector<proto::ReactionSample> reaction_samples(const ServedWorld& world) {
  std::vector<proto::ReactionSample> samples;
  const Reactions& reactions = *world.reactions();
  for (const PinReaction& pin : reactions.pins)
    samples.push_back({proto::ReactionOf::pin, pin.pin, floats(pin.force)});
  for (std::size_t k = 0; k < reactions.colliders.size(); ++k)
    samples.push_back({proto::ReactionOf::collider, static_cast<std::uint32_t>(k),
                       floats(reactions.colliders[k])});
  return samples;
}

}  // namespace weft::server
