#pragma once

#include "core/attachments/grabs.h"
#include "core/cloth/cloth_model.h"

// What a hand holds.

namespace weft {

/// Gives a hand its particles and weights: those of the disc around the hit, or the corners of its
/// triangle if the disc has none.
template <class Real>
void weigh_hold(const ClothModel<Real>& model, const GrabDef& def, Grab<Real>& grab);

}  // namespace weft
