// Compiles the sweeps for each instruction set and dispatches to them.

#include "core/solver/grid_relaxation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/grid_relaxation_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/grid_relaxation_kernels-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(predict);
WEFT_EXPORT_KERNEL(sweep);
WEFT_EXPORT_KERNEL(move);

template <class Real>
void predict_grid(const SweepView<Real>& grid, const Prediction<Real>& step) {
  WEFT_RUN(predict, Real)(grid, step);
}

template <class Real>
void sweep_grid(const SweepView<Real>& grid, bool down, bool first, bool last) {
  WEFT_RUN(sweep, Real)(grid, down, first, last);
}

template <class Real>
void move_grid(const SweepView<Real>& grid) {
  WEFT_RUN(move, Real)(grid);
}

WEFT_INSTANTIATE_FUNCTIONS(predict_grid, sweep_grid, move_grid)

}  // namespace weft
#endif
