#pragma once

#include "core/cloth/cloth_model.h"

namespace weft {

/// Builds the part of a grid that lies in the cloth's outline, as a model of one part.
///
/// Whole cells are kept or left out, so that every cell has the springs, hinges and mass that it
/// has in a rectangle and the fabric's tensor and rigidity are those of the whole grid; the border
/// is a staircase. The definition is valid already. Throws DefinitionError on "fabric.shear" as
/// build_grid_cloth does.
template <class Real>
ClothModel<Real> build_cut_grid(const ClothDef& def);

}  // namespace weft
