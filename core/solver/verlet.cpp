// One tick of verlet: forces, kicks, contact and drifts.

#include "core/solver/verlet.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/forces/rest_curve.h"
#include "core/solver/fused_steps.h"
#include "core/solver/vector_passes.h"
#include "core/solver/verlet_tick.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Membrane and quadratic bending of a part: by gathering, accounted to stretch, or element by
/// element.
template <class Real>
void evaluate_membrane(Tick<Real>& tick, std::size_t p, const Vec3Array<Real>& velocity) {
  const ClothPart<Real>& part = tick.part(p);
  Vec3Array<Real>& force = tick.work.internal;
  const std::size_t stencils = quadratic_stencil_count(part);
  if (tick.work.meshes[p].fits()) {
    const StageTimer timer(tick.profile, Stage::stretch, membrane_elements(part));
    tick.profile[Stage::bending].work += stencils;
    tick.work.meshes[p].compute_forces(tick.state.x, velocity, force);
    add_misfit_forces(part, tick.state.x, force);
    return;
  }
  std::fill_n(force.begin() + part.particles.first, part.particles.count, Vec3<Real>::Zero());
  if (membrane_elements(part) > 0) {
    const StageTimer timer(tick.profile, Stage::stretch, membrane_elements(part));
    add_spring_forces(tick.model, part, tick.state.x, velocity, force);
    add_membrane_forces(tick.model, part, tick.state.x, velocity, force);
  }
  if (stencils > 0) {
    const StageTimer timer(tick.profile, Stage::bending, stencils);
    add_quadratic_bending_forces(part, tick.state.x, force);
  }
}

/// Springs and bending of a part that is not a grid.
template <class Real>
void evaluate_elements(Tick<Real>& tick, std::size_t p, const Vec3Array<Real>& velocity) {
  const ClothPart<Real>& part = tick.part(p);
  evaluate_membrane(tick, p, velocity);
  if (part.locks.count > 0) {
    const StageTimer timer(tick.profile, Stage::stretch, size_of(part.locks));
    add_locking_forces(tick.model, part, tick.state.x, tick.work.internal);
  }
  const std::size_t curved = part.rest_curves.triangles.size();
  if (part.hinges.count == 0 && curved == 0) return;
  const StageTimer timer(tick.profile, Stage::bending, size_of(part.hinges) + curved);
  add_hinge_forces(tick.model, part, tick.state.x, velocity, tick.work.internal);
  add_rest_curve_forces(part, tick.state.x, tick.work.internal);
}

/// Forces of sling impulses and air. Grids store them as their external forces; the arrays of the
/// whole model contain them for all other parts, and for grids if `listed`.
template <class Real>
void evaluate_external_forces(Tick<Real>& tick, const Vec3Array<Real>& velocity, bool listed) {
  if (!tick.has_external_forces) return;
  const Surroundings<Real>& around = tick.surroundings;
  Vec3Array<Real>& force = tick.work.external;
  if (listed || !tick.work.all_grids) std::fill(force.begin(), force.end(), Vec3<Real>::Zero());
  if (around.air) {
    const StageTimer timer(tick.profile, Stage::air, 0);
    for (std::size_t p = 0; p < tick.parts(); ++p) {
      if (tick.sleeps(p)) continue;
      tick.profile[Stage::air].work += size_of(tick.part(p).triangles);
      if (tick.by_rows(p)) {
        tick.grid(p).compute_air_forces(around.air_density);
        if (listed) tick.grid(p).store_external(force);
      } else {
        add_air_forces(tick.model, tick.part(p), around.wind, around.air_density, tick.state.x,
                       velocity, force);
      }
    }
  }
  if (!tick.has_impulses) return;
  const StageTimer timer(tick.profile, Stage::attachments, tick.grabs.impulses.size());
  add_sling_forces(tick.grabs, force);
}

template <class Real>
KickLaw<Real> law_of(const Tick<Real>& tick, const Kick<Real>& k) {
  const Vec3<Real>& g = tick.surroundings.gravity;
  return {k.keep, k.scaled_dt, {g[0], g[1], g[2]}};
}

template <class Real>
void kick(Tick<Real>& tick, const IndexRange& range, const Kick<Real>& k,
          const Vec3Array<Real>& from, Vec3Array<Real>& to) {
  const StageTimer timer(tick.profile, Stage::integration, size_of(range));
  const VerletWorkspace<Real>& work = tick.work;
  assert(work.internal.size() == tick.model.mass.size());
  KickPass<Real> pass;
  pass.count = size_of(range);
  pass.from = numbers(range, from);
  pass.to = numbers(range, to);
  pass.internal = numbers(range, work.internal);
  pass.particles = {tick.state.inverse_mass.data() + range.first,
                    tick.has_external_forces ? numbers(range, work.external) : nullptr};
  pass.law = law_of(tick, k);
  run_kick(pass);
}

/// Membrane, bending and kick of a mesh in one pass, all accounted to stretch.
/// @param again  whether the last kick of the mesh was a substep ago
template <class Real>
void kick_mesh(Tick<Real>& tick, std::size_t p, const Kick<Real>& k, bool again) {
  const ClothPart<Real>& part = tick.part(p);
  const StageTimer timer(tick.profile, Stage::stretch, membrane_elements(part));
  tick.profile[Stage::bending].work += quadratic_stencil_count(part);
  tick.profile[Stage::integration].work += size_of(part.particles);
  const Real* const external =
      tick.has_external_forces ? tick.work.external.data()->data() : nullptr;
  tick.work.meshes[p].kick(law_of(tick, k), {tick.state.inverse_mass.data(), external},
                           tick.state.x, tick.state.v, again ? tick.dt : Real(0));
}

/// Forces and kick of all parts, with positions and velocities of the model up to date.
/// @param again  whether it is not the tick's first
template <class Real>
void advance_kick(Tick<Real>& tick, const Kick<Real>& k, bool again) {
  Vec3Array<Real>& v = tick.state.v;
  evaluate_external_forces(tick, v, tick.has_impulses || tick.collision.meter);
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.sleeps(p)) continue;
    if (tick.by_rows(p)) {
      if (tick.has_impulses) tick.grid(p).load_external(tick.work.external);
      advance_grid(tick, p, k, Real(0));
      tick.grid(p).store_velocities(v, tick.work.executor);
    } else if (tick.work.kicks_at_once(tick.model, p)) {
      kick_mesh(tick, p, k, again);
    } else {
      evaluate_elements(tick, p, v);
      kick(tick, tick.part(p).particles, k, v, v);
    }
  }
}

/// All forces at the present positions in the model's arrays; dashpots and air see `velocity`.
template <class Real>
void evaluate_forces(Tick<Real>& tick, const Vec3Array<Real>& velocity) {
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    const ClothPart<Real>& part = tick.part(p);
    if (tick.sleeps(p)) continue;
    if (!tick.by_rows(p)) {
      evaluate_elements(tick, p, velocity);
      continue;
    }
    const StageTimer timer(tick.profile, Stage::stretch, membrane_elements(part));
    tick.profile[Stage::bending].work += quadratic_stencil_count(part);
    tick.grid(p).take_over(tick.state.x, velocity, tick.work.executor);
    tick.grid(p).compute_internal_forces(tick.work.internal);
  }
  evaluate_external_forces(tick, velocity, true);
}

/// Kicks all cloths that are awake.
template <class Real>
void kick_awake(Tick<Real>& tick, const Kick<Real>& k, const Vec3Array<Real>& from,
                Vec3Array<Real>& to) {
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (!tick.sleeps(p)) kick(tick, tick.part(p).particles, k, from, to);
  }
}

/// Kicks with the dashpots' velocity found by fixed-point sweeps.
/// @param share  position of the forces' instant between the old and the new velocity
template <class Real>
void swept_kick(Tick<Real>& tick, const Kick<Real>& k, Real share) {
  if (tick.solver.damping_sweeps == 1) {
    hold_kick(tick, k, tick.state.v);
    advance_kick(tick, k, true);
    meter_kick(tick, k);
    return;
  }
  Vec3Array<Real>&v = tick.state.v, &estimate = tick.work.velocity;
  estimate = v;
  for (int sweep = 1; sweep <= tick.solver.damping_sweeps; ++sweep) {
    evaluate_forces(tick, estimate);
    if (sweep == tick.solver.damping_sweeps) break;
    kick_awake(tick, k, v, estimate);
    for (std::size_t i = 0; i < v.size(); ++i)
      estimate[i] = v[i] * (Real(1) - share) + estimate[i] * share;
  }
  hold_kick(tick, k, estimate);
  kick_awake(tick, k, v, v);
  meter_kick(tick, k, &estimate);
}

/// Work of the external forces on a range of particles over the coming drift [J].
template <class Real>
double external_work(const Tick<Real>& tick, const IndexRange& range) {
  if (!tick.has_external_forces) return 0;
  // Four sums, so that the compiler can keep them in one vector.
  std::array<double, 4> sums{};
  const Real *force = numbers(range, tick.work.external), *v = numbers(range, tick.state.v);
  const std::size_t count = 3 * size_of(range), whole = count / 4 * 4;
  for (std::size_t n = 0; n < whole; n += 4) {
    for (std::size_t k = 0; k < 4; ++k) sums[k] += static_cast<double>(force[n + k] * v[n + k]);
  }
  for (std::size_t n = whole; n < count; ++n) sums[0] += static_cast<double>(force[n] * v[n]);
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) * static_cast<double>(tick.dt);
}

/// Drifts all particles. @returns work of the external forces [J]
template <class Real>
double drift(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::integration, 0);
  Vec3Array<Real>&x = tick.state.x, &v = tick.state.v;
  keep_held(tick);
  const bool swept = tick.solver.damping_sweeps > 1;
  double work = 0;
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.sleeps(p)) continue;
    if (!tick.by_rows(p) || swept) work += external_work(tick, tick.part(p).particles);
    if (!tick.by_rows(p)) continue;
    const bool pulled = tick.has_external_forces && !swept;
    work += tick.grid(p).drift(tick.dt, pulled, v, x, tick.work.executor) *
            static_cast<double>(tick.dt);
  }
  drift_meshes(tick);
  return work;
}

template <class Real>
void opening_kick(Tick<Real>& tick, const Kick<Real>& k) {
  hold_kick(tick, k, tick.state.v);
  if (tick.solver.damping_sweeps == 1) {
    advance_kick(tick, k, false);
  } else {
    evaluate_forces(tick, tick.state.v);
    kick_awake(tick, k, tick.state.v, tick.state.v);
  }
  meter_kick(tick, k);
}

/// Pulls of the hands, after the kick before number `s` of `substeps`.
template <class Real>
void pull(Tick<Real>& tick, const Kick<Real>& k, int s, const SubstepRange& substeps) {
  if (!tick.has_hands) return;
  assert(s >= 0 && s <= substeps.count());
  const StageTimer timer(tick.profile, Stage::attachments, tick.grabs.list.size());
  const auto count = static_cast<Real>(substeps.all);
  pull_by_hand({static_cast<Real>(substeps.first + s) / count, 1 / (tick.dt * count), tick.dt},
               k.scaled_dt, k.force_ratio, tick.state, tick.grabs);
  if (tick.collision.meter) tick.collision.meter->pulled(tick.state.v);
  if (tick.collision.held) tick.collision.held->pull(tick.grabs, k.seconds);
}

/// Shows the meter, if there is one, the end of a drift [s], or of the tick.
template <class Real>
void meter_drift(const Tick<Real>& tick, Real seconds) {
  const Collision<Real>& c = tick.collision;
  if (c.meter)
    c.meter->finish(tick.model, tick.state, c.objects, c.guard != nullptr,
                    static_cast<double>(seconds));
}

/// Substeps in which hands or contact act between kick and drift, or work is metered.
/// @param blow_up  receives the motion that ended the tick before contact saw it
/// @returns work of hands and air [J]
template <class Real>
double advance_together(Tick<Real>& tick, const Kicks<Real>& kicks, const SubstepRange& substeps,
                        std::optional<BlowUp>& blow_up) {
  ClothState<Real>& state = tick.state;
  const Collision<Real>& collision = tick.collision;
  double work = 0;
  see_velocities(state.v, tick.grabs);
  NextCalm next;
  for (int s = 0; s < substeps.count(); ++s) {
    stop_point();
    work += advance_calm(tick, kicks, substeps.count(), s, next);
    if (s == substeps.count()) break;
    collision.before_kick(state);
    if (collision.meter) collision.meter->begin(state);
    if (s == 0)
      opening_kick(tick, kicks.opening);
    else
      swept_kick(tick, kicks.full, Real(0.5));
    const Kick<Real>& k = s == 0 ? kicks.opening : kicks.full;
    pull(tick, k, s, substeps);
    collision.drive_pins(state, tick.dt, k.force_ratio);
    if (!collision.empty()) blow_up = find_blow_up(tick.model, state, tick.dt, tick.work.executor);
    if (blow_up) return work;
    collision.before_drift(state, tick.dt, tick.profile, k.force_ratio);
    work += drift(tick);
    work += work_of_hands(state.v, tick.grabs);
    if (collision.after_drift(state, tick.dt, tick.profile))
      take_over_grids(tick, collision.seed != nullptr);
    meter_drift(tick, tick.dt);
  }
  collision.before_kick(state);
  if (collision.meter) collision.meter->begin(state);
  swept_kick(tick, kicks.closing, Real(1));
  pull(tick, kicks.closing, substeps.count(), substeps);
  collision.settle(state, tick.dt, tick.profile);
  meter_drift(tick, Real(0));
  work += work_of_hands(state.v, tick.grabs);
  return work;
}

/// Elastic energy at the present positions; of grids from their own arrays, which are up to date.
template <class Real>
ElasticEnergy present_energy(const Tick<Real>& tick) {
  ElasticEnergy sum;
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    std::optional<ElasticEnergy>& at_rest = tick.work.at_rest[p];
    if (!tick.sleeps(p)) at_rest.reset();
    const ElasticEnergy energy = at_rest ? *at_rest
                                 : tick.by_rows(p)
                                     ? tick.grid(p).elastic_energy()
                                     : elastic_energy(tick.model, tick.part(p), tick.state.x);
    if (tick.sleeps(p)) at_rest = energy;
    add(energy, sum);
  }
  return sum;
}

template <class Real>
EnergyReading timed_energies(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::diagnostics, 1);
  std::optional<ElasticEnergy>& elastic = tick.work.elastic;
  if (!elastic) {
    if (tick.solver.damping_sweeps > 1 || tick.collision.guard) take_over_grids(tick, true);
    elastic = present_energy(tick);
  }
  return read_energies(tick.model, tick.state, tick.surroundings.gravity, *elastic);
}

}  // namespace

template <class Real>
AdvanceResult advance_verlet(const ClothModel<Real>& model, const Surroundings<Real>& surroundings,
                             const SolverDef& solver, double dt, const SubstepRange& substeps,
                             Grabs<Real>& grabs, const Collision<Real>& collision,
                             ClothState<Real>& state, VerletWorkspace<Real>& work,
                             Profile& profile) {
  assert(dt > 0 && substeps.count() >= 1 && substeps.end <= substeps.all);
  assert(solver.damping_sweeps >= 1);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  assert(state.inverse_mass.size() == model.mass.size());
  assert(work.grids.size() == model.parts.size() && "prepared for this model");
  assert(!surroundings.air || surroundings.wind.size() == model.mass.size());
  const bool has_hands = !idle(grabs), has_impulses = !grabs.impulses.empty();
  Tick<Real> tick{model,   surroundings, solver,       static_cast<Real>(dt),
                  grabs,   collision,    state,        work,
                  profile, has_hands,    has_impulses, has_impulses || surroundings.air};
  const Kicks<Real> kicks(dt, surroundings.damping);
  if (surroundings.air) {
    for (GridPass<Real>& grid : work.grids) {
      if (grid.fits()) grid.load_wind(surroundings.wind);
    }
  }
  AdvanceResult result;
  for (GridPass<Real>& grid : work.grids) {
    if (grid.fits()) grid.load_inverse_mass(state.inverse_mass);
  }
  std::fill(work.remainder.begin(), work.remainder.end(), Vec3<Real>::Zero());
  load_grids(tick);
  if (substeps.opens()) result.before = timed_energies(tick).energies;
  if (collision.empty() && !collision.meter && !has_hands && work.all_grids &&
      solver.damping_sweeps == 1) {
    for (std::size_t p = 0; p < tick.parts(); ++p) {
      if (!tick.sleeps(p))
        result.work += advance_alone(tick, p, kicks, substeps.count());
      else if (collision.held)
        collision.held->act(p, surroundings, state.x, state.v, dt * substeps.count());
    }
  } else {
    result.work = advance_together(tick, kicks, substeps, result.blow_up);
  }
  if (result.blow_up) return result;
  work.elastic.reset();
  if (!substeps.closes()) return result;
  const EnergyReading end = timed_energies(tick);
  result.after = end.energies;
  result.largest_strain = end.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template AdvanceResult advance_verlet(const ClothModel<Real>&, const Surroundings<Real>&,      \
                                        const SolverDef&, double, const SubstepRange&,           \
                                        Grabs<Real>&, const Collision<Real>&, ClothState<Real>&, \
                                        VerletWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
