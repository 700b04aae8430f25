// Reaction forces at pinned particles.

#include "core/world/reactions.h"

#include <cassert>

#include "core/forces/bending_damping.h"
#include "core/forces/force_pass.h"

namespace weft {

template <class Real>
void add_pin_reactions(const ClothModel<Real>& model, const ClothState<Real>& state,
                       const Surroundings<Real>& surroundings, const Vec3Array<Real>& hand_forces,
                       const Pins& pins, Reactions& reactions) {
  if (pins.list.empty()) return;
  assert(hand_forces.empty() || hand_forces.size() == model.mass.size());
  assert(pins.pin_count.size() == model.mass.size());
  Vec3Array<Real> force = hand_forces;
  force.resize(model.mass.size(), Vec3<Real>::Zero());
  add_spring_forces(model, state.x, state.v, force);
  add_membrane_forces(model, state.x, state.v, force);
  add_hinge_forces(model, state.x, state.v, force);
  add_quadratic_bending_forces(model, state.x, force);
  for (const ClothPart<Real>& part : model.parts)
    add_bending_damping_forces(part, state.x, state.v, force);
  if (surroundings.air)
    add_air_forces(model, surroundings.wind, surroundings.air_density, state.x, state.v, force);
  for (const ContactPoint& contact : reactions.contacts) {
    const Vec3<Real> on_cloth = contact.force().template cast<Real>();
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
      force[static_cast<std::size_t>(contact.particle[k])] +=
          on_cloth * static_cast<Real>(contact.weight[k]);
  }
  for (const Pin& pin : pins.list) {
    PinReaction reaction{pin.id, Vec3d::Zero()};
    if (pin.path) {
      reaction.force = pin.drive;
      reactions.pins.push_back(reaction);
      continue;
    }
    for (const Index k : pin.particles) {
      const auto i = static_cast<std::size_t>(k);
      assert(pins.pin_count[i] > 0);
      const Vec3<Real> all = force[i] + surroundings.gravity * model.mass[i];
      reaction.force -= all.template cast<double>() / pins.pin_count[i];
    }
    reactions.pins.push_back(reaction);
  }
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template void add_pin_reactions(const ClothModel<Real>&, const ClothState<Real>&,               \
                                  const Surroundings<Real>&, const Vec3Array<Real>&, const Pins&, \
                                  Reactions&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
