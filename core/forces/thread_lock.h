#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Force and energy of a thread that locks.

namespace weft {

/// A thread's derivative of the position, whose length is 1 at rest.
template <class Real>
Vec3<Real> thread_of(const ThreadLock<Real>& lock, const Vec3Array<Real>& x) {
  const auto at = [&](std::size_t k) -> const Vec3<Real>& {
    return x[static_cast<std::size_t>(lock.x[k])];
  };
  return (at(1) - at(0)) * lock.g1 + (at(2) - at(0)) * lock.g2;
}

/// Adds the force of the energy K/2 (e - e_L)^2 of a thread of strain e > e_L [N].
/// @param strain  e_L
template <class Real>
void add_lock_force(const ThreadLock<Real>& lock, Real strain, const Vec3Array<Real>& x,
                    Vec3Array<Real>& force) {
  const Vec3<Real> thread = thread_of(lock, x);
  const Real length = thread.norm(), beyond = length - Real(1) - strain;
  if (!(beyond > 0)) return;
  const Vec3<Real> pull = thread * (lock.stiffness * beyond / length);
  force[static_cast<std::size_t>(lock.x[0])] += pull * (lock.g1 + lock.g2);
  force[static_cast<std::size_t>(lock.x[1])] -= pull * lock.g1;
  force[static_cast<std::size_t>(lock.x[2])] -= pull * lock.g2;
}

/// That energy [J].
template <class Real>
double lock_energy(const ThreadLock<Real>& lock, Real strain, const Vec3Array<Real>& x) {
  const auto beyond = static_cast<double>(thread_of(lock, x).norm() - Real(1) - strain);
  return beyond > 0 ? 0.5 * static_cast<double>(lock.stiffness) * beyond * beyond : 0;
}

}  // namespace weft
