#include "server/translate/translate_holds.h"

#include <algorithm>

namespace weft::server {

proto::PinInfo pin_info(const ServedWorld& world, const Pin& pin, proto::ViewerId owner) {
  proto::PinInfo info;
  info.id = pin.id;
  info.viewer = owner;
  info.particle = static_cast<std::uint32_t>(pin.centre);
  info.radius = pin.def.radius;
  info.position =
      to_wire(Vec3d(world.state().x[static_cast<std::size_t>(pin.centre)].cast<double>()));
  info.count = static_cast<std::uint32_t>(pin.particles.size());
  if (pin.path) {
    info.target = to_wire(pin.path->move.target);
    info.behind = pin.path->behind;
  }
  return info;
}

const Pin* find_pin(const ServedWorld& world, PinId id) {
  const std::vector<Pin>& list = world.pins().list;
  const auto found =
      std::find_if(list.begin(), list.end(), [id](const Pin& pin) { return pin.id == id; });
  return found == list.end() ? nullptr : &*found;
}

proto::Result<PinMove> pin_move(const ServedWorld& world, const Pin& pin,
                                const proto::MovePin& command) {
  PinMove move{from_wire(command.position), command.speed, command.max_force};
  if (!command.seconds) return move;
  const double distance = remaining_distance(pin, world.state(), move.target);
  const double least = least_seconds(distance, world.tick_seconds());
  if (*command.seconds < least) {
    proto::Error error =
        proto::range_error("seconds", *command.seconds, {least, proto::kMoveSecondsRange.maximum});
    error.hint = "it has " + proto::number_text(distance) + " m to go";
    return error;
  }
  move.speed = speed_within(distance, *command.seconds, world.tick_seconds());
  return move;
}

proto::GrabInfo grab_info(const ServedWorld& world, const Grab<float>& grab, proto::ViewerId owner,
                          std::uint32_t drag) {
  proto::GrabInfo info;
  info.id = grab.id;
  info.viewer = owner;
  info.drag = drag;
  info.point = {static_cast<std::uint32_t>(grab.def.triangle), grab.def.barycentric};
  info.radius = grab.def.radius;
  info.stiffness = grab.def.stiffness;
  info.max_force = grab.def.max_force;
  info.held = to_wire(Vec3d(held_point(grab, world.state().x).cast<double>()));
  info.target = to_wire(Vec3d(grab.target.cast<double>()));
  info.mode = grab.def.mode == GrabMode::sling ? proto::DragMode::sling : proto::DragMode::live;
  info.force = to_wire(grab.told);
  return info;
}

proto::GrabSample grab_sample(const ServedWorld& world, const Grab<float>& grab,
                              proto::ViewerId owner) {
  return {grab.id, owner, to_wire_float(held_point(grab, world.state().x)),
          to_wire_float(grab.target), static_cast<float>(grab.told.norm())};
}

}  // namespace weft::server
