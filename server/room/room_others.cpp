// What a room's viewers ask of the server's other rooms.

#include <string>
#include <utility>

#include "server/room/refusals.h"
#include "server/room/room.h"

namespace weft::server {
namespace {

proto::Error no_other_rooms() {
  return proto::make_error(proto::ErrorCode::not_supported, "this server has one room only");
}

}  // namespace

/// The scene is built beside the one of this room, as by a `load`.
Room::Outcome Room::apply(proto::ViewerId viewer, const proto::CreateRoom& command) {
  if (!options_.others) return no_other_rooms();
  if (command.scene) {
    if (auto error = check_scene_name(*command.scene, options_.scene_names))
      return *std::move(error);
  }
  auto name = options_.others->reserve(command.name);
  if (!name) return std::move(name).error();
  start_build(viewer, [this, scene = command.scene] {
    return scene ? definition_of(*scene) : first_scene(options_, scenes_);
  });
  order_.building->name = *std::move(name);
  return proto::Reply(proto::CreateRoomReply{});
}

/// Throws what building threw.
void Room::open_room(const Building& done) {
  const auto& command = std::get<proto::CreateRoom>(done.request.command);
  const auto room = options_.others->open(done.name, done.build->take(), command.paused);
  if (!room) return refuse(done.viewer, done.request, room.error());
  answer(done.viewer, done.request.id, proto::CreateRoomReply{*room});
}

/// This room at this moment. Hands of viewers let go in it, because they hold here.
BuiltScene Room::fork() const {
  BuiltScene copy;
  copy.world = world_->fork();
  copy.mesh = mesh_;
  copy.mesh_bytes = mesh_bytes_;
  copy.order = coding_order_;
  copy.notices = scene_notices_;
  copy.past = RoomPast{time_, order_.log.newest(kForkedLog), guarantee_, forces_};
  for (const Hand& hand : holds_.hands()) {
    copy.world->release(hand.grab);
    copy.past->log.add(world_->tick(), hand.viewer, CommandOrigin::leave,
                       proto::DragEnd{hand.drag});
  }
  return copy;
}

Room::Outcome Room::apply(proto::ViewerId, const proto::Fork& command) {
  if (!options_.others) return no_other_rooms();
  auto name = options_.others->reserve(command.name);
  if (!name) return std::move(name).error();
  const auto room = options_.others->open(*name, fork(), command.paused.value_or(paused()));
  if (!room) return room.error();
  return proto::Reply(proto::ForkReply{world_->tick(), *room});
}

Room::Outcome Room::apply(proto::ViewerId, const proto::ListRooms&) {
  if (!options_.others) return no_other_rooms();
  return proto::Reply(options_.others->list());
}

Room::Outcome Room::apply(proto::ViewerId, const proto::CloseRoom& command) {
  if (!options_.others) return no_other_rooms();
  if (auto error = options_.others->close(command.name)) return *std::move(error);
  return proto::Reply(proto::CloseRoomReply{command.name});
}

}  // namespace weft::server
