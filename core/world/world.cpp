// Construction, ticks and state of a world.

#include "core/world/world.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "core/contact/colliders/collider_plan.h"
#include "core/error.h"
#include "core/forces/air/air.h"
#include "core/geometry/ray_cast.h"
#include "core/solver/bending_kick.h"
#include "core/solver/constants.h"
#include "core/solver/dashpot_passes.h"
#include "core/stop_signal.h"
#include "core/world/constants.h"
#include "core/world/model_of.h"

namespace weft {
namespace {

template <class Real>
double total_mass(const ClothModel<Real>& model) {
  double sum = 0;
  for (const Real mass : model.mass) sum += static_cast<double>(mass);
  return sum;
}

template <class Real>
Contact<Real> make_contact(const WorldDef& def, const ClothModel<Real>& model,
                           const Runtime& runtime) {
  std::vector<ContactDef> cloths;
  for (const ClothPart<Real>& part : model.parts)
    cloths.push_back({part.fabric.thickness, part.fabric.friction, part.fabric.restitution,
                      part.particles.first});
  return Contact<Real>(cloths, def.colliders,
                       make_patches(model.rest_positions, model.edges, model.triangles),
                       runtime.executor, runtime.meshes);
}

template <class Real>
Sleep<Real> make_sleep(const WorldDef& def, const ClothModel<Real>& model) {
  const bool together =
      solver_of(def) == SolverKind::relaxation || contact_of(def) == ContactModel::seed;
  return Sleep<Real>(model, def.sleep, 1 / def.tick_rate, together);
}

/// Throws DefinitionError unless the ends of each edge start apart: what is in one place has no
/// direction in which to leave it.
template <class Real>
void check_edges(const Vec3Array<Real>& x, const std::vector<Edge>& edges) {
  for (const auto& [a, b] : edges) {
    if (x[static_cast<std::size_t>(a)] != x[static_cast<std::size_t>(b)]) continue;
    throw DefinitionError(
        "start.x", "particles " + std::to_string(a) + " and " + std::to_string(b) + " in one place",
        "particles of an edge that are apart",
        "take the positions of the scene's own particles, in metres");
  }
}

/// Throws DefinitionError if a particle starts farther from the origin than cloth may get: each
/// tick would be taken back.
template <class Real>
void check_places(const ClothModel<Real>& model, const Vec3Array<Real>& x) {
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const IndexRange& range = model.parts[p].particles;
    for (Index i = range.first; i < range.end(); ++i) {
      const auto far = static_cast<double>(x[static_cast<std::size_t>(i)].norm());
      if (far <= kFarthestFromOrigin) continue;
      throw DefinitionError("cloths[" + std::to_string(p) + "]",
                            "a particle " + rounded_text(far) + " m from the origin",
                            "at most " + number_text(kFarthestFromOrigin) + " m",
                            "place it nearer; a mesh in millimetres has the scale 0.001");
    }
  }
}

/// The definition after validation, with the jaws of grippers among its colliders; nothing is built
/// from an invalid one.
WorldDef validated(WorldDef def) {
  validate(def);
  for (GripperDef& gripper : def.grippers) {
    gripper.orientation.normalize();  // which it need only nearly be
    for (const ColliderDef& jaw : jaws_of(gripper)) def.colliders.push_back(jaw);
  }
  return def;
}

}  // namespace

template <class Real>
World<Real>::World(const WorldDef& def, const Runtime& runtime)
    : def_(validated(def)), environment_(def.environment), runtime_(runtime),
      model_(model_of<Real>(def_)), account_(total_mass(model_)), sleep_(make_sleep(def_, model_)) {
  for (const ClothDef& cloth : def_.cloths) scene_fabrics_.push_back(cloth.fabric);
  if (def_.start) validate(*def_.start, model_.mass.size());
  state_ = state_at(def_.start, model_);
  if (def_.start) check_edges(state_.x, model_.edges);
  check_places(model_, state_.x);
  build_contact();
  prepare_solver();
  refuse_too_stiff();
  std::vector<Aabb<Real>> boxes;
  triangle_boxes(model_.rest_positions, model_.triangles, boxes);
  pick_tree_.build(boxes);
  reset();
  refuse_too_stiff();  // clamps stiffen
}

/// Builds contact, sleep and the account of energy for the present model.
template <class Real>
void World<Real>::build_contact() {
  contact_.objects = make_contact(def_, model_, runtime_);
  contact_.objects.log_impulses(supports_.wanted, energy_.has_value());
  sleep_ = make_sleep(def_, model_);
  account_ = EnergyAccount(total_mass(model_));
  thickest_ = 0;
  for (const ClothPart<Real>& part : model_.parts)
    thickest_ = std::max(thickest_, part.fabric.thickness);
  const bool something_to_meet = !def_.colliders.empty() || def_.contact.seed.has_self_contact();
  if (contact_of(def_) == ContactModel::seed && something_to_meet)
    contact_.seed.emplace(def_.contact.seed, model_, def_.colliders);
  if (has_guard(def_))
    contact_.guard.emplace(model_, runtime_.executor).log_forces(supports_.wanted);
}

template <class Real>
void World<Real>::reset() {
  state_ = state_at(def_.start, model_);
  const PinId next_pin = pins_.next_id;
  pins_ = make_pins(model_);
  pins_.next_id = next_pin;
  scene_hands_.assign(def_.hands.size(), {});
  grabs_.list.clear();
  grabs_.impulses.clear();
  assert(def_.colliders.size() >= 2 * def_.grippers.size() && "their jaws are colliders");
  colliders_ = initial_states(def_.colliders);
  grippers_ = initial_grippers(def_.grippers, def_.colliders.size() - 2 * def_.grippers.size());
  for (std::size_t k = 0; k < def_.pins.size(); ++k) {
    try {
      hold(def_.pins[k]);
    } catch (const DefinitionError& error) {
      const std::size_t dot = error.field.find('.');
      throw error.renamed("pins[" + std::to_string(k) + "]" +
                          (dot == std::string::npos ? std::string() : error.field.substr(dot)));
    }
  }
  renew_clamps();
  tick_ = 0;
  swing_.begin_anew();
  if (!def_.winds.empty()) environment_.wind = def_.environment.wind;
  surroundings_.gusts_ahead.setZero();
  report_ = TickReport{};
  report_.profile.clock = runtime_.clock;
  accept_state();
  begin_balance();
}

template <class Real>
void World<Real>::accept_state() {
  assert(state_.x.size() == model_.mass.size() && state_.v.size() == model_.mass.size());
  assert(state_.inverse_mass.size() == model_.mass.size());
  supports_.told.reset();
  wake_all();
  last_good_.x = state_.x;
  last_good_.v = state_.v;
  account_.clear();
  solvers_.touching = false;
  forget_motion();
  report_present_state();
}

template <class Real>
const TickReport& World<Real>::step() {
  begin_tick();
  try {
    run_script();      // the scene's own hands, winds and disturbances
    plan_targets();    // grippers, objects and pins, each at its bounded speed
    rouse_sleepers();  // cloths on which something acts
    if (rests()) return rest();
    const int substeps = choose_substeps(solver_of(def_));
    sample_surroundings();                         // gravity, damping, the air at each particle
    lead_hands(tick_seconds(), state_.x, grabs_);  // no farther than the cloth can follow
    // Each substep: forces, kick, contact and drift; see advance_together in solver/verlet.cpp and
    // Collision::before_drift. A tick that blew up, or is another solver's, is done again.
    advance_or_recover(substeps);
    finish_targets();  // what was reached, held back or gripped
    put_to_sleep();
    end_tick();
  } catch (const Stopped&) {
    go_back();
  } catch (...) {
    go_back();
    throw;
  }
  return report_;
}

template <class Real>
void World<Real>::begin_tick() {
  keep_checkpoint();
  report_.halted = report_.rested = false;
  report_.brought = 0;
  report_.profile.clear();
  report_.divergence.reset();
}

template <class Real>
void World<Real>::plan_targets() {
  const double time = static_cast<double>(tick_) / def_.tick_rate;
  plan_grippers(time, tick_seconds(), thickest_, grippers_, colliders_);
  plan_motion(def_.colliders, time, tick_seconds(), colliders_);
  PinDrive<Real>::plan(tick_seconds(), state_, pins_);
}

template <class Real>
void World<Real>::finish_targets() {
  finish_motion(def_.colliders, tick_seconds(), colliders_);
  finish_grippers(tick_seconds(), colliders_, grippers_);
  finish_tick(tick_seconds(), grabs_);
  finish_pins();
}

template <class Real>
void World<Real>::end_tick() {
  report_.tick = ++tick_;
  report_.time = static_cast<double>(tick_) / def_.tick_rate;
  if (supports_.wanted)
    take_reactions();
  else
    supports_.told.reset();
  watch_swing();
}

/// Follows the strip of a decay test while nothing holds it.
template <class Real>
void World<Real>::watch_swing() {
  if (def_.test != TextileTest::decay) return;
  const std::optional<double> deflected = deflection(model_, state_);
  if (!deflected || !grabs_.list.empty())
    swing_.begin_anew();
  else
    swing_.look(report_.time, *deflected);
}

template <class Real>
std::vector<NamedNumber> World<Real>::measurements() const {
  return weft::measurements(def_.test, model_, state_, mean_velocities(),
                            environment_.gravity.norm(), swing_);
}

template <class Real>
void World<Real>::prepare_solver() {
  const SolverKind kind = solver_of(def_);
  solvers_.dashpots.prepare(model_);
  if (kind == SolverKind::relaxation)
    solvers_.relaxation.prepare(model_);
  else  // verlet steps some ticks for implicit
    solvers_.verlet.prepare(model_, def_.solver, runtime_.executor);
  if (kind == SolverKind::implicit) solvers_.implicit.prepare(model_);
  if (contact_.guard && kind != SolverKind::relaxation) solvers_.verlet.allocate_paths();
  solvers_.verlet.elastic.reset();
  supports_.held.forget();
  allocate_external();
}

/// Sizes the arrays for air and sling impulses as soon as there are any, so that no tick allocates.
template <class Real>
void World<Real>::allocate_external() {
  const bool air = !is_calm(environment_) || !def_.winds.empty();
  if (air) surroundings_.wind.resize(model_.mass.size());
  if (solver_of(def_) != SolverKind::relaxation)
    solvers_.verlet.allocate_external(model_, air, !grabs_.impulses.empty() || (air && energy_));
}

template <class Real>
std::size_t World<Real>::solver_bytes() const {
  std::size_t numbers = state_.inverse_mass.capacity();
  for (const Vec3Array<Real>* array :
       {&state_.x, &state_.v, &last_good_.x, &last_good_.v, &surroundings_.wind})
    numbers += 3 * array->capacity();
  return numbers * sizeof(Real) + solvers_.verlet.bytes();
}

template <class Real>
void World<Real>::sample_surroundings() {
  surroundings_.gravity = environment_.gravity.template cast<Real>();
  surroundings_.damping = environment_.damping;
  surroundings_.air_density = environment_.air_density;
  surroundings_.air = !is_calm(environment_);
  if (!surroundings_.air) return;
  assert(surroundings_.wind.size() == model_.mass.size() && "allocate_external comes first");
  const StageTimer timer(report_.profile, Stage::air, 0);
  const double time = static_cast<double>(tick_) / def_.tick_rate;
  report_.profile[Stage::fans].work +=
      sample_air(environment_, time, surroundings_.gusts_ahead, state_.x, surroundings_.wind);
}

/// The chosen contact; none if there is nothing to meet.
template <class Real>
Collision<Real> World<Real>::collision() {
  PinDrive<Real>* pins = pins_.any_moving() ? &pin_drive_ : nullptr;
  WorkMeter<Real>* meter = energy_ ? &energy_->meter : nullptr;
  HeldForces<Real>* held = supports_.wanted && !pins_.list.empty() ? &supports_.held : nullptr;
  if (contact_.seed) return {nullptr, &*contact_.seed, nullptr, pins, meter, held};
  const bool objects = contact_of(def_) == ContactModel::certified && !def_.colliders.empty();
  return {objects ? &contact_.objects : nullptr,
          nullptr,
          contact_.guard ? &*contact_.guard : nullptr,
          pins,
          meter,
          held};
}

/// Substeps of the chosen solver.
template <class Real>
AdvanceResult World<Real>::advance_some(SolverKind kind, double dt, const SubstepRange& substeps) {
  if (kind == SolverKind::verlet)
    return advance_verlet(model_, surroundings_, def_.solver, dt, substeps, grabs_, collision(),
                          state_, solvers_.verlet, report_.profile);
  if (kind == SolverKind::relaxation)
    return advance_relaxation(model_, surroundings_, def_.relaxation, dt, substeps, grabs_,
                              collision(), state_, solvers_.relaxation, report_.profile);
  assert(substeps.opens() && substeps.closes() && "its substeps need those before");
  return advance_implicit(model_, surroundings_, def_.implicit, dt, substeps.all, grabs_,
                          collision(), state_, solvers_.implicit, report_.profile);
}

/// One tick of the chosen solver, with the passes of the dashpots of bending.
template <class Real>
AdvanceResult World<Real>::advance(SolverKind kind, int substeps) {
  assert(kind != SolverKind::automatic && substeps >= 1);
  assert(colliders_.size() == def_.colliders.size());
  const double dt = tick_seconds() / substeps;
  contact_.objects.begin_tick(tick_seconds(), &colliders_);
  if (contact_.seed) contact_.seed->begin_tick(tick_seconds(), &colliders_);
  pin_drive_.begin_tick(tick_seconds(), model_, pins_);
  weft::begin_tick(grabs_);
  if (contact_.guard) contact_.guard->begin_tick();
  if (energy_) energy_->meter.begin_tick();
  if (supports_.wanted) supports_.held.begin_tick(model_, pins_);
  AdvanceResult result;
  DashpotPasses passes;
  if (kind != SolverKind::implicit)
    passes = solvers_.dashpots.passes(model_, tick_seconds()).times(refinement_);
  for (SubstepRange some{0, 0, substeps}; !some.closes() && !result.blow_up;) {
    some = next_range(some, passes);
    const AdvanceResult before = std::exchange(result, advance_some(kind, dt, some));
    if (!some.opens()) result.before = before.before;
    result.work += before.work;
    damp_bending(kind, dt, some, result);
  }
  result.work += contact_.objects.work() + pin_drive_.work();
  if (contact_.guard) {
    result.work += contact_.guard->work();
    contact_.guard->end_tick();
  }
  return result;
}

/// Lets the dashpots of bending act for the time of some substeps.
template <class Real>
void World<Real>::damp_bending(SolverKind kind, double dt, const SubstepRange& after,
                               AdvanceResult& result) {
  if (solvers_.dashpots.empty() || result.blow_up) return;
  const bool lags = kind == SolverKind::relaxation;
  if (lags) kick_by_bending(model_, dt / 2, solvers_.relaxation.force, state_);
  const double before = energy_ ? kinetic_energy(model_, state_) : 0;
  solvers_.dashpots.act(model_, dt * after.count(), state_,
                        supports_.wanted ? &supports_.held : nullptr, runtime_.executor,
                        report_.profile);
  if (energy_) energy_->meter.add({.damping = before - kinetic_energy(model_, state_)});
  if (kind == SolverKind::implicit) solvers_.implicit.take_over(state_.v);
  if (lags) kick_by_bending(model_, -dt / 2, solvers_.relaxation.force, state_);
  if (after.closes()) result.after.kinetic = kinetic_energy(model_, state_);
}

template <class Real>
void World<Real>::report_present_state() {
  const Vec3<Real> gravity = environment_.gravity.template cast<Real>();
  const EnergyReading reading = read_energies(model_, state_, gravity);
  report_.energies = reading.energies;
  report_.largest_strain = reading.largest_strain;
}

/// As above, after a change that moved no particle: the springs' figures in the report still hold.
template <class Real>
void World<Real>::report_motion() {
  const Vec3<Real> gravity = environment_.gravity.template cast<Real>();
  const Energies& known = report_.energies;
  const ElasticEnergy elastic{known.stretch, known.bending, report_.largest_strain};
  report_.energies = read_energies(model_, state_, gravity, elastic).energies;
}

template class World<float>;
template class World<double>;

}  // namespace weft
