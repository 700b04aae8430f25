#pragma once

#include <string>

#include "tests/bench/cases.h"
#include "tests/bench/integrators.h"

namespace weft::bench {

/// The converged run that the others are measured against, in double precision.
struct Reference {
  Path path;
  std::string how;         ///< integrator and substeps
  double self_error = 0;   ///< what its last refinement changed: position, relative
  double cpu_seconds = 0;  ///< all runs that it took
  Compared compared;       ///< each quantity until noise has changed it too much
  ErrorVector noise;       ///< what a start perturbed by 1 um changes of what is compared
  std::string missing;     ///< why there is none; empty if there is
};

/// A quantity is compared until a start perturbed by 1 um changes it by more than a third of the
/// smallest error that is asked for. Strain has more noise than the others: 1 um is much of a cell.
inline constexpr double kMostNoise = 1e-3 / 3, kMostNoiseOfStrain = 1e-2 / 3;
inline constexpr double kPerturbation = 1e-6;  ///< rms [m]
inline constexpr double kSelfErrorWanted = 1e-8;

/// Which method a reference is made with.
enum class ReferenceMethod {
  cheapest_that_fits,  ///< Runge-Kutta within the budget, or else extrapolation
  runge_kutta,         ///< fourth order, substeps doubled
  extrapolation,       ///< leapfrog at 1 to 3 times the stable substeps, to the limit
};

/// Refines a reference until that changes less than kSelfErrorWanted or the budget is spent, and
/// follows a perturbed start beside it. Scenes with contact or air have World<double> with substeps
/// doubled, whatever the method: they are not smooth.
Reference make_reference(const BenchScene& scene, const WorldDef& scene_def,
                         ReferenceMethod wanted = ReferenceMethod::cheapest_that_fits);

}  // namespace weft::bench
