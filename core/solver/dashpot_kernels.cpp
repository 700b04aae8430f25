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
WEFT_EXPORT_KERNEL(open_stages);
WEFT_EXPORT_KERNEL(advance_stage);

template <class Real>
void aim_dashpots(const DashpotRun& run, const Real* x, DashpotFamily<Real>& family) {
  assert(run.first <= run.end && run.end <= family.batches);
  WEFT_RUN(aim, Real)(run, x, family);
}

template <class Real>
void multiply_dashpots(const DashpotRun& run, const Real* v, std::size_t first, std::size_t end,
                       DashpotFamily<Real>& family, Real* product) {
  assert(run.first <= run.end && run.end <= family.batches && first <= end);
  WEFT_RUN(multiply, Real)(run, v, first, end, family, product);
}

template <class Real>
void open_dashpot_stages(const NumberRange& range, Real by_start, const StageNumbers<Real>& of) {
  assert(range.first <= range.end);
  WEFT_RUN(open_stages, Real)(range, by_start, of);
}

template <class Real>
void advance_dashpot_stage(const NumberRange& range, const StageFactors<Real>& by,
                           const StageNumbers<Real>& of) {
  assert(range.first <= range.end);
  WEFT_RUN(advance_stage, Real)(range, by, of);
}

WEFT_INSTANTIATE_FUNCTIONS(aim_dashpots, multiply_dashpots, open_dashpot_stages,
                           advance_dashpot_stage)

}  // namespace weft
#endif
