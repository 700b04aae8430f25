// A grid's kernels for one instruction set.
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
#include "core/math/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {

WEFT_KERNEL(take_apart);
WEFT_KERNEL(put_together);
WEFT_KERNEL(internal_forces);
WEFT_KERNEL(elastic_energy);
WEFT_KERNEL(begin_rows);
WEFT_KERNEL(advance);
WEFT_KERNEL(take_places);
WEFT_KERNEL(put_places);
WEFT_KERNEL(take_motion);
WEFT_KERNEL(drift);
WEFT_KERNEL(air_forces);
WEFT_KERNEL(box_paths);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
