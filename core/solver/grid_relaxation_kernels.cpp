// Compiles the sweeps for each instruction set and dispatches to them.

#include "core/solver/grid_relaxation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/grid_relaxation_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/grid_relaxation_kernels-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(predict_f32);
HWY_EXPORT(predict_f64);
HWY_EXPORT(sweep_f32);
HWY_EXPORT(sweep_f64);
HWY_EXPORT(move_f32);
HWY_EXPORT(move_f64);

void predict_grid(const SweepView<float>& grid, const Prediction<float>& step) {
  HWY_DYNAMIC_DISPATCH(predict_f32)(grid, step);
}

void predict_grid(const SweepView<double>& grid, const Prediction<double>& step) {
  HWY_DYNAMIC_DISPATCH(predict_f64)(grid, step);
}

void sweep_grid(const SweepView<float>& grid, bool down, bool first, bool last) {
  HWY_DYNAMIC_DISPATCH(sweep_f32)(grid, down, first, last);
}

void sweep_grid(const SweepView<double>& grid, bool down, bool first, bool last) {
  HWY_DYNAMIC_DISPATCH(sweep_f64)(grid, down, first, last);
}

void move_grid(const SweepView<float>& grid) {
  HWY_DYNAMIC_DISPATCH(move_f32)(grid);
}

void move_grid(const SweepView<double>& grid) {
  HWY_DYNAMIC_DISPATCH(move_f64)(grid);
}

}  // namespace weft
#endif
