#pragma once

#include "core/world/world.h"

// The weight of all cloths of a world.

namespace weft::test {

inline constexpr double kGravity = 9.81;  ///< that these tests give their worlds [m/s^2]

/// @return under kGravity [N]
inline double weight_of(const World<float>& world) {
  double mass = 0;
  for (const float m : world.model().mass) mass += static_cast<double>(m);
  return mass * kGravity;
}

}  // namespace weft::test
