#pragma once

#include "core/forces/air/environment.h"
#include "core/types.h"

namespace weft {

/// Velocity of the air at each particle [m/s]: the mean wind plus gusts, smooth noise in space that
/// the mean wind carries along (frozen turbulence, Taylor 1938), so that it is smooth in time too,
/// plus the jets of the fans.
///
/// @param time  simulated time [s]
/// @param x     positions [m]
/// @param wind  result, already of the size of x
/// @returns how many times a fan's jet was evaluated
template <class Real>
std::size_t sample_wind(const EnvironmentDef& environment, double time, const Vec3Array<Real>& x,
                        Vec3Array<Real>& wind);

}  // namespace weft
