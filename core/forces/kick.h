#pragma once

#include <array>

namespace weft {

/// v <- keep v + (f push/m + g push); gravity does not pull what is fixed, whose inverse mass is 0.
template <class Real>
struct KickLaw {
  Real keep = 1, push = 0;        ///< push in [s]
  std::array<Real, 3> gravity{};  ///< g [m/s^2]
};

/// What a kick reads beside forces and velocities, from the same particle on as those.
template <class Real>
struct KickedParticles {
  const Real* inverse_mass = nullptr;  ///< [1/kg], one a particle; 0 where it is fixed
  const Real* external = nullptr;      ///< more forces [N], three numbers a particle; or null
};

}  // namespace weft
