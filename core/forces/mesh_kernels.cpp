// Compiles a mesh's kernels for each instruction set and dispatches to them.

#include "core/forces/mesh_kernels.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/forces/mesh_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/forces/mesh_kernels-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(mesh_forces_f32);
HWY_EXPORT(mesh_forces_f64);
HWY_EXPORT(mesh_kick_f32);
HWY_EXPORT(mesh_kick_f64);

void mesh_forces(const MeshView<float>& mesh, const float* x, const float* v, float* force) {
  HWY_DYNAMIC_DISPATCH(mesh_forces_f32)(mesh, x, v, force);
}
void mesh_forces(const MeshView<double>& mesh, const double* x, const double* v, double* force) {
  HWY_DYNAMIC_DISPATCH(mesh_forces_f64)(mesh, x, v, force);
}

void mesh_kick(const MeshView<float>& mesh, const KickLaw<float>& law,
               const KickedParticles<float>& particles, const float* x, float* v) {
  HWY_DYNAMIC_DISPATCH(mesh_kick_f32)(mesh, law, particles, x, v);
}
void mesh_kick(const MeshView<double>& mesh, const KickLaw<double>& law,
               const KickedParticles<double>& particles, const double* x, double* v) {
  HWY_DYNAMIC_DISPATCH(mesh_kick_f64)(mesh, law, particles, x, v);
}

}  // namespace weft
#endif
