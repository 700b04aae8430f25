#pragma once

#include <functional>
#include <string>

#include "tests/bench/cases.h"
#include "tests/bench/measures.h"

namespace weft::bench {

/// The converged run that the others are measured against, in double precision.
struct Reference {
  Path path;
  std::string how;         ///< integrator and substeps
  double self_error = 0;   ///< what its last halving changed: position, relative
  double cpu_seconds = 0;  ///< all runs that it took
  double growth = 0;       ///< of a perturbation of 1 um, over the samples that are compared
  double mean_floor = 0;   ///< by how much the perturbed run's mean shape differs, relative
  std::size_t first = 0, last = 0;  ///< samples that are compared
  bool shortened = false;           ///< the perturbation grew too much later on
  std::string missing;              ///< why there is none; empty if there is
};

inline constexpr double kMostGrowth = 10;      ///< of a perturbation, for a comparison to count
inline constexpr double kPerturbation = 1e-6;  ///< rms [m]
inline constexpr double kSelfErrorWanted = 1e-8;

/// Halves the substeps of a reference until that changes less than kSelfErrorWanted or the budget
/// is spent, and follows a perturbed start beside it.
Reference make_reference(const BenchScene& scene, const WorldDef& def);

/// Runs a definition with the classical Runge-Kutta method of fourth order: springs, bending,
/// gravity and drag, in double. The forces are core's.
/// @param substeps  a tick
/// @param offset    added to the start of each particle that is not pinned [m]
Path run_runge_kutta(const WorldDef& def, int ticks, int sample_every, int substeps,
                     const Vec3Array<double>& offset);

/// Runs World<double> with at least so many substeps.
Path run_world(WorldDef def, int ticks, int sample_every, int substeps,
               const Vec3Array<double>& offset);

}  // namespace weft::bench
