#pragma once

#include <cstdint>
#include <vector>

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/contact/objects/contact_log.h"
#include "core/solver/verlet.h"

// Forces between the cloth and its supports.

namespace weft {

struct PinReaction {
  PinId pin = 0;
  Vec3d force = Vec3d::Zero();  ///< of the pin on the cloth [N]
};

/// Forces between the cloth and its supports at the end of a tick. Forces of hands are in grabs.h.
struct Reactions {
  std::uint64_t tick = 0;  ///< to which they belong

  /// Contacts of the cloth with objects, by object, then with itself. Forces with objects are means
  /// over the tick; those between cloths are of its last substep.
  std::vector<ContactPoint> contacts;

  /// For each pin, in their order: the force that holds its particles at the end of the tick; for a
  /// moving pin, the mean over the tick. A particle with several pins is shared evenly. Empty if
  /// the solver has no forces (relaxation).
  std::vector<PinReaction> pins;

  /// Force of the cloth on each collider, mean over the tick [N].
  std::vector<Vec3d> colliders;
};

/// Forces on pinned particles: minus those of membrane, bending, gravity, air and hands.
/// @param hand_forces    forces of hands on each particle [N]; empty if there are none
/// @param reactions receives `pins`; its contacts are taken into account
template <class Real>
void add_pin_reactions(const ClothModel<Real>& model, const ClothState<Real>& state,
                       const Surroundings<Real>& surroundings, const Vec3Array<Real>& hand_forces,
                       const Pins& pins, Reactions& reactions);

}  // namespace weft
