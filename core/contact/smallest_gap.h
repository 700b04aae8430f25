#pragma once

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/contact/constants.h"

// The gap that contact never gives up.

namespace weft {

/// Gap that every step leaves between features [m].
/// @param farthest  largest coordinate of any particle [m]
template <class Real>
Real smallest_gap_for(Real farthest) {
  assert(!(farthest < 0));
  const Real rounding = farthest * std::numeric_limits<Real>::epsilon();
  return std::max(static_cast<Real>(kSmallestGap), rounding * static_cast<Real>(kRoundings));
}

}  // namespace weft
