// Entry points of a grid's kernels for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_KERNELS_INL_H
#undef WEFT_GRID_KERNELS_INL_H
#else
#define WEFT_GRID_KERNELS_INL_H
#endif

#include "core/forces/grid_air-inl.h"
#include "core/forces/grid_energy-inl.h"
#include "core/forces/grid_paths-inl.h"
#include "core/forces/grid_step-inl.h"

// Entry points without templates, as Highway's dispatch requires.

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {

#define WEFT_GRID_KERNELS(Real, Kind)                                                          \
  HWY_ATTR void take_apart_##Kind(const GridView<Real>& grid, const Real* from, Real* to,      \
                                  std::ptrdiff_t pitch) {                                      \
    take_apart(grid, from, to, pitch);                                                         \
  }                                                                                            \
  HWY_ATTR void put_together_##Kind(const GridView<Real>& grid, const Real* from,              \
                                    std::ptrdiff_t pitch, Real* to) {                          \
    put_together(grid, from, pitch, to);                                                       \
  }                                                                                            \
  HWY_ATTR void internal_forces_##Kind(const GridView<Real>& grid) {                           \
    internal_forces(grid);                                                                     \
  }                                                                                            \
  HWY_ATTR ElasticEnergy elastic_energy_##Kind(const GridView<Real>& grid) {                   \
    return elastic_energy(grid);                                                               \
  }                                                                                            \
  HWY_ATTR void begin_rows_##Kind(const GridView<Real>& grid, std::ptrdiff_t first) {          \
    begin_rows(grid, first);                                                                   \
  }                                                                                            \
  HWY_ATTR void advance_##Kind(const GridView<Real>& grid, const GridStep<Real>& step,         \
                               std::ptrdiff_t first, std::ptrdiff_t last) {                    \
    advance(grid, step, first, last);                                                          \
  }                                                                                            \
  HWY_ATTR void take_places_##Kind(const GridView<Real>& grid, const Real* from, Real* to,     \
                                   std::ptrdiff_t pitch) {                                     \
    take_places(grid, from, to, pitch);                                                        \
  }                                                                                            \
  HWY_ATTR void put_places_##Kind(const GridView<Real>& grid, Real* to) {                      \
    put_places(grid, to);                                                                      \
  }                                                                                            \
  HWY_ATTR void take_motion_##Kind(const GridView<Real>& grid, const Real* x, const Real* v) { \
    take_motion(grid, x, v);                                                                   \
  }                                                                                            \
  HWY_ATTR void drift_##Kind(const GridView<Real>& grid, Real dt, bool has_external,           \
                             const Real* v, Real* x) {                                         \
    drift(grid, dt, has_external, v, x);                                                       \
  }                                                                                            \
  HWY_ATTR void air_forces_##Kind(const GridView<Real>& grid, Real pressure, Real skin) {      \
    air_forces(grid, pressure, skin);                                                          \
  }                                                                                            \
  HWY_ATTR void box_paths_##Kind(const GridView<Real>& grid, const Real* paths, Real time,     \
                                 Real* box) {                                                  \
    box_paths(grid, paths, time, box);                                                         \
  }
WEFT_GRID_KERNELS(float, f32)
WEFT_GRID_KERNELS(double, f64)
#undef WEFT_GRID_KERNELS

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
