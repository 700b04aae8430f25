#pragma once

#include "core/cloth/cloth_model.h"

// Softer springs, for rooms that must save substeps.

namespace weft {

/// Least fraction of its stiffness that a cloth keeps; below it fabric is a rubber band.
inline constexpr double kLeastSoftness = 0.01;

/// Makes all springs `softness` times as stiff. Their highest frequency, and with it the number of
/// substeps, scales with the root of that; the dashpots keep their damping ratio. Bending is
/// unchanged.
/// @param softness  kLeastSoftness to 1
template <class Real>
void soften(double softness, ClothModel<Real>& model);

}  // namespace weft
