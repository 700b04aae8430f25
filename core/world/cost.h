#pragma once

#include <string>

#include "core/error.h"
#include "core/world/world_def.h"

// Estimates the cost of a scene before it is accepted. Only the solver's work on springs can be
// estimated in advance; the cost of contact depends on what meets, and the world's owner bounds the
// time of a tick instead.

namespace weft {

/// A definition that exceeds a cost limit.
struct CostError : DefinitionError {
  using DefinitionError::DefinitionError;
};

/// Estimated cost of a tick without contact.
struct TickCost {
  double particles = 0;
  double substeps = 0;
  double sweeps = 1;     ///< over all springs in a substep, or an equivalent number
  double damping = 0;    ///< updates of each particle by solved dashpots of bending, a tick
  double tick_rate = 0;  ///< [1/s]

  double updates() const { return particles * (substeps * sweeps + damping); }
};

/// Throws CostError if a scene has too many particles or triangles, before anything is built.
void check_size(const WorldDef& def);

/// Sweeps over all springs in a substep of the given solver.
double sweeps_of(const WorldDef& def, SolverKind kind);

/// Throws CostError if the estimate exceeds kMostSubsteps, kMostTickUpdates or
/// kMostUpdatesPerSecond.
/// @param field  named in the error, e.g. "set.wind"
/// @param value  of that field
void check_cost(const TickCost& cost, const std::string& field, const std::string& value);

}  // namespace weft
