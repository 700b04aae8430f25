#pragma once

#include "core/cloth/fabric.h"
#include "core/forces/air/environment.h"
#include "core/types.h"

namespace weft {

// All that the physics asks of the air. Something new that blows is a field of EnvironmentDef and a
// change in these functions; substeps, sleep, solvers and hash follow.

/// Whether nothing blows and still air was not asked for: then the air need not be evaluated.
bool is_calm(const EnvironmentDef& environment);

/// Whether the velocity of the air at a place changes with time though nothing is commanded.
bool changes_by_itself(const EnvironmentDef& environment);

/// Bound of the speed of the air at any place and time [m/s].
double fastest_air(const EnvironmentDef& environment);

/// Bound of the rate at which the air takes velocity from cloth [1/s]: the derivative of air_force
/// by the velocity for a unit of mass, (rho C_n |u| + c_t) / sigma, with |u| at most the speed of
/// the air and of the cloth together; 0 where it is calm.
/// @param fastest_particle  [m/s]
double air_damping_rate(const EnvironmentDef& environment, const FabricDef& fabric,
                        double fastest_particle);

/// Velocity of the air at each particle [m/s]: the mean wind plus gusts, smooth noise in space that
/// the mean wind carries along (frozen turbulence, Taylor 1938), so that it is smooth in time too,
/// plus the jets of the fans.
///
/// @param time  simulated time [s]
/// @param x     positions [m]
/// @param air   result, already of the size of x
/// @returns how many times a fan's jet was evaluated
template <class Real>
std::size_t sample_air(const EnvironmentDef& environment, double time, const Vec3Array<Real>& x,
                       Vec3Array<Real>& air);

}  // namespace weft
