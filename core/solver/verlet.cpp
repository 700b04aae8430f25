#include "core/solver/verlet.h"

#include <algorithm>
#include <array>

#include "core/solver/vector_passes.h"

namespace weft {
namespace {

/// v <- keep v + push (f/m + g)
template <class Real>
struct Kick {
  Real keep, push;
};

/// The three kicks of a tick. The opening and the closing one together are one full kick.
template <class Real>
struct Kicks {
  Kick<Real> opening, full, closing;

  Kicks(double dt, double drag) {
    const double lost = 0.5 * drag * dt;
    opening = {static_cast<Real>(1 / (1 + lost)), static_cast<Real>(0.5 * dt / (1 + lost))};
    full = {static_cast<Real>((1 - lost) / (1 + lost)), static_cast<Real>(dt / (1 + lost))};
    closing = {static_cast<Real>(1 - lost), static_cast<Real>(0.5 * dt)};
  }
};

/// One tick's constant inputs together with what it changes.
template <class Real>
struct Tick {
  const ClothModel<Real>& model;
  const Surroundings<Real>& surroundings;
  const SolverDef& solver;
  Real dt;
  Grabs<Real>& grabs;
  const Collision<Real>& collision;
  ClothState<Real>& state;
  VerletWorkspace<Real>& work;
  Profile& profile;

  bool pulled() const { return surroundings.air || !idle(grabs); }
};

/// Zeroes the forces on the particles of a part.
template <class Real>
void clear_part(const ClothPart<Real>& part, Vec3Array<Real>& force) {
  std::fill_n(force.begin() + part.particles.first, part.particles.count, Vec3<Real>::Zero());
}

/// Springs and bending of a part element by element.
template <class Real>
void evaluate_elements(Tick<Real>& tick, const ClothPart<Real>& part,
                       const Vec3Array<Real>& velocity) {
  const ClothModel<Real>& model = tick.model;
  Vec3Array<Real>& force = tick.work.internal;
  clear_part(part, force);
  const auto count = [](const IndexRange& range) { return static_cast<std::size_t>(range.count); };
  if (part.springs.count > 0) {
    const StageTimer timer(tick.profile, Stage::stretch, count(part.springs));
    add_spring_forces(model, part, tick.state.x, velocity, force);
  }
  if (part.hinges.count > 0) {
    const StageTimer timer(tick.profile, Stage::bending, count(part.hinges));
    add_hinge_forces(model, part, tick.state.x, velocity, force);
  }
  const std::size_t stencils = quadratic_stencil_count(part);
  if (stencils > 0) {
    const StageTimer timer(tick.profile, Stage::bending, stencils);
    add_quadratic_bending_forces(part, tick.state.x, force);
  }
}

/// Springs and quadratic bending of a part row by row, in one pass; its time is booked under
/// stretch.
template <class Real>
void evaluate_rows(Tick<Real>& tick, const ClothPart<Real>& part, GridPass<Real>& grid,
                   const Vec3Array<Real>& velocity) {
  const StageTimer timer(tick.profile, Stage::stretch,
                         static_cast<std::size_t>(part.springs.count));
  tick.profile[Stage::bending].work += quadratic_stencil_count(part);
  grid.load(tick.state.x, velocity);
  grid.compute_internal_forces(tick.work.internal);
}

/// The air on each part; overwrites the external forces.
template <class Real>
void evaluate_air(Tick<Real>& tick, const Vec3Array<Real>& velocity) {
  const StageTimer timer(tick.profile, Stage::air, tick.model.triangles.size());
  const Surroundings<Real>& around = tick.surroundings;
  Vec3Array<Real>& force = tick.work.external;
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    const ClothPart<Real>& part = tick.model.parts[p];
    if (tick.work.grids[p].fits()) {
      tick.work.grids[p].compute_air_forces(around.air_density, force);
      continue;
    }
    clear_part(part, force);
    add_air_forces(tick.model, part, around.wind, around.air_density, tick.state.x, velocity,
                   force);
  }
}

/// All forces at the present positions, with `velocity` as seen by dashpots and air.
template <class Real>
void evaluate_forces(Tick<Real>& tick, Real progress, const Vec3Array<Real>& velocity) {
  VerletWorkspace<Real>& work = tick.work;
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    if (work.grids[p].fits())
      evaluate_rows(tick, tick.model.parts[p], work.grids[p], velocity);
    else
      evaluate_elements(tick, tick.model.parts[p], velocity);
  }
  if (!tick.pulled()) return;
  if (tick.surroundings.air)
    evaluate_air(tick, velocity);
  else
    std::fill(work.external.begin(), work.external.end(), Vec3<Real>::Zero());
  if (!idle(tick.grabs)) {
    const std::size_t hands = tick.grabs.list.size() + tick.grabs.shots.size();
    const StageTimer timer(tick.profile, Stage::attachments, hands);
    add_grab_forces(progress, tick.state, tick.grabs, work.external);
  }
}

/// Spreads masses and gravity over the numbers of the cloth; pins change both.
template <class Real>
void spread_constants(Tick<Real>& tick) {
  const std::vector<Real>& inverse_mass = tick.state.inverse_mass;
  for (std::size_t i = 0; i < inverse_mass.size(); ++i) {
    tick.work.inverse_mass[i].setConstant(inverse_mass[i]);
    tick.work.gravity[i] = inverse_mass[i] == 0 ? Vec3<Real>::Zero() : tick.surroundings.gravity;
  }
}

template <class Real>
void kick(Tick<Real>& tick, const Kick<Real>& k, const Vec3Array<Real>& from, Vec3Array<Real>& to) {
  const StageTimer timer(tick.profile, Stage::integration, from.size());
  const VerletWorkspace<Real>& work = tick.work;
  KickPass<Real> pass;
  pass.count = 3 * from.size();
  pass.from = from.data()->data();
  pass.to = to.data()->data();
  pass.internal = work.internal.data()->data();
  pass.external = tick.pulled() ? work.external.data()->data() : nullptr;
  pass.inverse_mass = work.inverse_mass.data()->data();
  pass.gravity = work.gravity.data()->data();
  pass.keep = k.keep;
  pass.push = k.push;
  run_kick(pass);
}

/// Kicks with the dashpots' velocity found by fixed-point sweeps.
/// @param share  where between the old and the new velocity the instant of the forces lies
template <class Real>
void swept_kick(Tick<Real>& tick, const Kick<Real>& k, Real share, Real progress) {
  Vec3Array<Real>& v = tick.state.v;
  if (tick.solver.damping_sweeps == 1) {
    evaluate_forces(tick, progress, v);
    kick(tick, k, v, v);
    return;
  }
  Vec3Array<Real>& estimate = tick.work.velocity;
  estimate = v;
  for (int sweep = 1; sweep <= tick.solver.damping_sweeps; ++sweep) {
    evaluate_forces(tick, progress, estimate);
    if (sweep == tick.solver.damping_sweeps) break;
    kick(tick, k, v, estimate);
    for (std::size_t i = 0; i < v.size(); ++i)
      estimate[i] = v[i] * (Real(1) - share) + estimate[i] * share;
  }
  kick(tick, k, v, v);
}

template <class Real>
void drift(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::integration, 0);
  run_drift(3 * tick.state.x.size(), tick.state.v.data()->data(), tick.dt,
            tick.state.x.data()->data());
}

/// Work of the external forces over the coming drift [J].
template <class Real>
double external_work(const Tick<Real>& tick) {
  if (!tick.pulled()) return 0;
  // Four sums, so that the compiler may keep them in one vector.
  std::array<double, 4> sums{};
  const Real *force = tick.work.external.data()->data(), *v = tick.state.v.data()->data();
  const std::size_t numbers = 3 * tick.state.v.size(), whole = numbers / 4 * 4;
  for (std::size_t n = 0; n < whole; n += 4) {
    for (std::size_t k = 0; k < 4; ++k) sums[k] += static_cast<double>(force[n + k] * v[n + k]);
  }
  for (std::size_t n = whole; n < numbers; ++n) sums[0] += static_cast<double>(force[n] * v[n]);
  const double power = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  return power * static_cast<double>(tick.dt);
}

template <class Real>
EnergyReading timed_energies(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::diagnostics, 1);
  std::optional<ElasticEnergy>& elastic = tick.work.elastic;
  if (!elastic) elastic = elastic_energy(tick.model, tick.state.x);
  return read_energies(tick.model, tick.state, tick.surroundings.gravity, *elastic);
}

}  // namespace

template <class Real>
void VerletWorkspace<Real>::prepare(const ClothModel<Real>& model) {
  for (Vec3Array<Real>* array : {&internal, &external, &velocity, &inverse_mass, &gravity})
    array->assign(model.mass.size(), Vec3<Real>::Zero());
  grids.assign(model.parts.size(), {});
  for (std::size_t p = 0; p < grids.size(); ++p) grids[p].prepare(model.parts[p]);
}

template <class Real>
AdvanceResult advance_verlet(const ClothModel<Real>& model, const Surroundings<Real>& surroundings,
                             const SolverDef& solver, double dt, int substeps, Grabs<Real>& grabs,
                             const Collision<Real>& collision, ClothState<Real>& state,
                             VerletWorkspace<Real>& work, Profile& profile) {
  Tick<Real> tick{model, surroundings, solver, static_cast<Real>(dt), grabs, collision,
                  state, work,         profile};
  const Kicks<Real> kicks(dt, surroundings.drag);
  if (surroundings.air) {
    for (GridPass<Real>& grid : work.grids) {
      if (grid.fits()) grid.load_wind(surroundings.wind);
    }
  }
  AdvanceResult result;
  spread_constants(tick);
  result.before = timed_energies(tick).energies;
  evaluate_forces(tick, Real(0), state.v);
  kick(tick, kicks.opening, state.v, state.v);
  for (int s = 0; s < substeps; ++s) {
    collision.before_drift(state, tick.dt, profile);
    result.work += external_work(tick);
    drift(tick);
    collision.after_drift(state, tick.dt, profile);
    const bool last = s + 1 == substeps;
    const Real progress = static_cast<Real>(s + 1) / static_cast<Real>(substeps);
    swept_kick(tick, last ? kicks.closing : kicks.full, last ? Real(1) : Real(0.5), progress);
  }
  collision.settle(state, tick.dt, profile);
  work.elastic.reset();
  const EnergyReading end = timed_energies(tick);
  result.after = end.energies;
  result.largest_strain = end.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                           \
  template struct VerletWorkspace<Real>;                                                 \
  template AdvanceResult advance_verlet(                                                 \
      const ClothModel<Real>&, const Surroundings<Real>&, const SolverDef&, double, int, \
      Grabs<Real>&, const Collision<Real>&, ClothState<Real>&, VerletWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
