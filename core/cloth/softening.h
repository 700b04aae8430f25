#pragma once

#include "core/cloth/cloth_model.h"

namespace weft {

/// Part of the stiffness that a cloth keeps at least; below it fabric is a rubber band.
inline constexpr double kLeastSoftness = 0.01;

/// Makes all springs `softness` times as stiff. Their highest frequency, and with it the number of
/// substeps, falls with the root of that; the dashpots keep their damping ratio. Bending stays.
/// @param softness  kLeastSoftness to 1
template <class Real>
void soften(double softness, ClothModel<Real>& model);

}  // namespace weft
