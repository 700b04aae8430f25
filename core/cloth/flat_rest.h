#pragma once

#include "core/cloth/cloth_model.h"

// Tells a flat mesh from one that is curved at rest.

namespace weft {

/// Whether each piece of a mesh lies in a plane, up to the rounding of its vertices in a file, and
/// is not folded there.
/// @param model  the mesh alone, with its edges
template <class Real>
bool lies_flat(const ClothModel<Real>& model);

}  // namespace weft
