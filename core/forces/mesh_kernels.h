#pragma once

#include "core/forces/kick.h"
#include "core/forces/mesh_view.h"

namespace weft {

// Forces of springs, dashpots and quadratic bending on each particle of a mesh, in vector code
// selected for the processor at run time; all versions give the same bits. Arrays are those of the
// whole model, three numbers per particle.

/// Overwrites the mesh's range of `force` [N].
/// @param x,v  [m], [m/s]
template <class Real>
void mesh_forces(const MeshView<Real>& mesh, const Real* x, const Real* v, Real* force);

/// Kicks the mesh's range of `v` by the forces. No particle is read after its kick, so no list of
/// forces is needed.
template <class Real>
void mesh_kick(const MeshView<Real>& mesh, const KickLaw<Real>& law,
               const KickedParticles<Real>& particles, const Real* x, Real* v);

}  // namespace weft
