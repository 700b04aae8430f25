#pragma once

#include <cstddef>

#include "core/executor.h"

namespace weft {

// Vector code of contact over all particles, selected for the processor at run time. Each particle
// is computed separately, so the selection does not change a bit.

/// Present positions, origins and allowed displacements of particles; three numbers per particle
/// unless stated otherwise.
template <class Real>
struct TravelPass {
  std::size_t particles = 0;
  const Real* x = nullptr;      ///< [m]
  const Real* v = nullptr;      ///< [m/s]
  Real dt = 0;                  ///< of the coming drift [s]
  const Real* from = nullptr;   ///< origin of the displacement [m]
  const Real* reach = nullptr;  ///< allowed displacement, one number per particle [m]
  Real less = 0;                ///< what objects have taken from it [m]
  Real* travel2 = nullptr;  ///< squared displacement, the longer of now and after the drift [m^2]
};

/// Measures the displacement of every particle.
/// @param executor  distributes many particles to its threads; may be null
/// @return whether all are within what is left of their reach, now and after the drift; false if
///         any number is NaN
template <class Real>
bool run_travel(const TravelPass<Real>& pass, Executor* executor);

/// Positions before a drift, and the straight paths for comparison; three numbers per particle.
template <class Real>
struct PathPass {
  std::size_t particles = 0;
  const Real* x = nullptr;         ///< [m]
  const Real* v = nullptr;         ///< [m/s]
  Real dt = 0;                     ///< of the drift [s]
  const Real* base = nullptr;      ///< positions on the paths at time 0 [m]
  const Real* velocity = nullptr;  ///< along the paths [m/s]
  Real time = 0;                   ///< at the end of the drift [s]
};

/// Largest component of any particle's displacement from its path after the drift [m]; ignores NaN.
/// @param executor  distributes many particles to its threads; may be null
template <class Real>
Real largest_deviation(const PathPass<Real>& pass, Executor* executor);

}  // namespace weft
