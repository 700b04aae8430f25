// One tick of the implicit solver: substeps, energy checks and contact.

#include "core/solver/implicit/implicit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "core/geometry/exact_origin.h"
#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/implicit_step.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Discards the history of particles that were moved between ticks.
/// @param dt,tick  lengths of a substep and of the tick [s]
template <class Real>
void check_history(const ClothState<Real>& state, double dt, double tick,
                   ImplicitWorkspace<Real>& work) {
  assert(work.history.size() == state.x.size() && work.last_end.x.size() == state.x.size());
  const bool same_step = work.last_dt == dt;
  bool all_same = same_step;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const bool same = state.x[i] == work.last_end.x[i] && state.v[i] == work.last_end.v[i];
    if (!same_step || !same || !(state.inverse_mass[i] > 0)) work.history[i] = 0;
    all_same = all_same && same;
  }
  work.credit = all_same ? work.credit / (1 + tick / kKeptCreditSeconds) : 0;
  work.last_dt = dt;
}

template <class Real>
EnergyReading energies_at(const Step<Real>& step, const Vec3Array<Real>& x,
                          const Vec3Array<Real>& v) {
  const StageTimer timer(step.profile, Stage::diagnostics, 1);
  const ElasticEnergy elastic = step.work.energy.elastic_energy(step.model, x);
  EnergyReading reading;
  reading.largest_strain = elastic.largest_strain;
  Energies& e = reading.energies;
  e.stretch = elastic.stretch;
  e.bending = elastic.bending;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto mass = static_cast<double>(step.model.mass[i]);
    e.kinetic += 0.5 * mass * static_cast<double>(v[i].squaredNorm());
    e.gravity -= mass * static_cast<double>(step.surroundings.gravity.dot(x[i]));
  }
  return reading;
}

/// Energy that damping took over the present displacements [J].
template <class Real>
double damping_work(const Step<Real>& step) {
  double sum = 0;
  for (std::size_t i = 0; i < step.work.displacement.size(); ++i)
    sum += static_cast<double>(step.model.mass[i] * step.work.v[i].dot(step.work.displacement[i]));
  return step.surroundings.damping * sum;
}

/// Whether the energy after a substep has a source; if so, updates the credit of lost energy.
bool explained(const Energies& before, const Energies& after, double work, double& credit) {
  const double excess = after.total() - before.total() - work - credit;
  const double rounding = kRoundingEnergy * (before.mechanical() + std::abs(work) + 1e-9);
  if (!(excess <= rounding)) return false;
  credit = std::max(0.0, -excess);
  return true;
}

/// Absolute work of the air on all particles over the present displacements [J].
template <class Real>
double air_turnover(const Step<Real>& step) {
  if (!step.surroundings.air) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < step.work.displacement.size(); ++i)
    sum += std::abs(static_cast<double>(step.work.air[i].dot(step.work.displacement[i])));
  return sum;
}

/// Whether the substep added energy to a torn or violently shaken cloth, or took much of its
/// energy. Errors of the air's own work do not count.
/// @param sound  it added none
template <class Real>
bool is_violent(const Step<Real>& step, const EnergyReading& before, const EnergyReading& after,
                double work, bool sound) {
  const double had = before.energies.mechanical();
  if (!(had > step.work.violent_energy)) return false;
  if (!(std::max(before.largest_strain, after.largest_strain) > kViolentStrain)) return false;
  const double lost = before.energies.total() + work - after.energies.total() - damping_work(step);
  return !sound || lost > kViolentLoss * had + air_turnover(step);
}

/// Sees where each part starts from near it: displacements change that in finer steps than the
/// model's floats, and such steps, in stiff cloth, are forces.
template <class Real>
void see_from_near(Step<Real>& step) {
  const Vec3Array<Real>& x = step.state.x;
  for (const ClothPart<Real>& part : step.model.parts) {
    const auto first = static_cast<std::size_t>(part.particles.first);
    const auto count = static_cast<std::size_t>(part.particles.count);
    if (count == 0) continue;
    const Vec3<Real> origin = exact_origin<Real>(std::span(x).subspan(first, count));
    for (std::size_t i = first; i < first + count; ++i) step.work.start_near[i] = x[i] - origin;
  }
}

/// Divides a substep into pieces of backward Euler; sets `work.displacement`, `x` and `v` at its
/// end.
/// @returns whether all linear systems were solved
template <class Real>
bool solve_in_pieces(Step<Real>& step, Real begin, Real end, int pieces, double& brought) {
  assert(pieces >= 1 && begin < end);
  ImplicitWorkspace<Real>& work = step.work;
  ClothState<Real>& state = step.state;
  work.start.x = state.x;
  work.start.v = state.v;
  const Real whole = step.dt;
  step.dt = whole / static_cast<Real>(pieces);
  step.damped = true;
  bool solved = true;
  brought = 0;
  step.flows = {};
  take_back_forces(step);
  for (int k = 1; k <= pieces; ++k) {
    const Real passed = static_cast<Real>(k) / static_cast<Real>(pieces);
    see_from_near(step);
    solved = solve_displacements(step, begin + (end - begin) * passed) && solved;
    brought += outer_work(step);
    meter_displacements(step);
    book_forces(step);
    state.x = work.x;
    state.v = work.v;
  }
  for (std::size_t i = 0; i < state.x.size(); ++i)
    work.displacement[i] = work.x[i] - work.start.x[i];
  state.x = work.start.x;
  state.v = work.start.v;
  step.dt = whole;
  return solved;
}

/// Displacements of a substep that adds no energy without a source.
/// @param after    receives the resulting energies
/// @param brought  receives the work of air, sling impulses and hands [J]
/// @returns        false if there are none, or if the substep is violent and refused
template <class Real>
bool solve_soundly(Step<Real>& step, Real begin, Real end, const EnergyReading& before,
                   EnergyReading& after, double& brought) {
  ImplicitWorkspace<Real>& work = step.work;
  step.damped = false;
  see_from_near(step);
  bool solved = solve_displacements(step, end);
  brought = outer_work(step);
  step.flows = {};
  meter_displacements(step);
  book_forces(step);
  for (int pieces = 1;; pieces *= 2) {
    after = energies_at(step, work.x, work.v);
    const bool sound = solved && explained(before.energies, after.energies, brought, work.credit);
    if (work.refuses && is_violent(step, before, after, brought, sound)) {
      work.status = ImplicitStatus::violent;
      return false;
    }
    if (sound) return true;
    if (pieces > kMostPieces) return solved;
    solved = solve_in_pieces(step, begin, end, pieces, brought);
  }
}

/// Whether a particle moves so far relative to the others in a substep that the guard would have to
/// search half of the cloth for it, and would stop it early.
template <class Real>
bool moves_far(const Step<Real>& step, const Collision<Real>& collision) {
  if (!collision.guard) return false;
  const Vec3Array<Real>& displacements = step.work.displacement;
  Vec3<Real> mean = Vec3<Real>::Zero();
  for (const Vec3<Real>& displacement : displacements) mean += displacement;
  mean /= static_cast<Real>(displacements.size());
  const auto far = static_cast<Real>(step.work.far_displacement);
  return std::any_of(displacements.begin(), displacements.end(),
                     [&mean, far](const Vec3<Real>& displacement) {
                       return (displacement - mean).squaredNorm() > far * far;
                     });
}

/// Moves by the displacements as far as contact allows. An unobstructed particle has the scheme's
/// final velocity; an obstructed one has the mean velocity, and loses its history.
/// @returns the motion that contact must not see, if there is one; nothing has moved then
template <class Real>
std::optional<BlowUp> move(Step<Real>& step, const Collision<Real>& collision) {
  ClothState<Real>& state = step.state;
  ImplicitWorkspace<Real>& work = step.work;
  collision.before_kick(state);
  std::swap(state.v, work.last_v);  // the previous velocities
  if (collision.empty()) {
    std::copy(work.v.begin(), work.v.end(), state.v.begin());
    std::copy(work.x.begin(), work.x.end(), state.x.begin());
    std::copy(work.displacement.begin(), work.displacement.end(), work.last_displacement.begin());
    for (std::size_t i = 0; i < state.x.size(); ++i) work.history[i] = !step.damped;
    return std::nullopt;
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) state.v[i] = work.displacement[i] / step.dt;
  if (collision.meter) collision.meter->pulled(state.v);
  collision.drive_pins(state, step.dt);
  if (const auto found = find_blow_up(step.model, state, step.dt)) return found;
  collision.before_drift(state, step.dt, step.profile);
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * step.dt;
  collision.after_drift(state, step.dt, step.profile);
  if (collision.meter)
    collision.meter->add_contact(step.model, state, collision.objects, collision.guard != nullptr);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const bool free = state.v[i] == (work.displacement[i] / step.dt).eval();
    work.history[i] = free && !step.damped && step.movable(i);
    if (!free) continue;
    state.v[i] = work.v[i];
    work.last_displacement[i] = work.displacement[i];
  }
  return std::nullopt;
}

}  // namespace

template <class Real>
void ImplicitWorkspace<Real>::prepare(const ClothModel<Real>& model) {
  systems.clear();
  energy.prepare(model);
  std::size_t longest = 0;
  for (const ClothPart<Real>& part : model.parts) {
    if (GridSystem<Real>::fits(model, part))
      systems.push_back(GridSystem<Real>(model, part));
    else
      systems.push_back(ElementSystem<Real>(model, part));
    longest = std::max(longest, std::visit([](const auto& s) { return s.size(); }, systems.back()));
  }
  for (Vec3Array<Real>* array :
       {&displacement, &x, &v, &start_near, &near, &force, &air, &last_displacement, &last_v,
        &last_end.x, &last_end.v, &start.x, &start.v})
    array->assign(model.mass.size(), Vec3<Real>::Zero());
  history.assign(model.mass.size(), 0);
  inertia.assign(model.mass.size(), Real(0));
  air_blocks.assign(model.mass.size(), {});
  starts.assign(model.parts.size(), 0);
  for (GridVector<Real>* vector : {&residual, &step, &direction, &product, &preconditioned})
    vector->assign(longest, Real(0));
  last_dt = credit = 0;
  double lengths = 0, mass = 0;
  for (const Edge& edge : model.edges) {
    const auto end = [&](std::size_t k) {
      return model.rest_positions[static_cast<std::size_t>(edge[k])];
    };
    lengths += static_cast<double>((end(0) - end(1)).norm());
  }
  const double mean_length =
      lengths / static_cast<double>(std::max<std::size_t>(model.edges.size(), 1));
  far_displacement = kFarDisplacement * mean_length;
  for (const Real m : model.mass) mass += static_cast<double>(m);
  violent_energy = mass * kViolentSpeed * kViolentSpeed / 2;
}

template <class Real>
void ImplicitWorkspace<Real>::take_over(const Vec3Array<Real>& velocities) {
  assert(velocities.size() == last_end.v.size());
  for (std::size_t i = 0; i < last_end.v.size(); ++i) last_v[i] += velocities[i] - last_end.v[i];
  last_end.v = velocities;
}

template <class Real>
void ImplicitWorkspace<Real>::forget() {
  std::fill(history.begin(), history.end(), 0);
  last_dt = credit = 0;
}

template <class Real>
AdvanceResult advance_implicit(const ClothModel<Real>& model,
                               const Surroundings<Real>& surroundings, const ImplicitDef& solver,
                               double dt, int substeps, Grabs<Real>& grabs,
                               const Collision<Real>& collision, ClothState<Real>& state,
                               ImplicitWorkspace<Real>& work, Profile& profile) {
  assert(dt > 0 && substeps >= 1 && solver.iterations >= 1);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  assert(work.systems.size() == model.parts.size() && "prepared for this model");
  assert(!surroundings.air || surroundings.wind.size() == model.mass.size());
  Step<Real> step{model, surroundings, solver, static_cast<Real>(dt), grabs, state, work, profile};
  step.metered = collision.meter != nullptr;
  step.held = collision.held;
  AdvanceResult result;
  EnergyReading reading = energies_at(step, state.x, state.v);
  result.before = reading.energies;
  check_history(state, dt, dt * substeps, work);
  take_hands(step);
  for (typename ImplicitWorkspace<Real>::System& system : work.systems)
    std::visit([&](auto& s) { s.set_pinned(state.inverse_mass); }, system);
  work.status = ImplicitStatus::done;
  see_velocities(state.v, grabs);
  for (int s = 0; s < substeps; ++s) {
    stop_point();
    const Real count = static_cast<Real>(substeps), begin = static_cast<Real>(s) / count;
    const EnergyReading before = reading;
    double brought = 0;
    const Real end = static_cast<Real>(s + 1) / count;
    const bool solved = solve_soundly(step, begin, end, before, reading, brought);
    if (given_up(work.status)) return result;
    if (!solved) work.status = ImplicitStatus::unsolved;
    result.damped_substeps += step.damped ? 1 : 0;
    result.work += brought;
    if (step.metered) collision.meter->add(step.flows);
    finish_forces(step);
    if (work.refuses && moves_far(step, collision)) {
      work.status = ImplicitStatus::touching;
      return result;
    }
    result.blow_up = move(step, collision);
    if (result.blow_up) return result;
    if (work.refuses && collision.touches(state)) {
      work.status = ImplicitStatus::touching;
      return result;
    }
    if (!collision.empty()) reading = energies_at(step, state.x, state.v);
  }
  work.last_end.x = state.x;
  work.last_end.v = state.v;
  result.after = reading.energies;
  result.largest_strain = reading.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template struct ImplicitWorkspace<Real>;                                                    \
  template AdvanceResult advance_implicit(const ClothModel<Real>&, const Surroundings<Real>&, \
                                          const ImplicitDef&, double, int, Grabs<Real>&,      \
                                          const Collision<Real>&, ClothState<Real>&,          \
                                          ImplicitWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
