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
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(take_apart);
WEFT_EXPORT_KERNEL(put_together);
WEFT_EXPORT_KERNEL(internal_forces);
WEFT_EXPORT_KERNEL(elastic_energy);
WEFT_EXPORT_KERNEL(begin_rows);
WEFT_EXPORT_KERNEL(advance);
WEFT_EXPORT_KERNEL(take_places);
WEFT_EXPORT_KERNEL(put_places);
WEFT_EXPORT_KERNEL(take_motion);
WEFT_EXPORT_KERNEL(drift);
WEFT_EXPORT_KERNEL(air_forces);
WEFT_EXPORT_KERNEL(box_paths);

template <class Real>
void grid_take_apart(const GridView<Real>& grid, const Real* from, Real* to, std::ptrdiff_t pitch) {
  WEFT_RUN(take_apart, Real)(grid, from, to, pitch);
}

template <class Real>
void grid_put_together(const GridView<Real>& grid, const Real* from, std::ptrdiff_t pitch,
                       Real* to) {
  WEFT_RUN(put_together, Real)(grid, from, pitch, to);
}

template <class Real>
void grid_internal_forces(const GridView<Real>& grid) {
  WEFT_RUN(internal_forces, Real)(grid);
}

template <class Real>
ElasticEnergy grid_elastic_energy(const GridView<Real>& grid) {
  return WEFT_RUN(elastic_energy, Real)(grid);
}

template <class Real>
void grid_begin_rows(const GridView<Real>& grid, std::ptrdiff_t first) {
  WEFT_RUN(begin_rows, Real)(grid, first);
}

template <class Real>
void grid_advance(const GridView<Real>& grid, const GridStep<Real>& step, std::ptrdiff_t first,
                  std::ptrdiff_t last) {
  WEFT_RUN(advance, Real)(grid, step, first, last);
}

template <class Real>
void grid_take_places(const GridView<Real>& grid, const Real* from, Real* to,
                      std::ptrdiff_t pitch) {
  WEFT_RUN(take_places, Real)(grid, from, to, pitch);
}

template <class Real>
void grid_put_places(const GridView<Real>& grid, Real* to) {
  WEFT_RUN(put_places, Real)(grid, to);
}

template <class Real>
void grid_take_motion(const GridView<Real>& grid, const Real* x, const Real* v) {
  WEFT_RUN(take_motion, Real)(grid, x, v);
}

template <class Real>
void grid_drift(const GridView<Real>& grid, Real dt, bool has_external, const Real* v, Real* x) {
  WEFT_RUN(drift, Real)(grid, dt, has_external, v, x);
}

template <class Real>
void grid_air_forces(const GridView<Real>& grid, Real pressure, Real skin) {
  WEFT_RUN(air_forces, Real)(grid, pressure, skin);
}

template <class Real>
void grid_box_paths(const GridView<Real>& grid, const Real* paths, Real time, Real* box) {
  WEFT_RUN(box_paths, Real)(grid, paths, time, box);
}

WEFT_INSTANTIATE_FUNCTIONS(grid_take_apart, grid_put_together, grid_internal_forces,
                           grid_elastic_energy, grid_begin_rows, grid_advance, grid_take_places,
                           grid_put_places, grid_take_motion, grid_drift, grid_air_forces,
                           grid_box_paths)

const char* simd_level() {
  return hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets());
}

}  // namespace weft
#endif
