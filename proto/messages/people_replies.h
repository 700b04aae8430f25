#pragma once

#include <cstdint>
#include <string>

#include "proto/messages/right.h"
#include "proto/messages/rooms_replies.h"
#include "proto/types.h"

// Answers about a viewer, and for those whom it invites.

namespace weft::proto {

struct HelloReply {
  ViewerId viewer = 0;
  std::string name, color;
  Role role = Role::viewer;
  static constexpr const char* kOp = "hello";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"viewer", "its number"}, reply.viewer);
    io.required(Field{"name", "in force"}, reply.name);
    io.required(Field{"color", "in force"}, reply.color);
    io.required(Field{"role", "what it may do"}, reply.role);
  }
};

struct InviteReply {
  std::uint64_t tick = 0;
  std::string token;
  static constexpr const char* kOp = "invite";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"token", "for a link's fragment, `#token=…`"}, reply.token);
  }
};

}  // namespace weft::proto
