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
#include "core/math/lanes-inl.h"
#include "core/solver/vector_passes.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
HWY_ATTR void kick(const KickPass<Real>& p) {
  for_each_vector<Real>(p.count, [&](auto d, std::size_t i) HWY_ATTR {
    kick_particles(d, p.law, p.particles, i, load_particles(d, p.internal + 3 * i), p.from, p.to);
  });
}

template <class Real>
HWY_ATTR void drift(std::size_t count, const Real* v, Real dt, Real* x, Real* remainder) {
  for_each_vector<Real>(count, [&](auto d, std::size_t n) HWY_ATTR {
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
