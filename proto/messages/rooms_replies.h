#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/field.h"
#include "proto/messages/rooms_commands.h"

// Answers to commands about the rooms of a server.

namespace weft::proto {

/// The command's place in the order.
inline constexpr Field kReplyTick{"tick", "the command's place in the order: after it"};

struct CreateRoomReply {
  RoomInfo room;
  static constexpr const char* kOp = "create_room";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"room", "as it begins"}, reply.room);
  }
};

struct ListRoomsReply {
  std::vector<RoomInfo> rooms;
  std::uint32_t most = 0;
  static constexpr const char* kOp = "list_rooms";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"rooms", "by name"}, reply.rooms);
    io.required(Field{"most", "rooms that this server has at a time"}, reply.most);
  }
};

struct CloseRoomReply {
  std::string name;
  static constexpr const char* kOp = "close_room";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"name", "of the room that is gone"}, reply.name);
  }
};

struct ForkReply {
  std::uint64_t tick = 0;
  RoomInfo room;
  std::optional<std::string> token;
  static constexpr const char* kOp = "fork";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"room", "as it begins"}, reply.room);
    io.optional(Field{"token", "with which its maker, who comes by a token, operates the copy"},
                reply.token);
  }
};

}  // namespace weft::proto
