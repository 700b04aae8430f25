#pragma once

#include "core/solver/verlet_tick.h"

namespace weft {

// Substeps of grids in their own arrays, forces, kick and drift in one pass.

/// Springs, bending, kick and drift of a grid in one pass, all booked under stretch.
/// @param drift  length of the drift [s]; 0: none
/// @returns work of the external forces over the drift [J]
template <class Real>
double advance_grid(Tick<Real>& tick, std::size_t part, const Kick<Real>& kick, Real drift);

/// Loads the grids of all parts whose state may have changed.
template <class Real>
void load_grids(Tick<Real>& tick);

/// All substeps of a grid that nobody else touches: the particles stay in its own arrays.
/// @returns work of the air [J]
template <class Real>
double advance_alone(Tick<Real>& tick, std::size_t part, const Kicks<Real>& kicks, int substeps);

/// What a tick knows of when it may go on without contact.
struct NextCalm {
  int substep = 0;  ///< not before this one: it needs contact
};

/// Goes on without calls of contact while nothing can meet anything: all stay near straight paths
/// that the guard of the cloths knows to be clear (CalmPaths), and none goes as far as an object
/// may be. Leaves the state as contact would, bit for bit.
/// @param substeps  of the tick
/// @param s         substep to begin with, before its kick; moved on to the first that is not done
/// @returns work of the air [J]
template <class Real>
double advance_calm(Tick<Real>& tick, const Kicks<Real>& kicks, int substeps, int& s,
                    NextCalm& next);

}  // namespace weft
