#pragma once

#include <cstddef>

#include "core/forces/kick.h"

namespace weft {

// The solver's passes over all numbers of a cloth (three per particle), in vector code selected for
// the processor at run time. Each number is computed separately with + and * only, so the selection
// does not change a bit.

/// Kicks consecutive particles.
template <class Real>
struct KickPass {
  std::size_t count = 0;           ///< particles
  const Real* from = nullptr;      ///< old velocities [m/s]
  Real* to = nullptr;              ///< new velocities; may be `from`
  const Real* internal = nullptr;  ///< forces [N]
  KickedParticles<Real> particles;
  KickLaw<Real> law;
};

template <class Real>
void run_kick(const KickPass<Real>& pass);

/// x <- x + v dt.
/// @param remainder  what earlier drifts lost to rounding, and what they now have lost [m]
template <class Real>
void run_drift(std::size_t count, const Real* v, Real dt, Real* x, Real* remainder);

}  // namespace weft
