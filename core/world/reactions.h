#pragma once

#include <cstdint>
#include <vector>

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/contact/objects/contact_log.h"
#include "core/solver/verlet.h"

namespace weft {

struct PinReaction {
  PinId pin = 0;
  Vec3d force = Vec3d::Zero();  ///< that the pin gives to the cloth [N]
};

/// Forces between the cloth and what holds it, at the end of a tick. Those of hands are with the
/// hands (grabs.h).
struct Reactions {
  std::uint64_t tick = 0;  ///< at whose end they are

  /// Of the cloth with objects, by object, then with itself. Forces with objects are means over the
  /// tick, those of cloths are of its last substep.
  std::vector<ContactPoint> contacts;

  /// Of each pin, in their order: what keeps its particles where they are, at the end of the tick.
  /// Of a pin on its way, the mean over the tick. A particle that several pins hold is shared
  /// evenly. Empty if the solver has no forces (relaxation).
  std::vector<PinReaction> pins;

  /// Of the cloth on each collider, mean over the tick [N].
  std::vector<Vec3d> colliders;
};

/// Forces on pinned particles: minus those of springs, bending, gravity, air and hands.
/// @param pulled    that of hands on each particle [N]; empty if there are none
/// @param reactions gets `pins`; its contacts are taken into account
template <class Real>
void add_pin_reactions(const ClothModel<Real>& model, const ClothState<Real>& state,
                       const Surroundings<Real>& surroundings, const Vec3Array<Real>& pulled,
                       const Pins& pins, Reactions& reactions);

}  // namespace weft
