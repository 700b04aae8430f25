// Puts cloth to sleep and wakes it: sleep.h decides, the world reports what acts on it.

#include <algorithm>

#include "core/forces/air/air.h"
#include "core/world/world.h"

namespace weft {
namespace {

template <class Real>
std::size_t part_of(const ClothModel<Real>& model, Index particle) {
  return static_cast<std::size_t>(&part_of_particle(model, particle) - model.parts.data());
}

}  // namespace

/// Passes on to contact that masses changed.
template <class Real>
void World<Real>::masses_changed() {
  contact_.objects.invalidate_rows();
  if (contact_.guard) contact_.guard->invalidate_rows();
}

/// Passes on to contact and forces which cloths sleep now.
template <class Real>
void World<Real>::sleep_changed() {
  supports_.still.let_go(sleep_.asleep());
  contact_.objects.let_rest(state_);
  if (contact_.guard) contact_.guard->let_rest(state_.asleep);
}

/// Wakes the cloth of a particle, and everything that touches it.
template <class Real>
void World<Real>::wake(Index particle) {
  if (!sleep_.wanted()) return;
  const std::size_t part = part_of(model_, particle);
  const bool slept = sleep_.is_asleep(part);
  sleep_.wake(part, pins_, state_);
  if (slept) sleep_changed();
}

template <class Real>
void World<Real>::wake_held(PinId id) {
  for (const Pin& pin : pins_.list) {
    if (pin.id == id) wake(pin.centre);
  }
}

template <class Real>
void World<Real>::wake_all() {
  if (!sleep_.wanted()) return;
  const bool any = sleep_.any_asleep();
  sleep_.wake_all(pins_, state_);
  if (any) sleep_changed();
}

/// Wakes cloths on which hands, pins, air, objects or neighbours act in the coming tick.
template <class Real>
void World<Real>::rouse_sleepers() {
  if (!sleep_.wanted()) return;
  const auto disturb = [this](Index particle) { sleep_.disturb(part_of(model_, particle)); };
  for (const Grab<Real>& grab : grabs_.list) disturb(grab.particles.front());
  for (const SlingImpulse<Real>& impulse : grabs_.impulses) disturb(impulse.particles.front());
  for (const Pin& pin : pins_.list) {
    if (pin.path) disturb(pin.centre);
  }
  // A steady wind leaves cloth that has come to rest in it at rest.
  if (changes_by_itself(environment_)) sleep_.disturb_all();
  for (const BadStart<Real>& start : contact_.objects.bad_starts())
    sleep_.disturb(static_cast<std::size_t>(start.cloth));
  if (contact_.guard && contact_.guard->open_pairs() > 0) sleep_.disturb_all();
  for (std::size_t k = 0; k < colliders_.size(); ++k) {
    if (colliders_[k].is_active()) sleep_.disturb_near(state_, def_.colliders[k], colliders_[k]);
  }
  if (sleep_.rouse(pins_, state_)) sleep_changed();
}

/// Whether the coming tick changes nothing.
template <class Real>
bool World<Real>::rests() const {
  return sleep_.all_asleep() &&
         std::none_of(colliders_.begin(), colliders_.end(),
                      [](const ColliderState& collider) { return collider.is_active(); });
}

/// The tick of a resting world: only time passes.
template <class Real>
const TickReport& World<Real>::rest() {
  report_.rested = true;
  report_.work = 0;
  report_.substeps = 0;
  report_.tick = ++tick_;
  report_.time = static_cast<double>(tick_) / def_.tick_rate;
  if (supports_.told) supports_.told->tick = tick_;
  return report_;
}

/// After a tick: puts cloths to sleep that have been still long enough.
template <class Real>
void World<Real>::put_to_sleep() {
  if (!sleep_.settle(state_)) return;
  sleep_changed();
  last_good_.v = state_.v;
  report_motion();
  if (energy_) energy_->book_loss(report_.energies, energy_->balance.sleep);
}

#define WEFT_INSTANTIATE(Real)                    \
  template void World<Real>::masses_changed();    \
  template void World<Real>::sleep_changed();     \
  template void World<Real>::wake(Index);         \
  template void World<Real>::wake_held(PinId);    \
  template void World<Real>::wake_all();          \
  template void World<Real>::rouse_sleepers();    \
  template bool World<Real>::rests() const;       \
  template const TickReport& World<Real>::rest(); \
  template void World<Real>::put_to_sleep();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
