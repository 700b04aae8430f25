#pragma once

#include "server/room/command_log.h"
#include "server/room/guarantee_watch.h"
#include "server/room/measured_forces.h"
#include "server/room/room_clock.h"

namespace weft::server {

/// What a fork goes on from beside its world, as it was in the room that it was forked from.
struct RoomPast {
  RoomClock time;
  CommandLog log;
  GuaranteeWatch<float> guarantee;
  MeasuredForces forces;
};

}  // namespace weft::server
