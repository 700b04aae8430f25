#pragma once

#include "core/solver/verlet_tick.h"

namespace weft {

// Substeps of grids in their own arrays, with forces, kick and drift in one pass.

/// Springs, bending, kick and drift of a grid in one pass, all accounted to stretch.
/// @param drift  length of the drift [s]; 0: none
/// @returns work of the external forces over the drift [J]
template <class Real>
double advance_grid(Tick<Real>& tick, std::size_t part, const Kick<Real>& kick, Real drift);

/// Loads the grids of all parts whose state may have changed, at the start of a tick.
template <class Real>
void load_grids(Tick<Real>& tick);

/// Lets grids take over velocities.
/// @param places_too  and what something else has moved
template <class Real>
void take_over_grids(Tick<Real>& tick, bool places_too);

/// Drifts cloths that are no grids, in the model's arrays.
template <class Real>
void drift_meshes(Tick<Real>& tick);

/// All substeps of a grid that nothing else touches: the particles stay in its own arrays.
/// @returns work of the air [J]
template <class Real>
double advance_alone(Tick<Real>& tick, std::size_t part, const Kicks<Real>& kicks, int substeps);

/// When a tick may continue without contact.
struct NextCalm {
  int substep = 0;  ///< not before this one, which needs contact
};

/// Steps without calls of contact while no particle can meet anything: all stay near straight paths
/// that the guard has found to be clear (CalmPaths), and no particle moves as far as the nearest
/// object. Leaves the same state as contact would, bit for bit.
/// @param substeps  of the call
/// @param s         first substep, before its kick; advanced to the first that is not done
/// @returns work of the air [J]
template <class Real>
double advance_calm(Tick<Real>& tick, const Kicks<Real>& kicks, int substeps, int& s,
                    NextCalm& next);

}  // namespace weft
