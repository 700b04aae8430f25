// Steps grids while contact cannot act, and returns if it might have.

#include "core/solver/fused_steps.h"

#include <cassert>

#include "core/solver/awake_cloths.h"
#include "core/solver/constants.h"
#include "core/solver/vector_passes.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// State of a run of steps without contact.
template <class Real>
struct Spell {
  const CalmPaths<Real>& paths;
  Real clearance;     ///< displacement that every particle may make during the run [m]
  Real begun;         ///< its start, in the time of the paths [s]
  Vec3<Real> common;  ///< common displacement from the paths at its start [m]
};

/// Bounding box of the displacements of all grids from their paths.
template <class Real>
Aabb<Real> box_off_paths(const Tick<Real>& tick, Real time) {
  Aabb<Real> box;
  for (std::size_t p = 0; p < tick.parts(); ++p) box.add(tick.grid(p).box_off_paths(time));
  return box;
}

template <class Real>
Real half_diagonal(const Aabb<Real>& box) {
  return (box.upper - box.lower).norm() / 2;
}

/// Bound of any particle's displacement since the start of the run: along its path, in common with
/// all others, and relative to both.
template <class Real>
Real farthest(const Spell<Real>& spell, const Aabb<Real>& box, Real time) {
  return spell.paths.fastest * (time - spell.begun) + (box.centre() - spell.common).norm() +
         2 * spell.paths.reach;
}

/// One substep of all grids, from kick to drift. @returns work of the air [J]
template <class Real>
double advance_grids(Tick<Real>& tick, const Kick<Real>& kick) {
  double work = 0;
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.has_external_forces) {
      const StageTimer timer(tick.profile, Stage::air, size_of(tick.part(p).triangles));
      tick.grid(p).compute_air_forces(tick.surroundings.air_density);
    }
    work += advance_grid(tick, p, kick, tick.dt);
  }
  return work;
}

/// Shows a kick where the forces of pins are wanted: the grids' particles that these depend on go
/// to the model's arrays, a few of all.
template <class Real>
void hold_grids(Tick<Real>& tick, const Kick<Real>& kick) {
  if (!tick.collision.held) return;
  for (std::size_t p = 0; p < tick.parts(); ++p)
    tick.grid(p).store(tick.collision.held->seen(p), tick.state.x, tick.state.v);
  hold_kick(tick, kick, tick.state.v);
}

/// As above, shown to the meter.
template <class Real>
double advance_metered(Tick<Real>& tick, const Kick<Real>& kick) {
  WorkMeter<Real>& meter = *tick.collision.meter;
  meter.begin(tick.state);
  const double work = advance_grids(tick, kick);
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.has_external_forces) tick.grid(p).store_external(tick.work.external);
    tick.grid(p).store(tick.state.x, tick.state.v, tick.work.executor);
  }
  meter_kick(tick, kick);
  meter.finish(tick.model, tick.state, nullptr, true, static_cast<double>(tick.dt));
  return work;
}

/// Whether a run may begin: only grids, the guard and objects take part, and all cloths are awake.
template <class Real>
bool may_be_calm(const Tick<Real>& tick) {
  const Collision<Real>& c = tick.collision;
  if (!c.guard || c.seed || c.pins || tick.has_hands || !tick.work.all_grids) return false;
  if (tick.solver.damping_sweeps > 1) return false;
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.sleeps(p)) return false;
  }
  return true;
}

}  // namespace

/// Springs, bending, kick and drift of a grid in one pass, all accounted to stretch.
/// @returns work of the external forces over the drift [J]
template <class Real>
double advance_grid(Tick<Real>& tick, std::size_t p, const Kick<Real>& k, Real drift) {
  assert(tick.by_rows(p) && drift >= 0);
  const ClothPart<Real>& part = tick.part(p);
  const StageTimer timer(tick.profile, Stage::stretch, size_of(part.springs));
  tick.profile[Stage::bending].work += quadratic_stencil_count(part);
  tick.profile[Stage::integration].work += size_of(part.particles);
  const Vec3<Real>& g = tick.surroundings.gravity;
  const double power = tick.grid(p).advance(
      {k.keep, k.scaled_dt, {g[0], g[1], g[2]}, drift, tick.has_external_forces},
      tick.work.executor);
  return power * static_cast<double>(drift);
}

template <class Real>
void load_grids(Tick<Real>& tick) {
  const StageTimer timer(tick.profile, Stage::integration, 0);
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (tick.by_rows(p) && !tick.rests(p))
      tick.grid(p).load(tick.state.x, tick.state.v, tick.work.executor);
  }
}

template <class Real>
void take_over_grids(Tick<Real>& tick, bool places_too) {
  const StageTimer timer(tick.profile, Stage::integration, 0);
  const ClothState<Real>& state = tick.state;
  for (std::size_t p = 0; p < tick.parts(); ++p) {
    if (!tick.by_rows(p) || tick.rests(p)) continue;
    if (places_too)
      tick.grid(p).take_over(state.x, state.v, tick.work.executor);
    else
      tick.grid(p).load_velocities(state.v, tick.work.executor);
  }
}

template <class Real>
void drift_meshes(Tick<Real>& tick) {
  if (tick.work.all_grids) return;
  Vec3Array<Real>&x = tick.state.x, &v = tick.state.v, &remainder = tick.work.remainder;
  any_of_awake(tick.model, tick.state, kPassedAtLeast, tick.work.executor,
               [&](std::size_t p, std::size_t first, std::size_t last) {
                 if (!tick.by_rows(p))
                   run_drift(3 * (last - first), v[first].data(), tick.dt, x[first].data(),
                             remainder[first].data());
                 return false;
               });
}

/// All substeps of a grid that nothing else touches: the particles stay in its own arrays.
/// @returns work of the air [J]
template <class Real>
double advance_alone(Tick<Real>& tick, std::size_t p, const Kicks<Real>& kicks, int substeps) {
  assert(tick.by_rows(p) && substeps >= 1);
  assert(!tick.has_hands && tick.collision.empty() && "nothing else moves the particles");
  GridPass<Real>& grid = tick.grid(p);
  HeldForces<Real>* const held = tick.collision.held;
  double work = 0;
  for (int s = 0; s <= substeps; ++s) {
    stop_point();
    const bool last = s == substeps;
    const Kick<Real>& kick = s == 0 ? kicks.opening : last ? kicks.closing : kicks.full;
    if (held) {
      grid.store(held->seen(p), tick.state.x, tick.state.v);
      held->act(p, tick.surroundings, tick.state.x, tick.state.v, kick.seconds);
    }
    if (tick.has_external_forces) {
      const StageTimer timer(tick.profile, Stage::air, size_of(tick.part(p).triangles));
      grid.compute_air_forces(tick.surroundings.air_density);
    }
    work += advance_grid(tick, p, kick, last ? Real(0) : tick.dt);
  }
  grid.store(tick.state.x, tick.state.v, tick.work.executor);
  return work;
}

template <class Real>
double advance_calm(Tick<Real>& tick, const Kicks<Real>& kicks, int substeps, int& s,
                    NextCalm& next) {
  assert(s >= 0 && s < substeps);
  if (s < next.substep || !may_be_calm(tick)) return 0;
  ClothGuard<Real>& guard = *tick.collision.guard;
  const CalmPaths<Real>* paths = guard.calm_paths();
  const Contact<Real>* objects = tick.collision.objects;
  if (!paths || !(paths->time + tick.dt <= paths->horizon)) return 0;
  const Real clearance = objects ? objects->calm_room(tick.state) * Real(kCalmClearance)
                                 : std::numeric_limits<Real>::infinity();
  if (!(clearance > 3 * paths->reach)) {
    next.substep = s + kCalmKeptSteps;
    return 0;
  }
  tick.work.load_paths(*paths);
  Real time = paths->time, kept_time = time;
  Aabb<Real> box = box_off_paths(tick, time), kept_box = box;
  const Spell<Real> begin{*paths, clearance, time, box.centre()};
  const int first = s;
  int kept = s;
  double work = 0, kept_work = 0;
  bool renew = false;
  WorkMeter<Real>* const meter = tick.collision.meter;
  HeldForces<Real>* const held = tick.collision.held;
  for (; s < substeps && !renew && time + tick.dt <= paths->horizon; ++s) {
    stop_point();
    if ((s - first) % kCalmKeptSteps == 0) {
      for (GridPass<Real>& grid : tick.work.grids) grid.keep();
      if (meter) meter->keep();
      if (held) held->keep();
      kept = s, kept_time = time, kept_box = box, kept_work = work;
    }
    const Kick<Real>& kick = s == 0 ? kicks.opening : kicks.full;
    hold_grids(tick, kick);
    work += meter ? advance_metered(tick, kick) : advance_grids(tick, kick);
    time += tick.dt;
    box = box_off_paths(tick, time);
    const Real off = half_diagonal(box);
    if (!(off <= paths->reach && farthest(begin, box, time) <= clearance)) {
      // Particles may have touched: return to the saved positions, and repeat the steps with
      // contact.
      for (GridPass<Real>& grid : tick.work.grids) grid.take_back();
      if (meter) meter->take_back();
      if (held) held->take_back();
      next.substep = s + 1;
      s = kept, time = kept_time, box = kept_box, work = kept_work;
      break;
    }
    renew = off > paths->reach * static_cast<Real>(kCalmRenewal);
  }
  guard.leave_calm_paths(s - first, time, box.centre(), renew);
  for (GridPass<Real>& grid : tick.work.grids)
    grid.store(tick.state.x, tick.state.v, tick.work.executor);
  return work;
}

#define WEFT_INSTANTIATE(Real)                                                      \
  template double advance_grid(Tick<Real>&, std::size_t, const Kick<Real>&, Real);  \
  template void load_grids(Tick<Real>&);                                            \
  template void take_over_grids(Tick<Real>&, bool);                                 \
  template void drift_meshes(Tick<Real>&);                                          \
  template double advance_alone(Tick<Real>&, std::size_t, const Kicks<Real>&, int); \
  template double advance_calm(Tick<Real>&, const Kicks<Real>&, int, int&, NextCalm&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
