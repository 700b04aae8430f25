// Compiles a grid's kernels for each instruction set and dispatches to them.

#include "core/forces/grid_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/forces/grid_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/forces/grid_kernels-inl.h"

#if HWY_ONCE
#include "core/forces/grid_pass.h"

namespace weft {

#define WEFT_DISPATCH(Real, Kind)                                                                 \
  HWY_EXPORT(take_apart_##Kind);                                                                  \
  HWY_EXPORT(put_together_##Kind);                                                                \
  HWY_EXPORT(take_places_##Kind);                                                                 \
  HWY_EXPORT(put_places_##Kind);                                                                  \
  HWY_EXPORT(take_motion_##Kind);                                                                 \
  HWY_EXPORT(internal_forces_##Kind);                                                             \
  HWY_EXPORT(elastic_energy_##Kind);                                                              \
  HWY_EXPORT(begin_rows_##Kind);                                                                  \
  HWY_EXPORT(advance_##Kind);                                                                     \
  HWY_EXPORT(drift_##Kind);                                                                       \
  HWY_EXPORT(air_forces_##Kind);                                                                  \
  HWY_EXPORT(box_paths_##Kind);                                                                   \
  void grid_take_apart(const GridView<Real>& grid, const Real* from, Real* to,                    \
                       std::ptrdiff_t pitch) {                                                    \
    HWY_DYNAMIC_DISPATCH(take_apart_##Kind)(grid, from, to, pitch);                               \
  }                                                                                               \
  void grid_put_together(const GridView<Real>& grid, const Real* from, std::ptrdiff_t pitch,      \
                         Real* to) {                                                              \
    HWY_DYNAMIC_DISPATCH(put_together_##Kind)(grid, from, pitch, to);                             \
  }                                                                                               \
  void grid_internal_forces(const GridView<Real>& grid) {                                         \
    HWY_DYNAMIC_DISPATCH(internal_forces_##Kind)(grid);                                           \
  }                                                                                               \
  ElasticEnergy grid_elastic_energy(const GridView<Real>& grid) {                                 \
    return HWY_DYNAMIC_DISPATCH(elastic_energy_##Kind)(grid);                                     \
  }                                                                                               \
  void grid_begin_rows(const GridView<Real>& grid, std::ptrdiff_t first) {                        \
    HWY_DYNAMIC_DISPATCH(begin_rows_##Kind)(grid, first);                                         \
  }                                                                                               \
  void grid_advance(const GridView<Real>& grid, const GridStep<Real>& step, std::ptrdiff_t first, \
                    std::ptrdiff_t last) {                                                        \
    HWY_DYNAMIC_DISPATCH(advance_##Kind)(grid, step, first, last);                                \
  }                                                                                               \
  void grid_take_places(const GridView<Real>& grid, const Real* from, Real* to,                   \
                        std::ptrdiff_t pitch) {                                                   \
    HWY_DYNAMIC_DISPATCH(take_places_##Kind)(grid, from, to, pitch);                              \
  }                                                                                               \
  void grid_put_places(const GridView<Real>& grid, Real* to) {                                    \
    HWY_DYNAMIC_DISPATCH(put_places_##Kind)(grid, to);                                            \
  }                                                                                               \
  void grid_take_motion(const GridView<Real>& grid, const Real* x, const Real* v) {               \
    HWY_DYNAMIC_DISPATCH(take_motion_##Kind)(grid, x, v);                                         \
  }                                                                                               \
  void grid_drift(const GridView<Real>& grid, Real dt, bool has_external, const Real* v,          \
                  Real* x) {                                                                      \
    HWY_DYNAMIC_DISPATCH(drift_##Kind)(grid, dt, has_external, v, x);                             \
  }                                                                                               \
  void grid_air_forces(const GridView<Real>& grid, Real pressure, Real skin) {                    \
    HWY_DYNAMIC_DISPATCH(air_forces_##Kind)(grid, pressure, skin);                                \
  }                                                                                               \
  void grid_box_paths(const GridView<Real>& grid, const Real* paths, Real time, Real* box) {      \
    HWY_DYNAMIC_DISPATCH(box_paths_##Kind)(grid, paths, time, box);                               \
  }
WEFT_DISPATCH(float, f32)
WEFT_DISPATCH(double, f64)
#undef WEFT_DISPATCH

const char* simd_level() {
  return hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets());
}

}  // namespace weft
#endif
