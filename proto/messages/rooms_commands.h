#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"

// Commands about the rooms of a server, and what is told of a room.

namespace weft::proto {

/// The name of a room, in every command that has one.
inline constexpr Field kRoomName{"name",
                                 "lower-case letters, digits and hyphens",
                                 {1, static_cast<double>(kMostRoomNameBytes)},
                                 "characters",
                                 Form::room_name};

struct CreateRoom {
  std::string name;
  std::optional<std::string> scene;
  bool paused = false;
  bool operator==(const CreateRoom&) const = default;

  static constexpr const char* kOp = "create_room";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& create) {
    io.required(kRoomName, create.name);
    io.optional(Field{"scene",
                      "its name; by default that with which the server was started",
                      {1, kMostSceneBytes},
                      "characters",
                      Form::file_name},
                create.scene);
    io.flag(Field{"paused", "it begins paused"}, create.paused, false);
  }
};

struct ListRooms {
  bool operator==(const ListRooms&) const = default;
  static constexpr const char* kOp = "list_rooms";
  static constexpr Right kRight = Right::look;
  static void describe(auto&, auto&) {}
};

struct CloseRoom {
  std::string name;
  bool operator==(const CloseRoom&) const = default;

  static constexpr const char* kOp = "close_room";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& close) { io.required(kRoomName, close.name); }
};

/// A room like this one at this moment.
struct Fork {
  std::string name;
  std::optional<bool> paused;
  bool operator==(const Fork&) const = default;

  static constexpr const char* kOp = "fork";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& fork) {
    io.required(kRoomName, fork.name);
    io.optional(Field{"paused", "whether it begins so; by default as this room is"}, fork.paused);
  }
};

/// What is told of a room to viewers of any.
struct RoomInfo {
  std::string name, scene;
  std::uint32_t particles = 0, viewers = 0;
  std::uint64_t tick = 0;
  bool paused = false;
  double real_time_factor = 0;  ///< 0 while its time stands
  bool operator==(const RoomInfo&) const = default;

  static constexpr const char* kName = "RoomInfo";
  static void describe(auto& io, auto& room) {
    io.required(Field{"name", "of the address `/ws/name`"}, room.name);
    io.required(Field{"scene", "its name"}, room.scene);
    io.required(Field{"particles", "of all cloths"}, room.particles);
    io.required(Field{"viewers", "connected"}, room.viewers);
    io.required(Field{"tick", "of its present state"}, room.tick);
    io.required(Field{"paused", "whether it is"}, room.paused);
    io.required(Field{"real_time_factor", "simulated per real time; 0 while its time stands"},
                room.real_time_factor);
  }
};

}  // namespace weft::proto
