// Measures contacts, reaction forces and the work of all causes in a world, on request only.

#include <algorithm>
#include <cassert>

#include "core/stop_signal.h"
#include "core/world/crossing_counter.h"
#include "core/world/world.h"

namespace weft {

template <class Real>
void World<Real>::measure_forces(bool wanted) {
  if (wanted && !supports_.wanted) supports_.still.forget();
  supports_.wanted = wanted;
  contact_.objects.log_impulses(wanted, energy_.has_value());
  if (contact_.guard) contact_.guard->log_forces(wanted);
  // No tick of a resting world will measure them.
  if (wanted && !supports_.told && rests()) supports_.told = coming_reactions();
}

template <class Real>
void World<Real>::measure_present_forces() {
  if (supports_.wanted && !supports_.told) supports_.told = coming_reactions();
}

template <class Real>
void World<Real>::measure_energy(bool wanted) {
  energy_.reset();
  if (wanted) {
    const std::size_t first_jaw = def_.colliders.size() - 2 * def_.grippers.size();
    energy_.emplace(EnergyLedger<Real>{WorkMeter<Real>(model_.mass.size(), first_jaw), {}});
  }
  contact_.objects.log_impulses(supports_.wanted, wanted);
  allocate_external();
  begin_balance();
}

template <class Real>
void World<Real>::begin_balance() {
  if (energy_) energy_->begin(tick_, report_.energies);
}

template <class Real>
void World<Real>::take_reactions() {
  Reactions found;
  found.tick = tick_;
  found.colliders.assign(def_.colliders.size(), Vec3d::Zero());
  if (collision().objects) found.contacts = contact_.objects.contacts(state_.x);
  for (const ContactPoint& contact : found.contacts) {
    assert(static_cast<std::size_t>(contact.collider) < found.colliders.size());
    found.colliders[static_cast<std::size_t>(contact.collider)] -= contact.force();
  }
  if (contact_.seed) found.colliders.clear();  // it moves the cloth without telling its impulses
  if (contact_.guard) {
    const ClothGuard<Real>& guard = *contact_.guard;
    for (const ContactPoint& contact :
         contacts_of(guard.log(), guard.rows(), state_.x, tick_seconds()))
      found.contacts.push_back(contact);
  }
  if (solver_of(def_) != SolverKind::relaxation)
    add_pin_reactions(model_, surroundings_.gravity, pins_, supports_.held, tick_seconds(), found);
  supports_.still.note(model_, pins_, sleep_, found);
  supports_.told = std::move(found);
}

/// After a tick that could not be computed: pins hold the state that was restored.
template <class Real>
void World<Real>::hold_present_state() {
  if (!supports_.wanted) return;
  supports_.held.begin_tick(model_, pins_);
  supports_.held.act(surroundings_, state_.x, state_.v, tick_seconds());
}

template <class Real>
Vec3Array<Real> World<Real>::mean_velocities() const {
  const Vec3Array<Real>& before = checkpoint_.state.x;
  if (tick_ == 0 || report_.halted || before.size() != state_.x.size()) return state_.v;
  Vec3Array<Real> mean(before.size());
  const auto rate = static_cast<Real>(def_.tick_rate);
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (state_.x[i] - before[i]) * rate;
  return mean;
}

/// The solvers' arrays contain pointers into themselves; the copy gets its own.
template <class Real>
World<Real> World<Real>::copy() const {
  World other(*this);
  other.energy_.reset();
  other.debug_trees_.reset();
  other.solvers_.verlet = {};
  other.solvers_.relaxation = {};
  other.prepare_solver();
  // It has the history of the previous substep; its passes point into arrays of their own.
  other.solvers_.implicit = solvers_.implicit;
  if (solver_of(def_) == SolverKind::implicit) other.solvers_.implicit.energy.prepare(other.model_);
  return other;
}

template <class Real>
Reactions World<Real>::coming_reactions() const {
  World trial = copy();
  trial.wake_all();  // forces hold sleeping cloth too
  trial.measure_forces(true);
  if (trial.step().halted) throw Stopped();
  return *trial.reactions();
}

template <class Real>
ComingStarts World<Real>::coming_bad_starts() const {
  CrossingCounter<Real> counter;
  const auto meetings_of = [&counter](const World& world) {
    std::vector<Meeting> meetings;
    counter.count(world, &meetings);
    counter.find_in_rounds(world, meetings);
    return meetings;
  };
  ComingStarts found;
  found.meetings = meetings_of(*this);
  World trial = copy();
  if (trial.step().halted) throw Stopped();
  found.what = trial.bad_starts();
  found.pairs = trial.open_pairs();
  for (const Meeting& m : meetings_of(trial)) {
    if (std::none_of(found.meetings.begin(), found.meetings.end(),
                     [&m](const Meeting& known) { return known.is_of(m); }))
      found.meetings.push_back(m);
  }
  add_meetings(trial, found.meetings, "started through", {}, found);
  return found;
}

#define WEFT_INSTANTIATE(Real)                                   \
  template void World<Real>::measure_forces(bool);               \
  template void World<Real>::measure_present_forces();           \
  template void World<Real>::measure_energy(bool);               \
  template void World<Real>::begin_balance();                    \
  template void World<Real>::take_reactions();                   \
  template void World<Real>::hold_present_state();               \
  template Vec3Array<Real> World<Real>::mean_velocities() const; \
  template World<Real> World<Real>::copy() const;                \
  template Reactions World<Real>::coming_reactions() const;      \
  template ComingStarts World<Real>::coming_bad_starts() const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
