#pragma once

#include <cstdint>

#include "core/attachments/grabs.h"
#include "core/attachments/gripper.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_def.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_state.h"
#include "core/forces/air/environment.h"

// Hash of a world's state, to compare runs.

namespace weft {

/// Present environment, softness and fabrics of a world, with those of the scene for comparison.
struct Conditions {
  const EnvironmentDef& present;
  const EnvironmentDef& defined;
  const Vec3d& gusts_ahead;                     ///< see `sample_air`
  double softness = 1;                          ///< see World::set_softness
  const std::vector<ClothDef>& cloths;          ///< with their present fabrics
  const std::vector<FabricDef>& scene_fabrics;  ///< one for each
};

/// XXH64 over the bits of everything that determines the future of a world: positions, velocities,
/// pin counts of particles, grabs with their targets, colliders that moved or have a command,
/// grippers, sleeping cloths, an environment, softness or fabric that differs from the scene's,
/// gusts that a change of the wind has put elsewhere, and the tick unless all cloths sleep.
/// @param asleep  for each cloth 1 if it sleeps
template <class Real>
std::uint64_t state_hash(const ClothState<Real>& state, const Pins& pins, const Grabs<Real>& grabs,
                         const std::vector<ColliderDef>& defs, const ColliderStates& colliders,
                         const std::vector<Gripper>& grippers, const std::vector<char>& asleep,
                         const Conditions& conditions, std::uint64_t tick);

}  // namespace weft
