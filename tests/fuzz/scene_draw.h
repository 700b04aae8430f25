#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/dice.h"

namespace weft::fuzz {

/// What commands need to know of a scene to name what is there.
struct SceneFacts {
  int particles = 1;  ///< about; of meshes and cut grids a guess
  std::vector<std::string> cloths, colliders, grippers;
  std::size_t pins = 0;
};

/// A random scene as JSON text, with all fields of the scene format at any value of their ranges,
/// nearly always one that the reader takes.
/// @param most_side  particles along a side of a cloth, at most
std::string draw_scene(const Dice& dice, int most_side, SceneFacts& facts);

}  // namespace weft::fuzz
