#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "proto/messages/right.h"
#include "proto/types.h"
#include "server/message.h"

namespace weft::server {

/// Takes a room's messages and frames. The room calls it from the simulation thread.
class RoomOutput {
 public:
  virtual ~RoomOutput() = default;

  /// To one viewer, in order with its other messages; does nothing if the viewer has left.
  virtual void send(proto::ViewerId viewer, Message message) = 0;

  /// The same for several, which go out together.
  virtual void send(proto::ViewerId viewer, std::vector<Message> messages) {
    for (Message& message : messages) send(viewer, std::move(message));
  }

  /// Frames a second that the room makes; changed by `load` and `speed`.
  virtual void set_frame_rate(double frame_rate) = 0;

  /// To all welcomed viewers.
  virtual void broadcast(Message message) = 0;

  /// Makes a binary mesh message available under its content hash. Frames offered earlier belong to
  /// an older mesh and are no longer sent.
  virtual void offer_mesh(std::uint64_t hash, SharedBytes bytes, PackedMesh packed) = 0;

  /// What the viewer may do from now on.
  virtual void set_role(proto::ViewerId, proto::Role) {}

  /// The viewer glances at the room: of what is told to all it gets the state alone, and seldom.
  virtual void set_glance(proto::ViewerId) {}

  /// Tells that the viewer has been sent everything that precedes frames.
  virtual void welcome_done(proto::ViewerId viewer) = 0;

  /// Whether any viewer takes frames.
  virtual bool wants_frames() const = 0;

  /// Whether any viewer takes contacts and reactions with its frames.
  virtual bool wants_forces() const = 0;

  /// The newest frame, for all viewers.
  virtual void offer_frame(Frame frame) = 0;

  /// The room is gone: ends the connections of all its viewers. Callable from any thread.
  virtual void close() = 0;
};

}  // namespace weft::server
