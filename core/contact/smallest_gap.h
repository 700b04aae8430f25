#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/contact/constants.h"

// The gap that contact never gives up.

namespace weft {

/// Gap that every step leaves between features [m]: more where coordinates are large, and coarse.
/// @param points  of all particles, vectors or quads [m]
auto smallest_gap_at(const auto& points) {
  using Real = std::remove_cvref_t<decltype(points[0][0])>;
  Real farthest = 0;
  for (const auto& p : points) {
    for (int k = 0; k < 3; ++k) farthest = std::max(farthest, std::abs(p[k]));
  }
  const Real rounding = farthest * std::numeric_limits<Real>::epsilon();
  return std::max(static_cast<Real>(kSmallestGap), rounding * static_cast<Real>(kRoundings));
}

}  // namespace weft
