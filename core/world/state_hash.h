#pragma once

#include <cstdint>

#include "core/attachments/grabs.h"
#include "core/attachments/gripper.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_state.h"

namespace weft {

/// XXH64 over the bits of all that decides the future of a world: positions, velocities, how often
/// each particle is pinned, the grabs with their targets, colliders that are not as defined or have
/// a command, grippers, which cloths sleep, and the tick unless all do.
/// @param asleep  of each cloth 1 if it sleeps
template <class Real>
std::uint64_t state_hash(const ClothState<Real>& state, const Pins& pins, const Grabs<Real>& grabs,
                         const std::vector<ColliderDef>& defs, const ColliderStates& colliders,
                         const std::vector<Gripper>& grippers, const std::vector<char>& asleep,
                         std::uint64_t tick);

}  // namespace weft
