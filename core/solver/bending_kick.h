#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/types.h"

// Velocities at the instant of the positions, for bending.

namespace weft {

/// Kicks the cloths whose bending is damped by it. The velocities of relaxation are those of half a
/// substep ago, as bending sees them. Where its fastest mode is near the substep's limit, dashpots
/// that act on these bring energy; those that act at the instant of the positions do not.
/// @param seconds  of the kick; negative takes it back
/// @param force    scratch, of each particle [N]
template <class Real>
void kick_by_bending(const ClothModel<Real>& model, double seconds, Vec3Array<Real>& force,
                     ClothState<Real>& state);

}  // namespace weft
