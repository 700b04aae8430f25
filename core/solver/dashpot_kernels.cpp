// Compiles the passes over damped stencils for each instruction set and dispatches to them.

#include "core/solver/dashpot_kernels.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/dashpot_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/dashpot_kernels-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(aim);
WEFT_EXPORT_KERNEL(multiply);

template <class Real>
void aim_dashpots(const DashpotRun& run, const Quad<Real>* x, DashpotFamily<Real>& family) {
  assert(run.first <= run.end && run.end <= family.batches);
  WEFT_RUN(aim, Real)(run, x, family);
}

template <class Real>
void multiply_dashpots(const DashpotRun& run, const Quad<Real>* v, std::size_t first,
                       std::size_t end, DashpotFamily<Real>& family, Quad<Real>* product) {
  assert(run.first <= run.end && run.end <= family.batches && first <= end);
  WEFT_RUN(multiply, Real)(run, v, first, end, family, product);
}

WEFT_INSTANTIATE_FUNCTIONS(aim_dashpots, multiply_dashpots)

}  // namespace weft
#endif
