#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "proto/commands.h"

namespace weft::server {

/// A viewer has connected and waits for its `welcome`.
struct Join {
  bool mesh_over_http = false;  ///< it fetches the binary mesh message itself
};

/// A viewer is gone.
struct Leave {};

/// A text message that needed nothing of the room: refused, or answered by the session. Only its
/// number matters, so that frames can tell that it is behind them.
struct Noted {
  bool wants_frame = false;    ///< the viewer lacks what a frame would tell it, and wants one
  std::optional<bool> forces;  ///< it wants them in its frames from now on, or no longer
};

/// What reaches a room from its viewers, in the order of arrival.
struct Inbound {
  proto::ViewerId viewer = 0;
  std::uint32_t number = 0;  ///< of the text message within its connection, from 1
  std::variant<Join, Leave, Noted, proto::Request> what;
};

}  // namespace weft::server
