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
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(all_forces);
WEFT_EXPORT_KERNEL(kick_all);

template <class Real>
void mesh_forces(const MeshView<Real>& mesh, const Real* x, const Real* v, Real* force) {
  WEFT_RUN(all_forces, Real)(mesh, x, v, force);
}

template <class Real>
void mesh_kick(const MeshView<Real>& mesh, const KickLaw<Real>& law,
               const KickedParticles<Real>& particles, const Real* x, Real* v) {
  WEFT_RUN(kick_all, Real)(mesh, law, particles, x, v);
}

WEFT_INSTANTIATE_FUNCTIONS(mesh_forces, mesh_kick)

}  // namespace weft
#endif
