#pragma once

#include <cstddef>
#include <vector>

#include "core/math/quad.h"
#include "core/types.h"

// One look at all particles of a step: how far each wants to go, and how far it is off its path.

namespace weft {

/// Particles of a step, and the paths that they are expected on.
template <class Real>
struct StrayPass {
  const Real* x = nullptr;               ///< present positions, three numbers a particle [m]
  const Real* v = nullptr;               ///< and velocities [m/s]
  Real dt = 0;                           ///< of the coming drift [s]
  const Quad<Real>* from = nullptr;      ///< where displacements begin [m]
  Quad<Real>* displacement = nullptr;    ///< receives those until after the drift [m]
  const Quad<Real>* path = nullptr;      ///< where each path begins [m]
  const Quad<Real>* velocity = nullptr;  ///< along it [m/s]
  const Real* since = nullptr;           ///< when it begins [s]
  Real elapsed = 0;                      ///< the time after the drift [s]
  Quad<Real> off;                        ///< what is expected off all paths [m]
  Real soon2 = 0, limit2 = 0;  ///< squared distances from there: of strays, of the farthest that
                               ///< may be [m^2]
};

/// What a look at some particles found.
template <class Real>
struct StrayLook {
  Quad<Real> sum;      ///< of what they are off their paths, added the same way on any machine [m]
  Real farthest2 = 0;  ///< largest squared distance from what is expected, NaN ignored [m^2]
  bool left = false;   ///< one is farther than it may be
};

/// Looks at particles `first` to `end` (exclusive), and adds those to `strays` that are farther
/// than `soon2` from where they are expected, or at no number.
template <class Real>
StrayLook<Real> look_for_strays(const StrayPass<Real>& pass, std::size_t first, std::size_t end,
                                std::vector<Index>& strays);

}  // namespace weft
