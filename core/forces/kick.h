#pragma once

#include <array>

// Parameters of a kick: the change of velocities by forces.

namespace weft {

/// v <- keep v + scaled_dt (f/m + g); gravity does not act on fixed particles, whose inverse mass
/// is 0.
template <class Real>
struct KickLaw {
  Real keep = 1, scaled_dt = 0;   ///< [1], [s]
  std::array<Real, 3> gravity{};  ///< g [m/s^2]
};

/// Input of a kick besides forces and velocities; all start at the same particle.
template <class Real>
struct KickedParticles {
  const Real* inverse_mass = nullptr;  ///< [1/kg], one per particle; 0 if it is fixed
  const Real* external = nullptr;      ///< more forces [N], three numbers per particle; or null
};

}  // namespace weft
