#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// The stress that compliant sweeps (XPBD) have for a uniform strain.

namespace weft {

/// How a substep is swept.
struct SweptSubstep {
  double softness = 0;  ///< compliance / dt^2 [1/s^2]
  int sweeps = 1;
};

/// Stresses by strains, of a cloth under XPBD [N/m]: both stretches and shear, in this order.
using SweptTensor = Eigen::Matrix3d;

/// Of a whole grid whose cells are alike, in its middle.
/// @param model  one part, at least kProbedCells + 2 cells each way
SweptTensor swept_tensor_of_grid(const ClothModel<double>& model, const SweptSubstep& substep);

/// Of a mesh of membrane triangles that is flat in its material coordinates, over the triangles
/// that are away from its border. Zero if there are none.
/// @param model  one part
SweptTensor swept_tensor_of_mesh(const ClothModel<double>& model, const SweptSubstep& substep);

}  // namespace weft
