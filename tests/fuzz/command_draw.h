#pragma once

#include "proto/messages/commands.h"
#include "tests/fuzz/dice.h"
#include "tests/fuzz/scene_draw.h"

namespace weft::fuzz {

/// What commands need to know of the room besides the scene.
struct RoomFacts {
  SceneFacts scene;
  std::uint32_t pins_made = 0;  ///< by commands, at most
  proto::ViewerId most_viewers = 3;
};

/// A random command of any kind but `load`, within all ranges of the wire.
proto::Command draw_command(const Dice& dice, const RoomFacts& facts);

}  // namespace weft::fuzz
