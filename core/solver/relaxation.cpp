// One tick of relaxation: prediction, sweeps, contact and velocities.

#include "core/solver/relaxation.h"

#include <algorithm>
#include <cassert>

#include "core/forces/force_pass.h"
#include "core/forces/rest_curve.h"
#include "core/solver/membrane_relaxation.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// One tick: constant inputs and changing state.
template <class Real>
struct Tick {
  const ClothModel<Real>& model;
  const Surroundings<Real>& surroundings;
  const RelaxationDef& solver;
  Real dt;
  Grabs<Real>& grabs;
  const Collision<Real>& collision;
  ClothState<Real>& state;
  RelaxationWorkspace<Real>& work;
  Profile& profile;
  double keeps = 1;  ///< fraction of a velocity that relaxation.damping leaves in a substep [1]

  bool has_external_forces() const { return surroundings.air || !idle(grabs); }
  bool compliant() const { return solver.compliance > 0; }
  int sweeps() const { return sweeps_taken(solver); }
};

/// Whether a part is swept row by row.
template <class Real>
bool in_rows(const Tick<Real>& tick, std::size_t part) {
  return tick.compliant() && tick.work.grids[part].fits();
}

/// Fraction of a velocity left by a substep without forces.
template <class Real>
double kept(const Tick<Real>& tick) {
  return tick.keeps / (1 + tick.surroundings.damping * static_cast<double>(tick.dt));
}

/// Everything that is a force, not a constraint, but gravity and the bending that is swept by rows.
template <class Real>
void evaluate_forces(Tick<Real>& tick, const HandStep<Real>& hands) {
  const ClothModel<Real>& model = tick.model;
  RelaxationWorkspace<Real>& work = tick.work;
  std::fill(work.force.begin(), work.force.end(), Vec3<Real>::Zero());
  {
    std::size_t stencils = 0;
    for (const ClothPart<Real>& part : model.parts) stencils += quadratic_stencil_count(part);
    const StageTimer timer(tick.profile, Stage::bending, model.hinges.size() + stencils);
    add_hinge_forces(model, tick.state.x, tick.state.v, work.force);
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      add_rest_curve_forces(model.parts[p], tick.state.x, work.force);
      if (in_rows(tick, p) || quadratic_stencil_count(model.parts[p]) == 0) continue;
      add_quadratic_bending_forces(model.parts[p], tick.state.x, work.force);
    }
  }
  if (!tick.has_external_forces()) return;
  std::fill(work.external.begin(), work.external.end(), Vec3<Real>::Zero());
  if (tick.surroundings.air) {
    const StageTimer timer(tick.profile, Stage::air, model.triangles.size());
    add_air_forces(model, tick.surroundings.wind, tick.surroundings.air_density, tick.state.x,
                   tick.state.v, work.external);
  }
  if (!idle(tick.grabs)) {
    const StageTimer timer(tick.profile, Stage::attachments,
                           tick.grabs.list.size() + tick.grabs.impulses.size());
    add_sling_forces(tick.grabs, work.external);
  }
  for (std::size_t i = 0; i < work.force.size(); ++i) work.force[i] += work.external[i];
  add_hand_forces(hands, static_cast<Real>(kept(tick)), tick.surroundings.gravity, tick.state,
                  tick.grabs, work.force);
}

template <class Real>
Prediction<Real> prediction(const Tick<Real>& tick) {
  return {static_cast<Real>(kept(tick)), tick.dt * tick.dt, tick.surroundings.gravity,
          tick.has_external_forces()};
}

/// Eq. (5), as displacements.
template <class Real>
void predict(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::integration, tick.state.x.size());
  const ClothState<Real>& state = tick.state;
  const Prediction<Real> step = prediction(tick);
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    if (in_rows(tick, p)) {
      GridRelaxation<Real>& grid = tick.work.grids[p];
      grid.load(state.x, state.v, tick.dt);
      if (step.forced) grid.load_force(tick.work.force);
      predict_grid(grid.view(), step);
      continue;
    }
    const IndexRange& range = tick.model.parts[p].particles;
    for (auto i = static_cast<std::size_t>(range.first); i < static_cast<std::size_t>(range.end());
         ++i) {
      const Real w = state.inverse_mass[i];
      Vec3<Real> displacement = Vec3<Real>::Zero();
      if (w != 0) {
        const Vec3<Real> acceleration = tick.work.force[i] * w + tick.surroundings.gravity;
        displacement = state.v[i] * tick.dt * step.keep + acceleration * step.dt2;
      }
      tick.work.wanted[i] = displacement;
    }
  }
}

/// Relaxes `count` rigid springs: first, first + step, ... Ends are at x + displacement.
template <class Real>
void sweep_rigid(Tick<Real>& tick, std::size_t first, std::size_t count, std::ptrdiff_t step) {
  const Vec3Array<Real>& x = tick.state.x;
  Vec3Array<Real>& displacement = tick.work.wanted;
  const std::vector<Real>& w = tick.state.inverse_mass;
  auto n = static_cast<std::ptrdiff_t>(first);
  for (; count > 0; --count, n += step) {
    const Spring<Real>& spring = tick.model.springs[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const Real mobility = w[i] + w[j];
    const Vec3<Real> delta = (x[j] - x[i]) + (displacement[j] - displacement[i]);
    const Real length = delta.norm();
    if (mobility == 0 || spring.stiffness == 0 || !(length > 0)) continue;
    const Real excess = Real(1) - spring.rest_length / length;
    displacement[i] += delta * (excess * (w[i] / mobility));
    displacement[j] -= delta * (excess * (w[j] / mobility));
  }
}

/// The same for compliant springs.
template <class Real>
void sweep_compliant(Tick<Real>& tick, std::size_t first, std::size_t count, std::ptrdiff_t step) {
  const auto softness = static_cast<Real>(tick.solver.compliance) / (tick.dt * tick.dt);
  const Vec3Array<Real>& x = tick.state.x;
  Vec3Array<Real>& displacement = tick.work.wanted;
  const std::vector<Real>& w = tick.state.inverse_mass;
  auto n = static_cast<std::ptrdiff_t>(first);
  for (; count > 0; --count, n += step) {
    const auto k = static_cast<std::size_t>(n);
    const Spring<Real>& spring = tick.model.springs[k];
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const Real mobility = w[i] + w[j];
    const Vec3<Real> delta = (x[j] - x[i]) + (displacement[j] - displacement[i]);
    const Real length = delta.norm();
    if (mobility == 0 || spring.stiffness == 0 || !(length > 0)) continue;
    const Real alpha = softness / spring.stiffness;
    Real& lambda = tick.work.multiplier[k];
    const Real dlambda = ((length - spring.rest_length) - alpha * lambda) / (mobility + alpha);
    lambda += dlambda;
    displacement[i] += delta * (dlambda / length * w[i]);
    displacement[j] -= delta * (dlambda / length * w[j]);
  }
}

/// The same for membrane triangles, which have no rigid form.
template <class Real>
void sweep_membrane(Tick<Real>& tick, const ClothPart<Real>& part, bool down) {
  assert(tick.compliant());
  const auto softness = static_cast<Real>(tick.solver.compliance) / (tick.dt * tick.dt);
  const Vec3Array<Real>& x = tick.state.x;
  Vec3Array<Real>& displacement = tick.work.wanted;
  const IndexRange& range = part.membrane;
  for (Index n = 0; n < range.count; ++n) {
    const auto at = static_cast<std::size_t>(down ? range.first + n : range.end() - 1 - n);
    const MembraneTriangle<Real>& t = tick.model.membrane[at];
    std::array<std::size_t, 3> i;
    std::array<Real, 3> w;
    for (std::size_t k = 0; k < 3; ++k) {
      i[k] = static_cast<std::size_t>(t.x[k]);
      w[k] = tick.state.inverse_mass[i[k]];
    }
    if (w[0] == 0 && w[1] == 0 && w[2] == 0) continue;
    const auto from_first = [&](std::size_t k) -> Vec3<Real> {
      return (x[i[k]] - x[i[0]]) + (displacement[i[k]] - displacement[i[0]]);
    };
    const MembraneStrain<Real> strain = membrane_strain<Real>(t, from_first(1), from_first(2));
    const std::array<Vec3<Real>, 3> moved = relax_membrane(
        part.membrane_tensor, t, softness, w, strain, tick.work.membrane_multiplier[at]);
    for (std::size_t k = 0; k < 3; ++k) displacement[i[k]] += moved[k];
  }
}

/// All sweeps of a substep over the springs of one part that is not swept row by row.
template <class Real>
void relax_part(Tick<Real>& tick, const IndexRange& springs) {
  const auto first = static_cast<std::size_t>(springs.first);
  const auto count = static_cast<std::size_t>(springs.count);
  assert(first + count <= tick.model.springs.size());
  if (count == 0) return;
  for (int s = 0; s < tick.sweeps(); ++s) {
    stop_point();
    const std::size_t begin = runs_forwards(s) ? first : first + count - 1;
    const std::ptrdiff_t step = runs_forwards(s) ? 1 : -1;
    if (tick.compliant())
      sweep_compliant(tick, begin, count, step);
    else
      sweep_rigid(tick, begin, count, step);
  }
}

template <class Real>
void sweep_rows(const SweepView<Real>& grid, int sweeps) {
  assert(sweeps >= 1);
  for (int s = 0; s < sweeps; ++s) {
    stop_point();
    sweep_grid(grid, runs_forwards(s), s == 0, s + 1 == sweeps);
  }
}

template <class Real>
void relax(Tick<Real>& tick) {
  const auto sweeps = static_cast<std::size_t>(tick.sweeps());
  const std::size_t elements = tick.model.springs.size() + tick.model.membrane.size();
  const StageTimer timer(tick.profile, Stage::relaxation, elements * sweeps);
  std::fill(tick.work.multiplier.begin(), tick.work.multiplier.end(), Real(0));
  std::fill(tick.work.membrane_multiplier.begin(), tick.work.membrane_multiplier.end(),
            Vec3<Real>::Zero());
  if (!tick.compliant()) {
    relax_part(tick, {0, static_cast<Index>(tick.model.springs.size())});
    return;
  }
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    GridRelaxation<Real>& grid = tick.work.grids[p];
    if (in_rows(tick, p)) {
      sweep_rows(grid.view(), tick.sweeps());
      grid.store_displacements(tick.work.wanted);
    } else {
      const ClothPart<Real>& part = tick.model.parts[p];
      relax_part(tick, part.springs);
      for (int s = 0; part.membrane.count > 0 && s < tick.sweeps(); ++s) {
        stop_point();
        sweep_membrane(tick, part, runs_forwards(s));
      }
    }
  }
}

/// Shows the meter, if there is one, what forces and sweeps together made of the velocities.
template <class Real>
void meter_sweeps(const Tick<Real>& tick) {
  if (!tick.collision.meter) return;
  const double dt = tick.dt;
  const Vec3Array<Real>* external = tick.has_external_forces() ? &tick.work.external : nullptr;
  tick.collision.meter->kicked(
      {kept(tick), dt, dt}, {&tick.surroundings, external, &tick.grabs, nullptr, Dashpots::hinges},
      tick.state.v);
}

/// Moves to the wanted positions, as far as contact allows.
/// @returns the motion that contact must not see, if there is one; nothing has moved then
template <class Real>
std::optional<BlowUp> move(Tick<Real>& tick) {
  ClothState<Real>& state = tick.state;
  Vec3Array<Real>& wanted = tick.work.wanted;
  if (tick.work.holds_back) hold_back(tick.model, tick.dt, wanted);
  for (std::size_t i = 0; i < state.x.size(); ++i) state.v[i] = wanted[i] / tick.dt;
  meter_sweeps(tick);
  if (tick.collision.empty()) {
    for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += wanted[i];
    return std::nullopt;
  }
  tick.collision.drive_pins(state, tick.dt);
  if (const auto found = find_blow_up(tick.model, state, tick.dt)) return found;
  tick.collision.before_drift(state, tick.dt, tick.profile);
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * tick.dt;
  // See keeps_velocity.
  tick.collision.after_drift(state, tick.dt, tick.profile, tick.compliant());
  return std::nullopt;
}

/// Whether the tick needs only the sweeps' own arrays.
template <class Real>
bool rows_alone(const Tick<Real>& tick) {
  if (tick.has_external_forces() || !tick.collision.empty() || tick.work.holds_back) return false;
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    if (!in_rows(tick, p)) return false;
  }
  return true;
}

/// All substeps of a tick that needs only the sweeps' own arrays.
template <class Real>
void advance_rows(Tick<Real>& tick, int substeps) {
  const auto times = static_cast<std::size_t>(substeps);
  const auto sweeps = static_cast<std::size_t>(tick.sweeps());
  std::size_t stencils = 0;
  for (const ClothPart<Real>& part : tick.model.parts) stencils += quadratic_stencil_count(part);
  tick.profile[Stage::bending].work += stencils * times;  // their time is part of integration
  const Prediction<Real> step = prediction(tick);
  WorkMeter<Real>* const meter = tick.collision.meter;
  for (std::size_t p = 0; p < tick.model.parts.size(); ++p) {
    GridRelaxation<Real>& grid = tick.work.grids[p];
    grid.load(tick.state.x, tick.state.v, tick.dt);
    for (int s = 0; s < substeps; ++s) {
      {
        const StageTimer timer(tick.profile, Stage::integration, 0);
        predict_grid(grid.view(), step);
      }
      {
        const StageTimer timer(tick.profile, Stage::relaxation, 0);
        sweep_rows(grid.view(), tick.sweeps());
      }
      const StageTimer timer(tick.profile, Stage::integration, 0);
      move_grid(grid.view());
      if (!meter) continue;
      meter->begin(tick.state);
      grid.store(tick.state.x, tick.state.v, tick.dt);
      meter->dragged(tick.model, tick.model.parts[p].particles, kept(tick), tick.state.v);
    }
    grid.store(tick.state.x, tick.state.v, tick.dt);
  }
  tick.profile[Stage::integration].work += tick.state.x.size() * times;
  tick.profile[Stage::relaxation].work += tick.model.springs.size() * sweeps * times;
}

/// Work of the external forces over the last move [J].
template <class Real>
double external_work(const Tick<Real>& tick) {
  if (!tick.has_external_forces()) return 0;
  double power = 0;
  for (std::size_t i = 0; i < tick.state.v.size(); ++i)
    power += static_cast<double>(tick.work.external[i].dot(tick.state.v[i]));
  return power * static_cast<double>(tick.dt);
}

template <class Real>
EnergyReading timed_energies(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::diagnostics, 1);
  return read_energies(tick.model, tick.state, tick.surroundings.gravity,
                       tick.work.energy.elastic_energy(tick.model, tick.state.x));
}

}  // namespace

template <class Real>
AdvanceResult advance_relaxation(const ClothModel<Real>& model,
                                 const Surroundings<Real>& surroundings,
                                 const RelaxationDef& solver, double dt,
                                 const SubstepRange& substeps, Grabs<Real>& grabs,
                                 const Collision<Real>& collision, ClothState<Real>& state,
                                 RelaxationWorkspace<Real>& work, Profile& profile) {
  assert(dt > 0 && substeps.count() >= 1 && substeps.end <= substeps.all && solver.sweeps >= 1);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  assert(state.inverse_mass.size() == model.mass.size());
  assert(work.force.size() == model.mass.size() && work.grids.size() == model.parts.size());
  Tick<Real> tick{model, surroundings, solver, static_cast<Real>(dt), grabs, collision,
                  state, work,         profile};
  tick.keeps = std::pow(1 - solver.damping, 1.0 / substeps.all);
  AdvanceResult result;
  if (substeps.opens()) result.before = timed_energies(tick).energies;
  const auto softness = static_cast<Real>(solver.compliance / (dt * dt));
  for (GridRelaxation<Real>& grid : work.grids) {
    if (tick.compliant() && grid.fits()) grid.set_masses(state.inverse_mass, softness);
  }
  const bool alone = rows_alone(tick);
  if (alone) advance_rows(tick, substeps.count());
  see_velocities(state.v, grabs);
  for (int s = substeps.first; !alone && s < substeps.end; ++s) {
    const auto count = static_cast<Real>(substeps.all);
    stop_point();
    collision.before_kick(state);
    if (collision.meter) collision.meter->begin(state);
    evaluate_forces<Real>(tick, {static_cast<Real>(s) / count, 1 / (tick.dt * count), tick.dt});
    predict(tick);
    relax(tick);
    result.blow_up = move(tick);
    if (result.blow_up) return result;
    note_resistance(state.v, grabs);
    const double pulled = work_of_hands(state.v, grabs);
    result.work += external_work(tick) + pulled;
    if (!collision.meter) continue;
    collision.meter->finish(model, state, collision.objects, collision.guard != nullptr, tick.dt);
    collision.meter->add({.hands = pulled});
  }
  if (!substeps.closes()) return result;
  const EnergyReading end = timed_energies(tick);
  result.after = end.energies;
  result.largest_strain = end.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                          \
  template AdvanceResult advance_relaxation(                                            \
      const ClothModel<Real>&, const Surroundings<Real>&, const RelaxationDef&, double, \
      const SubstepRange&, Grabs<Real>&, const Collision<Real>&, ClothState<Real>&,     \
      RelaxationWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
