#pragma once

#include <span>

#include "core/types.h"

// An origin near places, for computing with their differences from it.

namespace weft {

/// A place near some others, from which each is seen exactly: place - origin is not rounded, and
/// origin + (place - origin) is the place. Between 0 and twice the nearest coordinate, in steps of
/// the farthest one, all differences are representable (after Sterbenz 1974). Zero along an axis on
/// both sides of whose zero they lie, or which has one that is not finite.
/// @param places  at least one [m]
template <class Real>
Vec3<Real> exact_origin(std::span<const Vec3<Real>> places);

}  // namespace weft
