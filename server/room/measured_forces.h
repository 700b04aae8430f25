#pragma once

#include <cstdint>

#include "server/constants.h"

namespace weft::server {

/// Whether, and for whom, a world measures contacts and reactions.
struct MeasuredForces {
  bool measured = false;          ///< by the world, in the coming ticks
  bool in_frames = false;         ///< a viewer wants them in its frames
  std::uint64_t asked_until = 0;  ///< tick up to which the last query wants them measured

  /// Not after a reset that lies behind the query.
  bool asked_at(std::uint64_t tick) const {
    return tick < asked_until && asked_until <= tick + kForcesAskedTicks;
  }
};

}  // namespace weft::server
