#pragma once

#include <cstdint>
#include <vector>

#include "core/attachments/pin_place.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft {

/// Names a pin for its whole life; never used again for another.
using PinId = std::uint32_t;

struct Pin {
  PinId id = 0;
  PinDef def;
  Index centre = 0;              ///< a particle in the middle of those held
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

/// Pins particles at their present positions with velocity zero.
/// Throws DefinitionError if the place does not exist or there are too many pins.
template <class Real>
PinId add_pin(const ClothModel<Real>& model, const PinDef& def, Pins& pins,
              ClothState<Real>& state);

/// Frees the particles of a pin that no other pin holds. False if there is no such pin.
template <class Real>
bool remove_pin(const ClothModel<Real>& model, PinId id, Pins& pins, ClothState<Real>& state);

}  // namespace weft
