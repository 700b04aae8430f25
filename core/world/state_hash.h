#pragma once

#include <cstdint>

#include "core/attachments/grabs.h"
#include "core/attachments/gripper.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_state.h"
#include "core/forces/air/environment.h"

namespace weft {

/// What surrounds the cloth and how stiff it was made, beside how the scene defines it.
struct Conditions {
  const EnvironmentDef& present;
  const EnvironmentDef& defined;
  double softness = 1;  ///< see World::set_softness
};

/// XXH64 over the bits of all that decides the future of a world: positions, velocities, how often
/// each particle is pinned, the grabs with their targets, colliders that are not as defined or have
/// a command, grippers, which cloths sleep, an environment or a softness other than the scene's,
/// and the tick unless all cloths sleep.
/// @param asleep  of each cloth 1 if it sleeps
template <class Real>
std::uint64_t state_hash(const ClothState<Real>& state, const Pins& pins, const Grabs<Real>& grabs,
                         const std::vector<ColliderDef>& defs, const ColliderStates& colliders,
                         const std::vector<Gripper>& grippers, const std::vector<char>& asleep,
                         const Conditions& conditions, std::uint64_t tick);

}  // namespace weft
