#pragma once

#include <nlohmann/json.hpp>

#include "tests/fuzz/dice.h"

namespace weft::fuzz {

/// Changes a scene that keeps to the ranges of all fields until it keeps to what only several
/// fields together can tell as well: directions at right angles, times that grow, no jumps.
void make_legal(const Dice& dice, nlohmann::ordered_json& scene);

/// Particles of all its cloths; of a mesh a guess.
int particles_of(const nlohmann::ordered_json& scene);

}  // namespace weft::fuzz
