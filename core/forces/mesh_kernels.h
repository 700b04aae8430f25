#pragma once

#include "core/forces/kick.h"
#include "core/forces/mesh_view.h"

namespace weft {

// Forces of springs, dashpots and quadratic bending on each particle of a mesh, as vector code
// chosen for the processor when the program runs; all choices give the same bits. Arrays are those
// of the whole model, three numbers a particle.

/// Writes them over the mesh's stretch of `force` [N].
/// @param x,v  [m], [m/s]
void mesh_forces(const MeshView<float>& mesh, const float* x, const float* v, float* force);
void mesh_forces(const MeshView<double>& mesh, const double* x, const double* v, double* force);

/// Kicks the mesh's stretch of `v` by them. Who is kicked is read by nobody who comes later, so
/// that no list of forces is needed.
void mesh_kick(const MeshView<float>& mesh, const KickLaw<float>& law,
               const KickedParticles<float>& particles, const float* x, float* v);
void mesh_kick(const MeshView<double>& mesh, const KickLaw<double>& law,
               const KickedParticles<double>& particles, const double* x, double* v);

}  // namespace weft
