#pragma once

#include <cstddef>

#include "core/executor.h"

namespace weft {

// Vector code of the contact over all particles, chosen for the processor when the program runs.
// Each particle is computed by itself, so the choice does not change a bit.

/// Where particles are, were, and may go; three numbers a particle unless said otherwise.
template <class Real>
struct TravelPass {
  std::size_t particles = 0;
  const Real* x = nullptr;      ///< [m]
  const Real* v = nullptr;      ///< [m/s]
  Real dt = 0;                  ///< of the coming drift [s]
  const Real* from = nullptr;   ///< where the way begins [m]
  const Real* reach = nullptr;  ///< how far each may go, one number a particle [m]
  Real* travel2 = nullptr;      ///< squared way, now or after the drift, whichever is longer [m^2]
};

/// Measures the way of every particle.
/// @param executor  shares many particles out to its threads; may be null
/// @return whether all end within their reach; false if something is not a number
bool measure_travel(const TravelPass<float>& pass, Executor* executor);
bool measure_travel(const TravelPass<double>& pass, Executor* executor);

/// Where particles are before a drift, and the straight paths that they are held against; three
/// numbers a particle.
template <class Real>
struct PathPass {
  std::size_t particles = 0;
  const Real* x = nullptr;         ///< [m]
  const Real* v = nullptr;         ///< [m/s]
  Real dt = 0;                     ///< of the drift [s]
  const Real* base = nullptr;      ///< where the paths are at time 0 [m]
  const Real* velocity = nullptr;  ///< along them [m/s]
  Real time = 0;                   ///< at the end of the drift [s]
};

/// The largest component of anybody's way off his path after the drift [m]; NaN does not count.
float largest_deviation(const PathPass<float>& pass);
double largest_deviation(const PathPass<double>& pass);

}  // namespace weft
