#pragma once

#include <vector>

#include "core/cloth/cloth_def.h"
#include "core/cloth/cloth_model.h"

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

/// All springs of a grid cloth, ordered by first end and then by kind; `kinds` gets one entry each.
/// Springs without stiffness and damping are left out.
template <class Real>
std::vector<Spring<Real>> grid_springs(const ClothDef& def, std::vector<SpringKind>& kinds);

}  // namespace weft
