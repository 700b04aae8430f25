// Kicks particles in vector code.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_KICK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_KICK_INL_H
#undef WEFT_KICK_INL_H
#else
#define WEFT_KICK_INL_H
#endif

#include <cstddef>

#include "core/forces/kick.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Kicks one particle per lane. Without fused multiplication, so that the bits are those of the
/// formula.
/// @param i     index of the first, as in `particles`, `from` and `to`
/// @param from  old velocities [m/s]
/// @param to    new velocities; may be `from`
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void kick_particles(D d, const KickLaw<Real>& law,
                               const KickedParticles<Real>& particles, std::size_t i,
                               Triple<hn::Vec<D>> force, const Real* from, Real* to) {
  if (particles.external != nullptr) force = force + load_particles(d, particles.external + 3 * i);
  const auto scaled_dt = hn::Set(d, law.scaled_dt), keep = hn::Set(d, law.keep);
  const auto inverse_mass = hn::LoadU(d, particles.inverse_mass + i);
  const Triple<hn::Vec<D>> gravity{hn::Set(d, law.gravity[0]), hn::Set(d, law.gravity[1]),
                                   hn::Set(d, law.gravity[2])};
  const auto fall = drop_if(hn::Eq(inverse_mass, hn::Zero(d)), gravity * scaled_dt);
  const auto change = force * hn::Mul(inverse_mass, scaled_dt) + fall;
  store_particles(d, load_particles(d, from + 3 * i) * keep + change, to + 3 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
