// Means of the forces at the supports of still cloth, told while it sleeps.

#include "core/world/still_forces.h"

#include <algorithm>
#include <cassert>

#include "core/world/sleep.h"

namespace weft {
namespace {

auto find_pin(std::vector<PinReaction>& pins, PinId id) {
  return std::find_if(pins.begin(), pins.end(),
                      [id](const PinReaction& pin) { return pin.pin == id; });
}

/// Force of a cloth on each collider [N].
std::vector<Vec3d> forces_on_colliders(const IndexRange& cloth, const Reactions& told) {
  std::vector<Vec3d> forces(told.colliders.size(), Vec3d::Zero());
  for (const ContactPoint& contact : told.contacts) {
    if (contact.collider == kNone || !cloth.contains(contact.particle[0])) continue;
    const auto k = static_cast<std::size_t>(contact.collider);
    if (k < forces.size()) forces[k] -= contact.force();
  }
  return forces;
}

/// Weight of a tick of stillness: a parabola over the ticks before sleep, and next to nothing for
/// those in which a cloth waits for its neighbours, or which alone were measured.
/// @param tick  from 0, in which stillness began
double weight_of(std::uint32_t tick, std::uint32_t ticks) {
  constexpr double kLeast = 1e-9;
  if (tick == 0 || tick > ticks) return kLeast;
  const double part = static_cast<double>(tick) / (ticks + 1.0);
  return part * (1 - part);
}

}  // namespace

void StillForces::let_go(const std::vector<char>& asleep) {
  for (std::size_t k = 0; k < std::min(cloths_.size(), asleep.size()); ++k) {
    if (cloths_[k].asleep && asleep[k] == 0) cloths_[k] = {};
  }
}

void StillForces::Cloth::add(const std::vector<PinReaction>& held, const std::vector<Vec3d>& met,
                             double share) {
  weight += share;
  for (const PinReaction& pin : held) {
    auto known = find_pin(pins, pin.pin);
    if (known == pins.end()) known = pins.insert(known, {pin.pin, Vec3d::Zero()});
    known->force += pin.force * share;
  }
  colliders.resize(met.size(), Vec3d::Zero());
  for (std::size_t k = 0; k < met.size(); ++k) colliders[k] += met[k] * share;
}

template <class Real>
void StillForces::note(const ClothModel<Real>& model, const Pins& pins, const Sleep<Real>& sleep,
                       Reactions& told) {
  if (!sleep.wanted()) return;
  cloths_.resize(model.parts.size());
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    Cloth& cloth = cloths_[p];
    const IndexRange& range = model.parts[p].particles;
    const std::vector<Vec3d> met = forces_on_colliders(range, told);
    if (!cloth.asleep) {
      if (sleep.still_ticks(p) <= 1) cloth = {};
      std::vector<PinReaction> held;
      for (std::size_t k = 0; k < told.pins.size(); ++k) {
        if (range.contains(pins.list[k].centre)) held.push_back(told.pins[k]);
      }
      cloth.add(held, met, weight_of(sleep.still_ticks(p), sleep.ticks_to_sleep()));
    }
    cloth.asleep = sleep.is_asleep(p);
    if (!cloth.asleep) continue;
    for (PinReaction& pin : told.pins) {
      const auto known = find_pin(cloth.pins, pin.pin);
      if (known != cloth.pins.end()) pin.force = known->force / cloth.weight;
    }
    for (std::size_t k = 0; k < met.size(); ++k)
      told.colliders[k] += cloth.colliders[k] / cloth.weight - met[k];
  }
}

template void StillForces::note(const ClothModel<float>&, const Pins&, const Sleep<float>&,
                                Reactions&);
template void StillForces::note(const ClothModel<double>&, const Pins&, const Sleep<double>&,
                                Reactions&);

}  // namespace weft
