#pragma once

#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft {

/// Fixes a disc of the fabric where it is. A single particle is a point singularity whose strain
/// grows with resolution; a disc of fixed physical radius is not (PHYSICS.md section 2).
struct PinDef {
  Index particle = 0;  ///< centre of the disc
  double radius = 0;   ///< in the fabric [m], 0 to 100; 0 fixes the particle alone
};

/// Names a pin for its whole life; never used again for another.
using PinId = std::uint32_t;

struct Pin {
  PinId id = 0;
  PinDef def;
  std::vector<Index> particles;  ///< ascending
};

/// All pins of a cloth. Overlapping pins count: a particle is free when the last of its pins goes.
struct Pins {
  std::vector<Pin> list;       ///< in the order of their making
  std::vector<int> pin_count;  ///< for each particle
  PinId next_id = 1;
};

inline constexpr std::size_t kMostPins = 4096;

/// Sizes the counters for a cloth without pins.
template <class Real>
Pins make_pins(const ClothModel<Real>& model);

/// Pins a disc at its present position with velocity zero.
/// Throws DefinitionError if the particle or the radius is out of range or there are too many pins.
template <class Real>
PinId add_pin(const ClothModel<Real>& model, const PinDef& def, Pins& pins,
              ClothState<Real>& state);

/// Frees the particles of a pin that no other pin holds. False if there is no such pin.
template <class Real>
bool remove_pin(const ClothModel<Real>& model, PinId id, Pins& pins, ClothState<Real>& state);

}  // namespace weft
