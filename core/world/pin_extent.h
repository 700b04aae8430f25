#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/world/world.h"

// What the pins of a scene hold of the fabric, and what was asked for.

namespace weft {

/// Difference from what was asked for that is reported [1].
inline constexpr double kToldDifference = 0.01;

/// A pin that holds more or less of the fabric than was asked for, because it holds whole
/// particles.
struct PinExtent {
  std::size_t pin = 0;                   ///< its place in the scene's list
  double asked = 0, held = 0;            ///< width of a strip, radius of a disc [m]
  double asked_area = 0, held_area = 0;  ///< of a disc [m^2]; 0: a strip
  bool all = false;                      ///< it holds all of its cloth
  bool clamps = false;                   ///< the fabric bends as if clamped at its border
};

/// The pins of a world at its start whose width, radius or area differs from what was asked for by
/// more than kToldDifference. Single particles and strips of no width ask for none. A disc's area
/// is that within the fabric; the area that it holds follows from its particles' mass.
template <class Real>
std::vector<PinExtent> coarse_pins(const World<Real>& world);

/// One sentence about them for people, which names the first kNamedPins; they are not empty.
std::string describe(const std::vector<PinExtent>& pins);

inline constexpr std::size_t kNamedPins = 4;

}  // namespace weft
