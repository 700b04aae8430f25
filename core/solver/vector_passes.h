#pragma once

#include <cstddef>

#include "core/forces/kick.h"

namespace weft {

// The passes of the solver over all numbers of a cloth (three a particle), as vector code chosen
// for the processor when the program runs. Each number is computed by itself with + and * alone, so
// the choice does not change a bit.

/// Kicks particles that lie one behind the other.
template <class Real>
struct KickPass {
  std::size_t count = 0;           ///< particles
  const Real* from = nullptr;      ///< velocities before [m/s]
  Real* to = nullptr;              ///< after; may be `from`
  const Real* internal = nullptr;  ///< forces [N]
  KickedParticles<Real> particles;
  KickLaw<Real> law;
};

void run_kick(const KickPass<float>& pass);
void run_kick(const KickPass<double>& pass);

/// x <- x + v dt.
void run_drift(std::size_t count, const float* v, float dt, float* x);
void run_drift(std::size_t count, const double* v, double dt, double* x);

}  // namespace weft
