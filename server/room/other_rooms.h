#pragma once

#include <memory>
#include <optional>
#include <string>

#include "proto/messages/replies.h"
#include "server/room/scene_build.h"

namespace weft::server {

/// A name that no other room may take while this exists.
class RoomName {
 public:
  virtual ~RoomName() = default;
  virtual const std::string& text() const = 0;
};

/// What a room asks of the server's rooms, itself among them, for its viewers. Every function
/// either does all or changes nothing and returns the error. Callable from each room's thread.
class OtherRooms {
 public:
  virtual ~OtherRooms() = default;

  virtual proto::ListRoomsReply list() const = 0;

  /// Keeps a name for a room that is being built.
  /// @param maker  the viewer or token that the room counts for; empty: none, it has no bound
  virtual proto::Result<std::shared_ptr<RoomName>> reserve(const std::string& name,
                                                           const std::string& maker) = 0;
  /// Opens the room of a reserved name.
  virtual proto::Result<proto::RoomInfo> open(const std::shared_ptr<RoomName>& name,
                                              BuiltScene&& scene, bool paused) = 0;
  /// Closes a room and its viewers' connections, soon; this one too.
  /// @returns nothing if it does
  virtual std::optional<proto::Error> close(const std::string& name) = 0;

  /// Whether another room than this has viewers.
  virtual bool others_have_viewers(const std::string& name) const = 0;

  /// Whether ticks of a room may cost so much, beside those of all the others.
  /// @returns nothing if they may; then that counts from now on
  virtual std::optional<proto::Error> admit(const std::string& room, const TickCost& cost) = 0;
};

}  // namespace weft::server
