#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proto/error.h"
#include "proto/messages/hold_commands.h"
#include "proto/messages/motion_commands.h"
#include "proto/messages/people_commands.h"
#include "proto/messages/query.h"
#include "proto/messages/room_commands.h"
#include "proto/messages/rooms_commands.h"
#include "proto/messages/settings.h"
#include "proto/types.h"

// The commands of a client, each described once in messages/. README.md section 5 gives their
// meanings.

namespace weft::proto {

/// Forms of one `op` stand side by side, the one that reads it first: see parse_request.cpp.
using Command = std::variant<Hello, Pick, DragStart, DragMove, DragEnd, Pin, ReleasePin,
                             ReleaseParticle, ReleaseAll, Camera, Pause, Resume, Step, Reset, Save,
                             Restore, Speed, Move, MoveEnd, MovePin, StopPin, Gripper, Set, Advance,
                             Query, Hash, Ping, Load, View, CreateRoom, ListRooms, CloseRoom, Fork,
                             SetPolicy, Mute, GiveHand, Presence, Follow, Lead, Invite, Halt>;

/// The word in `op`, e.g. "drag".
inline const char* name_of(const Command& command) {
  return std::visit([](const auto& form) { return form.kOp; }, command);
}

/// What its sender needs for it.
inline Right right_to(const Command& command) {
  return std::visit([](const auto& form) { return right_to(form); }, command);
}

/// A command with the id that its sender gave, if any.
struct Request {
  std::optional<Id> id;
  Command command;
  bool operator==(const Request&) const = default;
};

/// Parses one text message. Never throws on its content. An error carries the command's id and name
/// as far as they could be read, and can be encoded as the answer.
Result<Request> parse_request(std::string_view text);

/// Finds the id that `parse_request` would answer with, without parsing the rest, for messages that
/// are refused unread. Takes any bytes, of any length and depth, in one pass and without
/// building a tree. Empty if the text is not an object, does not end with it, or has no id or two.
std::optional<Id> find_id(std::string_view text);

/// The token of a `hello`, also of one that `parse_request` refuses for another field; nothing if
/// it has none that can be read, or is no `hello`.
std::optional<std::string> find_token(std::string_view text);

/// The JSON text that parses to the same request; for logs and clients.
std::string encode_request(const Request& request);

}  // namespace weft::proto
