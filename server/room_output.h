#pragma once

#include <cstdint>

#include "proto/types.h"
#include "server/message.h"

namespace weft::server {

/// Where a room's words and frames go. The room calls it from the simulation thread.
class RoomOutput {
 public:
  virtual ~RoomOutput() = default;

  /// To one viewer, in order with everything else it is sent; nothing happens if it is gone.
  virtual void send(proto::ViewerId viewer, Message message) = 0;

  /// Frames a second that the room makes; changes by `load` and `speed`.
  virtual void set_frame_rate(double frame_rate) = 0;

  /// To all viewers that the room has welcomed.
  virtual void broadcast(Message message) = 0;

  /// A binary mesh message that becomes available under its content hash. Frames offered before it
  /// belong to an older mesh and are no longer sent.
  virtual void offer_mesh(std::uint64_t hash, SharedBytes bytes) = 0;

  /// Tells that the viewer has been sent all that comes before frames.
  virtual void welcome_done(proto::ViewerId viewer) = 0;

  /// Whether anybody wants to see a frame at all.
  virtual bool wants_frames() const = 0;

  /// Whether somebody wants to see contacts and reactions in frames.
  virtual bool wants_forces() const = 0;

  /// The newest frame, for everybody.
  virtual void offer_frame(Frame frame) = 0;
};

}  // namespace weft::server
