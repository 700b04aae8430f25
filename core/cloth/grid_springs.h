#pragma once

#include <vector>

#include "core/cloth/cloth_def.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/stability_bound.h"

// Springs of a grid.

namespace weft {

/// Stiffnesses of the inner springs of a grid with cells h_u x h_v [m], [N/m], whose continuum
/// limit is the plane-stress tensor C11 = Y_w, C22 = Y_f, C12 = C66 = G. Border springs of the same
/// direction have half.
struct GridStiffness {
  double warp = 0;   ///< along u: (Y_w - G h_u^2/h_v^2) h_v/h_u
  double weft = 0;   ///< along v: (Y_f - G h_v^2/h_u^2) h_u/h_v
  double shear = 0;  ///< each diagonal: G d^2 / (2 h_u h_v)
};

/// Springs with the continuum limit C11 = Y_w, C22 = Y_f, C12 = C66 = G.
/// Throws DefinitionError on "fabric.shear" if a structural spring would be negative.
GridStiffness grid_stiffness(const FabricDef& fabric, double cell_u, double cell_v);

/// E of forces/cell_misfit.h: a cell's springs whose strains do not fit by q have at least the
/// energy E q^2/2, with 1/E = 2/(k_s d^2) + 4 a_u^2/(k_w h_u^2) + 4 a_v^2/(k_f h_v^2) [N m]; 0 if
/// one of them has no stiffness.
double misfit_stiffness(const GridStiffness& springs, double cell_u, double cell_v);

/// Relaxation times of a grid's springs whose continuum limit damps stretch and shear with those of
/// the fabric. Diagonals resist stretch too, so what they damp of it is left out of the others;
/// where that is more than the whole, stretch is damped by more than its own time.
/// @param least  of each [s]
SpringTimes grid_spring_times(const FabricDef& fabric, double cell_u, double cell_v, double least);

/// All springs of a grid cloth, ordered by first end and then by kind; `kinds` gets one entry each.
/// Springs without stiffness and damping are left out.
template <class Real>
std::vector<Spring<Real>> grid_springs(const ClothDef& def, std::vector<SpringKind>& kinds);

}  // namespace weft
