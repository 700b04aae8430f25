#pragma once

#include <string>
#include <vector>

#include "core/world/world.h"

namespace weft::bench {

// Cotton of one square metre with a thickness of a part of its edge length, in states in which
// contact costs differently much. All are made the same on each machine.

/// A sheet of n x n particles that falls upright on the ground, where it crumples; damping 5/s.
/// @param thickness  in parts of the edge length
WorldDef falling_sheet(int n, double thickness);

/// A sheet of n x n particles that hangs by its upper edge, with and without contact with itself.
WorldDef hanging_sheet(int n, bool self_contact);

/// A state to measure a few ticks of.
struct ContactState {
  std::string name, how;  ///< how: in words, for the report
  WorldDef def;
  Vec3Array<float> x, v;  ///< of the particles [m], [m/s]
};

/// The states flat, wrinkled, folded and crumpled of n x n particles, thickness a quarter.
/// @param n  8 m + 1; where it is more than 65 the crumple is one of 65 x 65 of the same thickness,
///           made finer without changing its shape
std::vector<ContactState> contact_states(int n);

/// Puts a world into a state.
void take_state(const ContactState& state, World<float>& world);

}  // namespace weft::bench
