#pragma once

#include "core/forces/kick.h"
#include "core/forces/mesh_view.h"

namespace weft {

// Forces of springs, dashpots and quadratic bending on each particle of a mesh, in vector code
// selected for the processor at run time; all versions give the same bits. Arrays are those of the
// whole model, three numbers per particle.

/// Overwrites the mesh's range of `force` [N].
/// @param x,v  [m], [m/s]
void mesh_forces(const MeshView<float>& mesh, const float* x, const float* v, float* force);
void mesh_forces(const MeshView<double>& mesh, const double* x, const double* v, double* force);

/// Kicks the mesh's range of `v` by the forces. No particle is read after its kick, so no list of
/// forces is needed.
void mesh_kick(const MeshView<float>& mesh, const KickLaw<float>& law,
               const KickedParticles<float>& particles, const float* x, float* v);
void mesh_kick(const MeshView<double>& mesh, const KickLaw<double>& law,
               const KickedParticles<double>& particles, const double* x, double* v);

}  // namespace weft
