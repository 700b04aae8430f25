// Judges ticks, repeats or ends them, and restores the state before them.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>

#include "core/world/constants.h"
#include "core/world/implicit_alone.h"
#include "core/world/world.h"

namespace weft {
namespace {

std::string describe_cause(const Divergence& d) {
  switch (d.cause) {
    case DivergenceCause::not_finite:
      return "a value that is not finite";
    case DivergenceCause::too_fast:
      return "a speed of " + number_text(d.value) +
             " m/s, farther in a substep than the cloth is "
             "long,";
    case DivergenceCause::too_far:
      return "a distance of " + number_text(d.value) + " m from the origin";
    case DivergenceCause::energy_runaway:
      return "unexplained energy of " + number_text(d.value) + " J";
    case DivergenceCause::unsolved:
      return "a linear system that was not solved";
  }
  return {};
}

DivergenceCause cause_of(const BlowUp& blow_up) {
  switch (blow_up.kind) {
    case BlowUp::Kind::not_finite:
      return DivergenceCause::not_finite;
    case BlowUp::Kind::too_fast:
      return DivergenceCause::too_fast;
    case BlowUp::Kind::too_far:
      return DivergenceCause::too_far;
  }
  return DivergenceCause::not_finite;
}

/// Restores the hands' forces from before the tick that failed, whose own may not be finite; a hand
/// that took hold in it has none.
template <class Real>
void take_back_hands(const Grabs<Real>& before, Grabs<Real>& grabs) {
  for (Grab<Real>& grab : grabs.list) {
    grab.given.setZero();
    const auto known = std::find_if(before.list.begin(), before.list.end(),
                                    [&](const Grab<Real>& other) { return other.id == grab.id; });
    if (known != before.list.end()) {
      grab.impulse = known->impulse;
      grab.velocity = known->velocity;
      grab.force = known->force;
      grab.resisted = known->resisted;
    } else {
      for (Vec3Array<Real>* array : {&grab.impulse, &grab.velocity})
        std::fill(array->begin(), array->end(), Vec3<Real>::Zero());
      grab.force.setZero();
      grab.resisted.setZero();
    }
  }
}

/// Substeps of a tick that follows one after which the cloth was stopped: twice as many as that
/// could not be computed with, as long as a tick may have so many. With its usual number it would
/// fail like that one, for it begins in the same state, and the cloth would never move again.
int after_stop(const std::optional<Divergence>& last, std::size_t particles, int usual) {
  if (!last || last->remedy != DivergenceRemedy::stopped_cloth) return usual;
  const int more = 2 * last->substeps;
  return is_beyond_verlet(particles, more) ? std::max(usual, last->substeps)
                                           : std::max(usual, more);
}

}  // namespace

std::string describe(const Divergence& d) {
  const std::string what = describe_cause(d);
  const std::string done = d.remedy == DivergenceRemedy::more_substeps
                               ? "repeated with more substeps"
                               : "went back to the last good state and stopped the cloth";
  return "tick " + std::to_string(d.tick) + ": " + what + " at particle " +
         std::to_string(d.particle) + " with " + std::to_string(d.substeps) + " substeps; " + done;
}

template <class Real>
std::optional<Divergence> World<Real>::examine(const AdvanceResult& result, SolverKind kind,
                                               int substeps) const {
  assert(kind != SolverKind::automatic && substeps >= 1);
  Divergence d;
  d.tick = tick_ + 1;
  d.substeps = substeps;
  const auto dt = static_cast<Real>(tick_seconds() / substeps);
  if (const auto found =
          result.blow_up ? result.blow_up : find_blow_up(model_, state_, dt, runtime_.executor)) {
    d.cause = cause_of(*found);
    d.particle = found->particle;
    d.value = found->value;
    return d;
  }
  const bool finite = std::isfinite(result.before.total()) && std::isfinite(result.after.total()) &&
                      std::isfinite(result.work);
  // Relaxation keeps lengths, not energy: it has no bound to be judged by.
  const bool solved =
      kind != SolverKind::implicit || solvers_.implicit.status != ImplicitStatus::unsolved;
  if (finite && solved && (kind == SolverKind::relaxation || !account_.is_runaway(result)))
    return std::nullopt;
  d.cause = !finite   ? DivergenceCause::not_finite
            : !solved ? DivergenceCause::unsolved
                      : DivergenceCause::energy_runaway;
  d.value = finite ? account_.unexplained(result) : result.after.total();
  Real fastest = -1;
  for (std::size_t i = 0; i < state_.x.size(); ++i) {
    const Real speed2 = state_.v[i].squaredNorm();
    if (!std::isfinite(speed2) || !state_.x[i].allFinite()) {
      d.particle = static_cast<Index>(i);
      break;
    }
    if (speed2 > fastest) {
      fastest = speed2;
      d.particle = static_cast<Index>(i);
    }
  }
  return d;
}

/// Whether verlet has to do a tick of implicit again. What diverged counts as violent.
template <class Real>
bool World<Real>::leaves_to_verlet(const AdvanceResult& result, int substeps) {
  if (!solvers_.implicit.refuses) return false;
  ImplicitStatus& status = solvers_.implicit.status;
  if (!given_up(status) && examine(result, SolverKind::implicit, substeps))
    status = ImplicitStatus::violent;
  return given_up(status);
}

template <class Real>
void World<Real>::advance_or_recover(int substeps) {
  assert(substeps >= 1);
  SolverKind kind = solver_of(def_);
  const std::optional<Divergence>& before = checkpoint_.report.divergence;
  const std::size_t count = model_.mass.size();
  int without_loss = 0;
  if (kind != SolverKind::implicit) {
    substeps = after_stop(before, count, substeps);
  } else {
    without_loss = choose_substeps(SolverKind::verlet);
    const bool driven = pins_.any_moving();
    // Refined runs give the same ticks to verlet, so that they differ by their steps alone.
    solvers_.implicit.refuses =
        !is_beyond_verlet(count, (without_loss + refinement_ - 1) / refinement_);
    solvers_.implicit.status = ImplicitStatus::done;
    if (solvers_.implicit.refuses) without_loss = after_stop(before, count, without_loss);
    if ((solvers_.touching || driven) && solvers_.implicit.refuses) {
      solvers_.implicit.status = driven ? ImplicitStatus::driven : ImplicitStatus::touching;
      kind = SolverKind::verlet;
      substeps = without_loss;
    } else if (driven) {
      substeps = std::max(substeps, refinement_ * kFewestDriven);
    }
  }
  for (int attempt = 0;; ++attempt) {
    solvers_.relaxation.holds_back = attempt > 0;
    const AdvanceResult result = advance(kind, substeps);
    if (kind == SolverKind::implicit && leaves_to_verlet(result, substeps)) {
      restore_last_good();
      take_back_hands(checkpoint_.grabs, grabs_);
      kind = SolverKind::verlet;
      substeps = without_loss;
      --attempt;
      continue;
    }
    const StageTimer timer(report_.profile, Stage::diagnostics, 1);
    const std::optional<Divergence> divergence = examine(result, kind, substeps);
    report_.substeps = substeps;
    report_.energies = result.after;
    report_.work = result.work;
    report_.largest_strain = result.largest_strain;
    report_.damped_substeps = result.damped_substeps;
    report_.implicit = solvers_.implicit.status;
    if (!divergence) {
      account_.accept(result, tick_seconds());
      if (energy_) energy_->book(result, report_.brought);
      last_good_.x = state_.x;
      last_good_.v = state_.v;
      solvers_.touching = solver_of(def_) == SolverKind::implicit && collision().touches(state_);
      return;
    }
    report_.divergence = divergence;
    restore_last_good();
    take_back_hands(checkpoint_.grabs, grabs_);
    const bool last = attempt == kMostTickRetries || substeps > kMostSubsteps / 2;
    if (last && kind == SolverKind::implicit && without_loss <= refinement_ * kMostSubsteps) {
      // However many substeps it takes: a cloth that is stopped in each tick would never move.
      report_.divergence->remedy = DivergenceRemedy::more_substeps;
      solvers_.implicit.status = ImplicitStatus::violent;
      kind = SolverKind::verlet;
      substeps = without_loss;
      attempt = -1;
      continue;
    }
    if (last) {
      report_.divergence->remedy = DivergenceRemedy::stopped_cloth;
      for (Vec3<Real>& v : state_.v) v.setZero();
      bring_to_rest(pins_);
      accept_state();
      hold_present_state();
      if (energy_) {
        // The state that it went back to has what disturbances brought before the tick.
        energy_->balance.disturbances += report_.brought;
        energy_->balance.recovery += report_.brought;
        energy_->book_loss(report_.energies, energy_->balance.recovery);
      }
      return;
    }
    report_.divergence->remedy = DivergenceRemedy::more_substeps;
    substeps *= 2;
  }
}

template <class Real>
void World<Real>::restore_last_good() {
  assert(last_good_.x.size() == model_.mass.size() && last_good_.v.size() == model_.mass.size());
  state_.x = last_good_.x;
  state_.v = last_good_.v;
  take_back_motion(colliders_);
  take_back_velocities(checkpoint_.pins, pins_);
  forget_motion();
  for (std::size_t i = 0; i < state_.v.size(); ++i) {
    if (state_.inverse_mass[i] == 0) state_.v[i].setZero();  // pinned since that state was saved
  }
}

template <class Real>
const TickReport& World<Real>::halt() {
  keep_checkpoint();
  go_back();
  return report_;
}

/// Saves everything that a tick changes and that determines the future.
template <class Real>
void World<Real>::keep_checkpoint() {
  checkpoint_.state = state_;
  checkpoint_.pins = pins_;
  checkpoint_.grabs = grabs_;
  checkpoint_.colliders = colliders_;
  checkpoint_.grippers = grippers_;
  checkpoint_.scene_hands = scene_hands_;
  checkpoint_.wind = environment_.wind;
  checkpoint_.gusts_ahead = surroundings_.gusts_ahead;
  checkpoint_.account = account_;
  if (energy_) checkpoint_.balance = energy_->balance;
  if (sleep_.wanted()) checkpoint_.sleep = sleep_;
  checkpoint_.report = report_;
}

template <class Real>
void World<Real>::go_back() {
  assert(checkpoint_.state.x.size() == model_.mass.size() && "keep_checkpoint comes first");
  state_ = checkpoint_.state;
  pins_ = checkpoint_.pins;
  grabs_ = checkpoint_.grabs;
  colliders_ = checkpoint_.colliders;
  grippers_ = checkpoint_.grippers;
  scene_hands_ = checkpoint_.scene_hands;
  environment_.wind = checkpoint_.wind;
  surroundings_.gusts_ahead = checkpoint_.gusts_ahead;
  account_ = checkpoint_.account;
  if (energy_) energy_->balance = checkpoint_.balance;
  assert(!sleep_.wanted() || checkpoint_.sleep);
  if (sleep_.wanted()) sleep_ = *checkpoint_.sleep;
  report_ = checkpoint_.report;
  report_.halted = true;
  solvers_.touching = false;
  forget_motion();
  sleep_changed();
  last_good_.x = state_.x;
  last_good_.v = state_.v;
}

/// Clears the memory of solvers and contact, which no longer applies.
template <class Real>
void World<Real>::forget_motion() {
  solvers_.verlet.elastic.reset();
  std::fill(solvers_.verlet.at_rest.begin(), solvers_.verlet.at_rest.end(), std::nullopt);
  solvers_.implicit.forget();
  contact_.objects.reset();
  contact_.objects.place(colliders_);
  if (contact_.guard) contact_.guard->reset();
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template std::optional<Divergence> World<Real>::examine(const AdvanceResult&, SolverKind, int) \
      const;                                                                                     \
  template bool World<Real>::leaves_to_verlet(const AdvanceResult&, int);                        \
  template void World<Real>::advance_or_recover(int);                                            \
  template void World<Real>::restore_last_good();                                                \
  template const TickReport& World<Real>::halt();                                                \
  template void World<Real>::keep_checkpoint();                                                  \
  template void World<Real>::go_back();                                                          \
  template void World<Real>::forget_motion();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
