// Compiles the passes for each instruction set and dispatches to them.

#include "core/solver/vector_passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/vector_passes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/vector_passes-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(kick_f32);
HWY_EXPORT(kick_f64);
HWY_EXPORT(drift_f32);
HWY_EXPORT(drift_f64);

void run_kick(const KickPass<float>& pass) {
  HWY_DYNAMIC_DISPATCH(kick_f32)(pass);
}

void run_kick(const KickPass<double>& pass) {
  HWY_DYNAMIC_DISPATCH(kick_f64)(pass);
}

void run_drift(std::size_t count, const float* v, float dt, float* x, float* remainder) {
  HWY_DYNAMIC_DISPATCH(drift_f32)(count, v, dt, x, remainder);
}

void run_drift(std::size_t count, const double* v, double dt, double* x, double* remainder) {
  HWY_DYNAMIC_DISPATCH(drift_f64)(count, v, dt, x, remainder);
}

}  // namespace weft
#endif
