#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/constants.h"

// Softer springs, for worlds that must save substeps.

namespace weft {

/// Makes all springs and membranes `softness` times as stiff. Their highest frequency, and with it
/// the number of substeps, scales with the root of that; the dashpots keep their damping ratio.
/// Bending is unchanged.
/// @param softness  kLeastSoftness to 1
template <class Real>
void soften(double softness, ClothModel<Real>& model);

}  // namespace weft
