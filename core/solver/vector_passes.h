#pragma once

#include <cstddef>

namespace weft {

// The passes of the solver over all numbers of a cloth (three a particle), as vector code chosen
// for the processor when the program runs. Each number is computed by itself with + and * alone, so
// the choice does not change a bit.

/// v <- keep v + (f push/m + g push), number by number.
template <class Real>
struct KickPass {
  std::size_t count = 0;               ///< three times the particles
  const Real* from = nullptr;          ///< velocities before [m/s]
  Real* to = nullptr;                  ///< after; may be `from`
  const Real* internal = nullptr;      ///< forces [N]
  const Real* external = nullptr;      ///< more forces [N], or null
  const Real* inverse_mass = nullptr;  ///< [1/kg], for each number
  const Real* gravity = nullptr;       ///< [m/s^2], for each number; 0 where a particle is fixed
  Real keep = 1, push = 0;             ///< push in [s]
};

void run_kick(const KickPass<float>& pass);
void run_kick(const KickPass<double>& pass);

/// x <- x + v dt.
void run_drift(std::size_t count, const float* v, float dt, float* x);
void run_drift(std::size_t count, const double* v, double dt, double* x);

}  // namespace weft
