#pragma once

#include "core/forces/force_pass.h"
#include "core/forces/grid_view.h"

namespace weft {

// The vector code behind GridPass, selected for the processor at run time. Arrays of the whole
// model have three numbers per particle.

/// Takes three numbers a particle apart into three lines of every row.
/// @param to     at (0, 0)
/// @param pitch  from row to row, in numbers
template <class Real>
void grid_take_apart(const GridView<Real>& grid, const Real* from, Real* to, std::ptrdiff_t pitch);

/// Puts them together again.
template <class Real>
void grid_put_together(const GridView<Real>& grid, const Real* from, std::ptrdiff_t pitch,
                       Real* to);

/// Forces of springs, dashpots and bending into `external`.
template <class Real>
void grid_internal_forces(const GridView<Real>& grid);

/// Energies of springs and bending and the largest strain.
template <class Real>
ElasticEnergy grid_elastic_energy(const GridView<Real>& grid);

/// Clears the scratch, and brings there what the two rows above carry to row `first`.
template <class Real>
void grid_begin_rows(const GridView<Real>& grid, std::ptrdiff_t first);

/// All forces, kick and drift of rows from `first` to before `last` in one pass, after
/// `grid_begin_rows` or the rows above. Adds powers of the external forces [W] by column to their
/// line of scratch.
template <class Real>
void grid_advance(const GridView<Real>& grid, const GridStep<Real>& step, std::ptrdiff_t first,
                  std::ptrdiff_t last);

/// Splits places of the model into three lines a row, as seen from the origin.
template <class Real>
void grid_take_places(const GridView<Real>& grid, const Real* from, Real* to, std::ptrdiff_t pitch);

/// Stores the places into the model's [m].
template <class Real>
void grid_put_places(const GridView<Real>& grid, Real* to);

/// Takes over places that something else has moved in the model, and velocities.
template <class Real>
void grid_take_motion(const GridView<Real>& grid, const Real* x, const Real* v);

/// The same, and a drift, which is stored into the model. Adds powers of the external forces, if
/// there are any, as above.
template <class Real>
void grid_drift(const GridView<Real>& grid, Real dt, bool has_external, const Real* v, Real* x);

/// Forces of the air into `external`.
/// @param pressure  1/2 rho C_n [kg/m^3]
/// @param skin      c_t [kg/(m^2 s)]
template <class Real>
void grid_air_forces(const GridView<Real>& grid, Real pressure, Real skin);

/// The box around all displacements from straight paths [m].
/// @param paths  six lines a row: where they are at time 0 [m], and velocities [m/s]
/// @param box    receives its corners
template <class Real>
void grid_box_paths(const GridView<Real>& grid, const Real* paths, Real time, Real* box);

}  // namespace weft
