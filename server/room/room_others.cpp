// What a room's viewers ask of the server's other rooms.

#include <string>
#include <utility>

#include "server/room/refusals.h"
#include "server/room/room.h"

namespace weft::server {

using proto::Role;
using proto::ViewerId;

namespace {

proto::Error no_other_rooms() {
  return proto::make_error(proto::ErrorCode::not_supported, "this server has one room only");
}

/// Refuses what a viewer wants with another room than the one that it operates.
/// @param own  that one
proto::Error beyond_link(const char* what, const std::string& name, const std::string& own,
                         const char* hint) {
  proto::Error error = proto::make_error(proto::ErrorCode::not_allowed, what, hint);
  error.field = "name";
  error.value = proto::quoted_value(name);
  error.limit = proto::Limit{{}, {}, {}, {own}};
  return error;
}

}  // namespace

/// Whether what lets a viewer operate counts in this room alone.
bool Room::operates_here_alone(ViewerId viewer) const {
  return options_.has_tokens && viewers_.at(viewer).by_link;
}

/// The maker that the rooms of a viewer count for; empty if it operates the server. What a viewer
/// may in a copy, and gives on by its links, counts for the maker of that copy.
std::string Room::maker_of(ViewerId viewer) const {
  const Viewer& maker = viewers_.at(viewer);
  const bool counts = maker.info.role == Role::viewer || (maker.by_link && !maker.maker.empty());
  if (!counts) return {};
  return maker.maker.empty() ? "viewer " + std::to_string(viewer) : maker.maker;
}

/// The scene is built beside the one of this room, as by a `load`.
Room::Outcome Room::apply(ViewerId viewer, const proto::CreateRoom& command) {
  if (!options_.others) return no_other_rooms();
  if (operates_here_alone(viewer))
    return beyond_link("this link lets its viewer operate one room, and open none", command.name,
                       options_.name, "fork makes a copy of this room");
  if (command.scene) {
    if (auto error = check_scene_name(*command.scene, options_.scene_names))
      return *std::move(error);
  }
  auto name = options_.others->reserve(command.name, maker_of(viewer));
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

/// A viewer that may operate no other room gets a token for its copy.
Room::Outcome Room::apply(ViewerId viewer, const proto::Fork& command) {
  if (!options_.others) return no_other_rooms();
  auto name = options_.others->reserve(command.name, maker_of(viewer));
  if (!name) return std::move(name).error();
  const auto room = options_.others->open(*name, fork(), command.paused.value_or(paused()));
  if (!room) return room.error();
  proto::ForkReply reply{world_->tick(), *room, {}};
  const Viewer& maker = viewers_.at(viewer);
  if (options_.make_token && maker.by_token && (maker.by_link || maker.info.role == Role::viewer))
    reply.token = options_.make_token(
        {Role::operator_, HandRight::given, "", true, room->name, 0, maker_of(viewer)});
  return proto::Reply(std::move(reply));
}

Room::Outcome Room::apply(ViewerId, const proto::ListRooms&) {
  if (!options_.others) return no_other_rooms();
  return proto::Reply(options_.others->list());
}

Room::Outcome Room::apply(ViewerId viewer, const proto::CloseRoom& command) {
  if (!options_.others) return no_other_rooms();
  if (operates_here_alone(viewer) && command.name != options_.name)
    return beyond_link("this link lets its viewer operate one room, and close no other",
                       command.name, options_.name, "an operator of the server can close it");
  if (auto error = options_.others->close(command.name)) return *std::move(error);
  return proto::Reply(proto::CloseRoomReply{command.name});
}

}  // namespace weft::server
