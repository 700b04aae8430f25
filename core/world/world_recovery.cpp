// Ends ticks early, and restores the state before them.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>

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
  if (const auto found = result.blow_up ? result.blow_up : find_blow_up(model_, state_, dt)) {
    d.cause = cause_of(*found);
    d.particle = found->particle;
    d.value = found->value;
    return d;
  }
  const bool finite = std::isfinite(result.before.total()) && std::isfinite(result.after.total()) &&
                      std::isfinite(result.work);
  // Relaxation keeps lengths, not energy: it has no bound to be judged by.
  const bool solved = kind != SolverKind::implicit || !implicit_.unsolved;
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
  account_ = checkpoint_.account;
  if (energy_) energy_->balance = checkpoint_.balance;
  assert(!sleep_.wanted() || checkpoint_.sleep);
  if (sleep_.wanted()) sleep_ = *checkpoint_.sleep;
  report_ = checkpoint_.report;
  report_.halted = true;
  touching_ = false;
  forget_motion();
  sleep_changed();
  last_good_.x = state_.x;
  last_good_.v = state_.v;
}

/// Clears the memory of solvers and contact, which no longer applies.
template <class Real>
void World<Real>::forget_motion() {
  verlet_.elastic.reset();
  std::fill(verlet_.at_rest.begin(), verlet_.at_rest.end(), std::nullopt);
  implicit_.forget();
  contact_.reset();
  contact_.place(colliders_);
  if (guard_) guard_->reset();
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template std::optional<Divergence> World<Real>::examine(const AdvanceResult&, SolverKind, int) \
      const;                                                                                     \
  template const TickReport& World<Real>::halt();                                                \
  template void World<Real>::keep_checkpoint();                                                  \
  template void World<Real>::go_back();                                                          \
  template void World<Real>::forget_motion();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
