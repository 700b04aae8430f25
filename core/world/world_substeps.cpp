// Number of substeps of a tick.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/cloth/membrane.h"
#include "core/error.h"
#include "core/forces/air/air.h"
#include "core/world/constants.h"
#include "core/world/substep_causes.h"
#include "core/world/world.h"

namespace weft {

template <class Real>
int World<Real>::choose_substeps(SolverKind kind, const EnvironmentDef& environment) const {
  assert(kind != SolverKind::automatic);
  if (kind == SolverKind::implicit) {
    const bool meets_any = contact_.guard || contact_.seed || !def_.colliders.empty();
    return refinement_ * std::max(def_.implicit.substeps, meets_any ? kFewestInContact : 1);
  }
  const int fewest =
      kind == SolverKind::relaxation ? def_.relaxation.substeps : def_.solver.min_substeps;
  long count = 0;
  for (const ClothPart<Real>& part : model_.parts)
    count = std::max(
        count, substeps_for(stability_bound(part, kind, environment), tick_seconds(), fewest));
  if (!grabs_.list.empty())
    count = std::max(count, substeps_for_hands(kind, environment, count, fewest));
  return static_cast<int>(refinement_ * std::min<long>(count, kMostSubsteps + 1));
}

template <class Real>
void World<Real>::refine_substeps(int factor) {
  assert(factor >= 1 && factor <= kMostRefinement);
  refinement_ = factor;
}

/// Hands do not need more substeps than the cloth for stability, but with more of them cloth that a
/// hand presses against an object or other cloth loses less of its motion. Small numbers are raised
/// as if hands were explicit springs.
template <class Real>
long World<Real>::substeps_for_hands(SolverKind kind, const EnvironmentDef& environment,
                                     long cloth_alone, int fewest) const {
  assert(cloth_alone >= 1 && fewest >= 1);
  const long most = std::max(cloth_alone * kHandSubstepFactor, kEnoughHandSubsteps);
  long count = 0;
  for (const ClothPart<Real>& part : model_.parts) {
    StabilityBound hands;
    for (const Grab<Real>& grab : grabs_.list) {
      if (!part.triangles.contains(grab.def.triangle)) continue;
      hands.omega2 += grab.bound.omega2;
      hands.damping_rate += grab.bound.damping_rate;
      count = std::max(count, std::min(most, substeps_for(grab.bound, tick_seconds(), fewest)));
    }
    if (hands.omega2 == 0) continue;
    StabilityBound together = stability_bound(part, kind, environment);
    together.omega2 += hands.omega2;
    together.damping_rate += hands.damping_rate;
    count = std::max(count,
                     std::min(kEnoughHandSubsteps, substeps_for(together, tick_seconds(), fewest)));
  }
  return count;
}

namespace {

/// How many times as many substeps verlet takes where stiffness changes within a substep, of
/// threads that lock or come free or are stretched far, and next to nothing damps.
double undamped_margin(const StabilityBound& bound) {
  const double ratio = bound.damping_rate / (2 * std::sqrt(bound.omega2));
  return 1 + kUndampedMargin * std::max(0.0, 1 - ratio / kDampsEnough);
}

}  // namespace

template <class Real>
StabilityBound World<Real>::stability_bound(const ClothPart<Real>& part, SolverKind kind,
                                            const EnvironmentDef& environment) const {
  StabilityBound bound{part.bounds.bending_omega2, part.bounds.bending_damping_rate};
  // Relaxation's velocities are those of half a substep ago. Damping them once a tick, down to a
  // fifth, adds energy to a mode of omega dt above the root of 2 (1 + 1/5).
  if (kind == SolverKind::relaxation && part.bending_time > 0) bound.omega2 *= 2;
  if (kind == SolverKind::verlet) {  // in verlet the membrane acts by forces too
    const double stretched =
        stretched_membrane_omega2(part.bounds, longest_thread(model_, part, state_.x));
    bound.omega2 += part.bounds.membrane_omega2 + part.bounds.locking_omega2 + stretched;
    bound.damping_rate += part.bounds.membrane_damping_rate +
                          static_cast<double>(part.membrane_tensor.shear_time) * stretched;
    if (part.locks.count > 0 || stretched > 0) bound.omega2 *= std::pow(undamped_margin(bound), 2);
  }
  if (is_calm(environment)) return bound;
  double speed2 = 0;
  for (Index i = part.particles.first; i < part.particles.end(); ++i)
    speed2 =
        std::max(speed2, static_cast<double>(state_.v[static_cast<std::size_t>(i)].squaredNorm()));
  bound.damping_rate +=
      air_damping_rate(environment, part.fabric, part.bounds.area_per_mass, std::sqrt(speed2));
  return bound;
}

namespace {

/// Throws DefinitionError if solving a part's dashpots of bending would take too many stages.
/// @param longest  relaxation time that does not [s]
template <class Real>
void refuse_slow_bending(const ClothPart<Real>& part, std::size_t place, double longest) {
  const double given = static_cast<double>(part.bending_time);
  if (!(given > longest)) return;
  const std::string most = rounded_text(longest * 0.995);
  const bool warp = part.fabric.bending_warp >= part.fabric.bending_weft;
  throw DefinitionError(cloth_field(place, "fabric.bending_damping"), rounded_text(given, 6),
                        "at most " + most + " s on this mesh in this tick, for " +
                            std::to_string(kMostDashpotStages) + " stages",
                        "a coarser mesh, a pin whose border is not close beside particles, or a "
                        "higher tick_rate allows more")
      .with(Range{0, std::stod(most)}, {warp ? "bending_warp" : "bending_weft",
                                        warp ? "bending_weft" : "bending_warp", "areal_density"});
}

}  // namespace

/// Throws DefinitionError if a tick would take too many substeps, or stages of solved dashpots.
template <class Real>
void World<Real>::refuse_too_stiff() const {
  for (std::size_t p = 0; p < model_.parts.size(); ++p)
    refuse_slow_bending(model_.parts[p], p,
                        solvers_.dashpots.longest_time(model_, p, tick_seconds()));
  const SolverKind kind = solver_of(def_);
  if (choose_substeps(kind) <= kMostSubsteps) return;
  EnvironmentDef vacuum = environment_;
  vacuum.air_density = 0;
  const std::string most = std::to_string(kMostSubsteps) + " substeps a tick";
  if (choose_substeps(kind, vacuum) <= kMostSubsteps)
    throw DefinitionError("environment", "more than " + most, "at most " + most,
                          "take weaker wind, thinner air or heavier cloth")
        .with({}, {"areal_density", "air_normal", "air_tangential"});
  const auto needed = [&](const ClothPart<Real>& part) {
    return substeps_for(stability_bound(part, kind, vacuum), tick_seconds(), 1);
  };
  std::size_t worst = 0;
  for (std::size_t p = 1; p < model_.parts.size(); ++p)
    if (needed(model_.parts[p]) > needed(model_.parts[worst])) worst = p;
  const SubstepCauses causes = substep_causes(model_.parts[worst], kind, tick_seconds());
  throw DefinitionError(cloth_field(worst, "fabric"), "more than " + most, "at most " + most,
                        std::string("lower the ") + (causes.damping ? "damping" : "stiffness") +
                            " or the resolution, or raise tick_rate")
      .with({}, causes.fields);
}

template <class Real>
TickCost World<Real>::cost_in(const EnvironmentDef& environment) const {
  return cost_of(solver_of(def_), environment);
}

template <class Real>
TickCost World<Real>::cost_of(SolverKind kind, const EnvironmentDef& environment) const {
  TickCost cost;
  cost.particles = static_cast<double>(model_.mass.size());
  cost.substeps = choose_substeps(kind, environment);
  cost.sweeps = sweeps_of(def_, kind);
  cost.damping = solvers_.dashpots.updates(model_, tick_seconds());
  cost.tick_rate = def_.tick_rate;
  return cost;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template int World<Real>::choose_substeps(SolverKind, const EnvironmentDef&) const;         \
  template void World<Real>::refine_substeps(int);                                            \
  template void World<Real>::refuse_too_stiff() const;                                        \
  template long World<Real>::substeps_for_hands(SolverKind, const EnvironmentDef&, long, int) \
      const;                                                                                  \
  template StabilityBound World<Real>::stability_bound(const ClothPart<Real>&, SolverKind,    \
                                                       const EnvironmentDef&) const;          \
  template TickCost World<Real>::cost_in(const EnvironmentDef&) const;                        \
  template TickCost World<Real>::cost_of(SolverKind, const EnvironmentDef&) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
