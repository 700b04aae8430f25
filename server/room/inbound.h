#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "proto/messages/commands.h"
#include "server/room/rights.h"

namespace weft::server {

/// A viewer has connected and awaits its `welcome`.
struct Join {
  bool mesh_over_http = false;  ///< it fetches the binary mesh message itself
  Grant grant;                  ///< what it is let in with
  bool glances = false;         ///< sees the room from outside, and does not count as in it
};

/// A viewer has left.
struct Leave {};

/// A text message that needed nothing of the room: refused, or answered by the session. Only its
/// number matters, so that frames can report it as applied.
struct Noted {
  bool wants_frame = false;    ///< the viewer lacks part of the present state, and wants a frame
  std::optional<bool> forces;  ///< whether it wants them in its frames from now on
};

// A Grant by itself: a viewer that is there has told a token.

/// A room's input from its viewers, in order of arrival.
struct Inbound {
  proto::ViewerId viewer = 0;
  std::uint32_t number = 0;  ///< of the text message within its connection, from 1
  std::variant<Join, Leave, Noted, Grant, proto::Request> what;
};

}  // namespace weft::server
