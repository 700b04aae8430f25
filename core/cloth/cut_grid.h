#pragma once

#include "core/cloth/cloth_model.h"

// Grids that are cut to an outline.

namespace weft {

/// Builds the part of a grid inside the cloth's outline, as a model with one part.
///
/// Cells are kept or dropped whole, so that every cell has the springs, hinges and mass that it has
/// in a rectangle, and the fabric's tensor and rigidity are those of the whole grid; the border is
/// a staircase. The definition must be valid. Throws DefinitionError on "fabric.shear" as
/// build_grid_cloth does.
template <class Real>
ClothModel<Real> build_cut_grid(const ClothDef& def);

}  // namespace weft
