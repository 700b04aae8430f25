#pragma once

#include "core/forces/mesh_view.h"

namespace weft {

/// Forces of springs, dashpots and quadratic bending on each particle of a mesh [N], written over
/// its stretch of `force`. Vector code chosen for the processor when the program runs; all choices
/// give the same bits.
/// @param x,v,force  of the whole model, three numbers a particle [m], [m/s], [N]
void mesh_forces(const MeshView<float>& mesh, const float* x, const float* v, float* force);
void mesh_forces(const MeshView<double>& mesh, const double* x, const double* v, double* force);

}  // namespace weft
