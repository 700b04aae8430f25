#pragma once

#include "core/cloth/fabric.h"
#include "core/forces/air/environment.h"
#include "core/types.h"

namespace weft {

// The interface of the air to the rest of the physics. A new kind of wind is a field of
// EnvironmentDef and a change in these functions; substeps, sleep, solvers and hash follow.

/// Whether the air is at rest and still air was not requested: it then need not be evaluated.
bool is_calm(const EnvironmentDef& environment);

/// Whether the velocity of the air at a point changes with time without commands.
bool changes_by_itself(const EnvironmentDef& environment);

/// Bound of the speed of the air at any point and time [m/s].
double fastest_air(const EnvironmentDef& environment);

/// Bound of the rate at which the air damps the velocity of cloth [1/s]: the derivative of
/// air_force by the velocity per unit of area, rho C_n |u| + c_t, with |u| bounded by the sum of
/// the speeds of air and cloth, times the area per mass; 0 in calm air.
/// @param area_per_mass     see bound_damped_area [m^2/kg]
/// @param fastest_particle  [m/s]
double air_damping_rate(const EnvironmentDef& environment, const FabricDef& fabric,
                        double area_per_mass, double fastest_particle);

/// Velocity of the air at each particle [m/s]: the mean wind plus gusts, smooth spatial noise that
/// the mean wind carries along (frozen turbulence, Taylor 1938), so that it is smooth in time too,
/// plus the jets of the fans.
///
/// @param time   simulated time [s]
/// @param ahead  by how much the gusts are ahead of where this wind would have carried them in that
///               time, because it was another one before [m]
/// @param x      positions [m]
/// @param air    result, with the size of x
/// @returns number of evaluations of a fan's jet
template <class Real>
std::size_t sample_air(const EnvironmentDef& environment, double time, const Vec3d& ahead,
                       const Vec3Array<Real>& x, Vec3Array<Real>& air);

}  // namespace weft
