#pragma once

#include "core/forces/grid_pass.h"

namespace weft {

// The vector code behind GridPass, chosen for the processor when the program runs.
// `force` takes three numbers a particle and is overwritten.

/// Takes three numbers a particle apart into arrays of components in the layout of the view.
/// @param to  at (row 0, column 0)
void grid_take_apart(const GridView<float>& grid, const float* from, float* const (&to)[3]);
void grid_take_apart(const GridView<double>& grid, const double* from, double* const (&to)[3]);

void grid_internal_forces(const GridView<float>& grid, float* force);
void grid_internal_forces(const GridView<double>& grid, double* force);

/// @param pressure  1/2 rho C_n [kg/m^3]
/// @param skin      c_t [kg/(m^2 s)]
void grid_air_forces(const GridView<float>& grid, float pressure, float skin, float* force);
void grid_air_forces(const GridView<double>& grid, double pressure, double skin, double* force);

}  // namespace weft
