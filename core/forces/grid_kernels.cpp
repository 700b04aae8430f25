#include "core/forces/grid_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/forces/grid_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/forces/grid_kernels-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(take_apart_f32);
HWY_EXPORT(take_apart_f64);
HWY_EXPORT(internal_forces_f32);
HWY_EXPORT(internal_forces_f64);
HWY_EXPORT(air_forces_f32);
HWY_EXPORT(air_forces_f64);

void grid_take_apart(const GridView<float>& grid, const float* from, float* const (&to)[3]) {
  HWY_DYNAMIC_DISPATCH(take_apart_f32)(grid, from, to);
}

void grid_take_apart(const GridView<double>& grid, const double* from, double* const (&to)[3]) {
  HWY_DYNAMIC_DISPATCH(take_apart_f64)(grid, from, to);
}

void grid_internal_forces(const GridView<float>& grid, float* force) {
  HWY_DYNAMIC_DISPATCH(internal_forces_f32)(grid, force);
}

void grid_internal_forces(const GridView<double>& grid, double* force) {
  HWY_DYNAMIC_DISPATCH(internal_forces_f64)(grid, force);
}

void grid_air_forces(const GridView<float>& grid, float pressure, float skin, float* force) {
  HWY_DYNAMIC_DISPATCH(air_forces_f32)(grid, pressure, skin, force);
}

void grid_air_forces(const GridView<double>& grid, double pressure, double skin, double* force) {
  HWY_DYNAMIC_DISPATCH(air_forces_f64)(grid, pressure, skin, force);
}

const char* simd_level() {
  return hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets());
}

}  // namespace weft
#endif
