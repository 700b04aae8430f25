#include "core/solver/relaxation.h"

#include <algorithm>
#include <cmath>

#include "core/forces/force_pass.h"

namespace weft {
namespace {

/// One tick's constant inputs together with what it changes.
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

  bool pulled() const { return surroundings.air || !idle(grabs); }
};

/// Everything that is a force and no constraint, gravity excepted.
template <class Real>
void evaluate_forces(Tick<Real>& tick, Real progress) {
  const ClothModel<Real>& model = tick.model;
  RelaxationWorkspace<Real>& work = tick.work;
  std::fill(work.force.begin(), work.force.end(), Vec3<Real>::Zero());
  {
    std::size_t stencils = 0;
    for (const ClothPart<Real>& part : model.parts) stencils += quadratic_stencil_count(part);
    const StageTimer timer(tick.profile, Stage::bending, model.hinges.size() + stencils);
    add_hinge_forces(model, tick.state.x, tick.state.v, work.force);
    if (stencils > 0) add_quadratic_bending_forces(model, tick.state.x, work.force);
  }
  if (!tick.pulled()) return;
  std::fill(work.external.begin(), work.external.end(), Vec3<Real>::Zero());
  if (tick.surroundings.air) {
    const StageTimer timer(tick.profile, Stage::air, model.triangles.size());
    add_air_forces(model, tick.surroundings.wind, tick.surroundings.air_density, tick.state.x,
                   tick.state.v, work.external);
  }
  if (!idle(tick.grabs)) {
    const std::size_t hands = tick.grabs.list.size() + tick.grabs.shots.size();
    const StageTimer timer(tick.profile, Stage::attachments, hands);
    add_grab_forces(progress, tick.state, tick.grabs, work.external);
  }
  for (std::size_t i = 0; i < work.force.size(); ++i) work.force[i] += work.external[i];
}

/// Eq. (5), into `wanted`.
template <class Real>
void predict(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::integration, tick.state.x.size());
  const ClothState<Real>& state = tick.state;
  const auto dt = static_cast<double>(tick.dt);
  const Real keep =
      static_cast<Real>((1 - tick.solver.damping) / (1 + tick.surroundings.drag * dt));
  const Real dt2 = tick.dt * tick.dt;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Real w = state.inverse_mass[i];
    tick.work.wanted[i] = state.x[i];
    if (w == 0) continue;
    const Vec3<Real> acceleration = tick.work.force[i] * w + tick.surroundings.gravity;
    tick.work.wanted[i] += state.v[i] * tick.dt * keep + acceleration * dt2;
  }
}

/// Relaxes springs first, first + step, ... until `end`.
template <class Real>
void sweep(Tick<Real>& tick, std::size_t first, std::size_t count, std::ptrdiff_t step) {
  const auto softness = static_cast<Real>(tick.solver.compliance) / (tick.dt * tick.dt);
  Vec3Array<Real>& x = tick.work.wanted;
  const std::vector<Real>& w = tick.state.inverse_mass;
  auto n = static_cast<std::ptrdiff_t>(first);
  for (; count > 0; --count, n += step) {
    const auto k = static_cast<std::size_t>(n);
    const Spring<Real>& spring = tick.model.springs[k];
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const Real mobility = w[i] + w[j];
    const Vec3<Real> delta = x[j] - x[i];
    const Real length = delta.norm();
    if (mobility == 0 || spring.stiffness == 0 || !(length > 0)) continue;
    Real excess = Real(1) - spring.rest_length / length;
    if (softness > 0) {
      const Real alpha = softness / spring.stiffness;
      Real& lambda = tick.work.multiplier[k];
      const Real push = (excess * length - alpha * lambda) / (mobility + alpha);
      lambda += push;
      excess = push * mobility / length;
    }
    x[i] += delta * (excess * (w[i] / mobility));
    x[j] -= delta * (excess * (w[j] / mobility));
  }
}

template <class Real>
void relax(Tick<Real>& tick) {
  const std::size_t count = tick.model.springs.size();
  const auto sweeps = static_cast<std::size_t>(tick.solver.sweeps);
  const StageTimer timer(tick.profile, Stage::relaxation, count * sweeps);
  if (count == 0) return;
  std::fill(tick.work.multiplier.begin(), tick.work.multiplier.end(), Real(0));
  for (std::size_t s = 0; s < sweeps; ++s) {
    if (s % 2 == 0)
      sweep(tick, 0, count, 1);
    else
      sweep(tick, count - 1, count, -1);
  }
}

/// Takes the wanted positions, as far as contact lets them.
template <class Real>
void move(Tick<Real>& tick) {
  ClothState<Real>& state = tick.state;
  for (std::size_t i = 0; i < state.x.size(); ++i)
    state.v[i] = (tick.work.wanted[i] - state.x[i]) / tick.dt;
  if (tick.collision.empty()) {
    std::swap(state.x, tick.work.wanted);
    return;
  }
  tick.collision.before_drift(state, tick.dt, tick.profile);
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * tick.dt;
  tick.collision.after_drift(state, tick.dt, tick.profile);
}

/// Work of the external forces over the last move [J].
template <class Real>
double external_work(const Tick<Real>& tick) {
  if (!tick.pulled()) return 0;
  double power = 0;
  for (std::size_t i = 0; i < tick.state.v.size(); ++i)
    power += static_cast<double>(tick.work.external[i].dot(tick.state.v[i]));
  return power * static_cast<double>(tick.dt);
}

template <class Real>
EnergyReading timed_energies(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::diagnostics, 1);
  return read_energies(tick.model, tick.state, tick.surroundings.gravity);
}

}  // namespace

template <class Real>
void RelaxationWorkspace<Real>::prepare(const ClothModel<Real>& model) {
  for (Vec3Array<Real>* array : {&force, &external, &wanted})
    array->assign(model.mass.size(), Vec3<Real>::Zero());
  multiplier.assign(model.springs.size(), Real(0));
}

template <class Real>
AdvanceResult advance_relaxation(const ClothModel<Real>& model,
                                 const Surroundings<Real>& surroundings,
                                 const RelaxationDef& solver, double dt, int substeps,
                                 Grabs<Real>& grabs, const Collision<Real>& collision,
                                 ClothState<Real>& state, RelaxationWorkspace<Real>& work,
                                 Profile& profile) {
  Tick<Real> tick{model, surroundings, solver, static_cast<Real>(dt), grabs, collision,
                  state, work,         profile};
  AdvanceResult result;
  result.before = timed_energies(tick).energies;
  for (int s = 0; s < substeps; ++s) {
    evaluate_forces(tick, static_cast<Real>(s + 1) / static_cast<Real>(substeps));
    predict(tick);
    relax(tick);
    move(tick);
    result.work += external_work(tick);
  }
  const EnergyReading end = timed_energies(tick);
  result.after = end.energies;
  result.largest_strain = end.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                                  \
  template struct RelaxationWorkspace<Real>;                                                    \
  template AdvanceResult advance_relaxation(const ClothModel<Real>&, const Surroundings<Real>&, \
                                            const RelaxationDef&, double, int, Grabs<Real>&,    \
                                            const Collision<Real>&, ClothState<Real>&,          \
                                            RelaxationWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
