#pragma once

#include <cstdint>
#include <vector>

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/contact/contact_tally.h"
#include "core/solver/held_forces.h"

// Forces between the cloth and its supports.

namespace weft {

struct PinReaction {
  PinId pin = 0;
  Vec3d force = Vec3d::Zero();  ///< of the pin on the cloth [N]
};

/// Forces between the cloth and its supports, means over a tick; of pins and colliders that hold
/// cloth which sleeps, over the time in which it was still (still_forces.h). Forces of hands are in
/// grabs.h.
struct Reactions {
  std::uint64_t tick = 0;  ///< to which they belong

  /// Contacts of the cloth with objects, by object, then with itself.
  std::vector<ContactPoint> contacts;

  /// For each pin, in their order. A particle with several pins is shared evenly. Empty if the
  /// solver has no forces (relaxation).
  std::vector<PinReaction> pins;

  /// Force of the cloth on each collider, mean over the tick [N]. Empty with the seed's contact.
  std::vector<Vec3d> colliders;
};

/// Adds the forces of pins: minus the impulses that their particles got in the tick from the cloth,
/// air, hands, gravity and contacts, over its length.
/// @param held       of the tick
/// @param seconds    its length
/// @param reactions  receives `pins`; its contacts are taken into account
template <class Real>
void add_pin_reactions(const ClothModel<Real>& model, const Vec3<Real>& gravity, const Pins& pins,
                       const HeldForces<Real>& held, double seconds, Reactions& reactions);

}  // namespace weft
