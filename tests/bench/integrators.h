#pragma once

#include <vector>

#include "core/world/world_def.h"
#include "tests/bench/measures.h"

namespace weft::bench {

/// Runs a definition with the classical Runge-Kutta method of fourth order: springs, bending,
/// gravity and damping, in double. The forces are core's, the integrator is not.
/// @param substeps  a tick
/// @param offset    added to the start of each particle that is not pinned [m]; may be empty
Path run_runge_kutta(const WorldDef& def, int ticks, int sample_every, int substeps,
                     const Vec3Array<double>& offset);

/// Runs World<double> with at least so many substeps.
Path run_world(WorldDef def, int ticks, int sample_every, int substeps,
               const Vec3Array<double>& offset);

/// A run with so many substeps a tick.
struct Level {
  int substeps = 0;
  Path path;
};

/// Richardson's limit for an infinite number of substeps of a method whose error has even powers of
/// the step alone, as leapfrog without dashpots: the polynomial in h^2 through all levels, at 0.
/// @param first  level to begin with; all have different substeps
Path extrapolate(const std::vector<Level>& levels, std::size_t first);

}  // namespace weft::bench
