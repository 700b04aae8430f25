// Reaction forces at pinned particles.

#include "core/world/reactions.h"

#include <algorithm>
#include <cassert>

namespace weft {
namespace {

/// Impulses of contacts by particle [N s].
Vec3Array<double> impulses_of(const std::vector<ContactPoint>& contacts, std::size_t particles,
                              double seconds) {
  Vec3Array<double> impulse(particles, Vec3d::Zero());
  for (const ContactPoint& contact : contacts) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
      impulse[static_cast<std::size_t>(contact.particle[k])] +=
          contact.force() * (contact.weight[k] * seconds);
  }
  return impulse;
}

}  // namespace

template <class Real>
void add_pin_reactions(const ClothModel<Real>& model, const Vec3<Real>& gravity, const Pins& pins,
                       const HeldForces<Real>& held, double seconds, Reactions& reactions) {
  if (pins.list.empty()) return;
  assert(seconds > 0 && pins.pin_count.size() == model.mass.size());
  const Vec3Array<double> pushed = impulses_of(reactions.contacts, model.mass.size(), seconds);
  // A pin that moved, and may have arrived in this tick, has driven its particles.
  const auto rested = [&held](const Pin& pin) {
    return !pin.path && std::all_of(pin.particles.begin(), pin.particles.end(),
                                    [&held](Index i) { return held.holds(i); });
  };
  std::vector<int> bearing(model.mass.size(), 0);  // pins that rested, of each particle
  for (const Pin& pin : pins.list) {
    for (const Index i : pin.particles) bearing[static_cast<std::size_t>(i)] += rested(pin) ? 1 : 0;
  }
  for (const Pin& pin : pins.list) {
    PinReaction reaction{pin.id, Vec3d::Zero()};
    if (!rested(pin)) {
      reaction.force = pin.drive;
      reactions.pins.push_back(reaction);
      continue;
    }
    Vec3d impulse = Vec3d::Zero();
    for (const Index k : pin.particles) {
      const auto i = static_cast<std::size_t>(k);
      assert(bearing[i] > 0);
      const Vec3d weight = (gravity * model.mass[i]).template cast<double>() * seconds;
      impulse -= (held.impulse(k) + pushed[i] + weight) / bearing[i];
    }
    reaction.force = impulse / seconds;
    reactions.pins.push_back(reaction);
  }
}

#define WEFT_INSTANTIATE(Real)                                                             \
  template void add_pin_reactions(const ClothModel<Real>&, const Vec3<Real>&, const Pins&, \
                                  const HeldForces<Real>&, double, Reactions&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
