#pragma once

#include "tests/fuzz/dice.h"
#include "tests/fuzz/script.h"

namespace weft::fuzz {

/// The size of what is drawn.
struct ScriptSize {
  int most_side = 24;   ///< particles along a side of a cloth
  int most_steps = 24;  ///< commands, and bursts of ticks between them
  int most_ticks = 12;  ///< of one burst
  bool within = true;   ///< some of what viewers do comes while a tick runs
};

/// A random scene, and random legal commands of every kind between ticks. Depends on its arguments
/// alone. What a command names (pins, drags, particles) is mostly there.
Script draw_script(const Dice& dice, const ScriptSize& size);

}  // namespace weft::fuzz
