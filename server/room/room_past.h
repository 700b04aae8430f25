#pragma once

#include "server/room/command_log.h"
#include "server/room/guarantee_watch.h"
#include "server/room/room_clock.h"

namespace weft::server {

/// What a fork goes on from beside its world, as it was in the room that it was forked from.
struct RoomPast {
  RoomClock time;
  CommandLog log;
  GuaranteeWatch guarantee;
  bool measures_forces = false;  ///< whether its world does
};

}  // namespace weft::server
