// Compiles the passes for each instruction set and dispatches to them.

#include "core/solver/vector_passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/vector_passes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/vector_passes-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(kick);
WEFT_EXPORT_KERNEL(drift);

template <class Real>
void run_kick(const KickPass<Real>& pass) {
  WEFT_RUN(kick, Real)(pass);
}

template <class Real>
void run_drift(std::size_t count, const Real* v, Real dt, Real* x, Real* remainder) {
  WEFT_RUN(drift, Real)(count, v, dt, x, remainder);
}

WEFT_INSTANTIATE_FUNCTIONS(run_kick, run_drift)

}  // namespace weft
#endif
