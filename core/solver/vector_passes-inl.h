// Kick and drift passes for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_VECTOR_PASSES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_VECTOR_PASSES_INL_H
#undef WEFT_VECTOR_PASSES_INL_H
#else
#define WEFT_VECTOR_PASSES_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/forces/kick-inl.h"
#include "core/math/drift-inl.h"
#include "core/math/kernels.h"
#include "core/solver/vector_passes.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls body(d, n) for whole vectors and then, with one lane, for the remaining numbers.
template <class Real, class Body>
HWY_INLINE void for_each_number(std::size_t count, Body&& body) {
  const hn::ScalableTag<Real> wide;
  const hn::CappedTag<Real, 1> single;
  std::size_t n = 0;
  for (; n + hn::Lanes(wide) <= count; n += hn::Lanes(wide)) body(wide, n);
  for (; n < count; ++n) body(single, n);
}

template <class Real>
HWY_ATTR void kick(const KickPass<Real>& p) {
  for_each_particle<Real>(p.count, [&](auto d, std::size_t i) HWY_ATTR {
    kick_particles(d, p.law, p.particles, i, load_particles(d, p.internal + 3 * i), p.from, p.to);
  });
}

template <class Real>
HWY_ATTR void drift(std::size_t count, const Real* v, Real dt, Real* x, Real* remainder) {
  for_each_number<Real>(count, [&](auto d, std::size_t n) HWY_ATTR {
    auto lost = hn::LoadU(d, remainder + n);
    hn::StoreU(drifted(d, hn::LoadU(d, x + n), hn::LoadU(d, v + n), hn::Set(d, dt), lost), d,
               x + n);
    hn::StoreU(lost, d, remainder + n);
  });
}

WEFT_KERNEL(kick);
WEFT_KERNEL(drift);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
