// Commands to a world, and queries, between its steps.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/cloth/softening.h"
#include "core/error.h"
#include "core/geometry/ray_cast.h"
#include "core/world/constants.h"
#include "core/world/model_of.h"
#include "core/world/object_name.h"
#include "core/world/state_hash.h"
#include "core/world/world.h"
#include "core/world/wound_up.h"

namespace weft {

template <class Real>
PinId World<Real>::pin(const PinDef& def) {
  const Vec3Array<Real> before = state_.v;
  const PinId id = hold(def);
  renew_clamps();
  try {
    refuse_too_stiff();  // its clamp stiffens
  } catch (const DefinitionError&) {
    unpin(id);
    state_.v = before;
    throw;
  }
  return id;
}

/// Pins without regard to how the cloth bends at the border.
template <class Real>
PinId World<Real>::hold(const PinDef& def) {
  const PinId id = add_pin(model_, def, pins_, state_);
  masses_changed();
  wake(pins_.list.back().centre);
  report_motion();  // pinned particles have lost their velocity
  return id;
}

template <class Real>
bool World<Real>::unpin(PinId id) {
  const std::size_t before = pins_.list.size();
  unpin(std::span(&id, 1));
  return pins_.list.size() < before;
}

template <class Real>
void World<Real>::unpin(std::span<const PinId> ids) {
  bool any = false;
  for (const PinId id : ids) {
    wake_held(id);
    any = remove_pin(model_, id, pins_, state_) || any;
  }
  if (!any) return;
  masses_changed();
  renew_clamps();
}

/// Bends cloth at the borders of pinned strips as if clamped there. The factors are constants of
/// the model to the solvers, which are prepared anew when they change: only where a strip is pinned
/// or released.
template <class Real>
void World<Real>::renew_clamps() {
  const std::vector<std::size_t> changed = set_clamps(clamps_of(pins_), model_);
  if (changed.empty()) return;
  for (const std::size_t part : changed) {
    restore_hinges(part);
    stiffen_hinges(part, model_);
    renew_links(part, model_);
    renew_bending_bounds(part, model_);
  }
  prepare_solver();
  report_present_state();
}

/// Restores the hinges of a cloth to what they are without clamps.
template <class Real>
void World<Real>::restore_hinges(std::size_t number) {
  const ClothPart<Real>& part = model_.parts[number];
  if (part.hinges.count == 0) return;
  const ClothModel<Real> built = build_cloth<Real>(cloths_to_build(def_)[number]);
  assert(built.hinges.size() == static_cast<std::size_t>(part.hinges.count));
  for (std::size_t k = 0; k < built.hinges.size(); ++k) {
    Hinge<Real>& hinge = model_.hinges[static_cast<std::size_t>(part.hinges.first) + k];
    hinge.stiffness = built.hinges[k].stiffness;
    hinge.damping = built.hinges[k].damping;
  }
}

template <class Real>
bool World<Real>::move_pin(PinId id, const PinMove& move) {
  validate(move);  // before anything wakes
  wake_held(id);
  if (!weft::move_pin(model_, id, move, pins_, state_)) return false;
  masses_changed();
  return true;
}

template <class Real>
bool World<Real>::stop_pin(PinId id) {
  if (!weft::stop_pin(id, pins_, state_)) return false;
  masses_changed();
  report_motion();  // fixed particles have lost their velocity
  return true;
}

/// Fixes pins that have arrived.
template <class Real>
void World<Real>::finish_pins() {
  if (!PinDrive<Real>::finish(tick_seconds(), state_, pins_)) return;
  masses_changed();
  if (!energy_) return;
  Energies now = energy_->balance.now;
  now.kinetic = kinetic_energy(model_, state_);
  double taken = 0;
  energy_->book_loss(now, taken);
  energy_->balance.flows.pins -= taken;
}

template <class Real>
GrabId World<Real>::grab(const GrabDef& def) {
  const GrabId id = add_grab(model_, state_, def, grabs_);
  assert(!grabs_.list.back().particles.empty());
  wake(grabs_.list.back().particles.front());
  return id;
}

template <class Real>
bool World<Real>::move_grab(GrabId id, const Vec3d& target) {
  return weft::move_grab(id, target, grabs_);
}

template <class Real>
bool World<Real>::release(GrabId id) {
  return remove_grab(id, grabs_);
}

template <class Real>
std::optional<Vec3d> World<Real>::fire(GrabId id) {
  const int ticks = std::max(1, static_cast<int>(std::lround(kSlingSeconds * def_.tick_rate)));
  const auto force = fire_sling(id, ticks, state_, grabs_);
  if (!force) return std::nullopt;
  allocate_external();
  return force->template cast<double>() * (ticks * tick_seconds());
}

/// Throws DefinitionError if the collider is a jaw.
template <class Real>
void World<Real>::refuse_jaw(std::size_t collider) const {
  assert(collider < colliders_.size());
  assert(colliders_.size() >= 2 * grippers_.size());
  if (collider < colliders_.size() - 2 * grippers_.size()) return;
  throw DefinitionError("collider", def_.colliders[collider].name, "an object that is not a jaw",
                        "a gripper moves its jaws: command the gripper");
}

template <class Real>
bool World<Real>::move_collider(std::size_t collider, const MoveDef& move) {
  if (collider >= colliders_.size()) return false;
  refuse_jaw(collider);
  validate(move, "");
  check_may_turn(def_.colliders[collider], move.target, "");
  MoveDef wanted = move;
  wanted.target.rotation.normalize();
  colliders_[collider].move = wanted;
  return true;
}

template <class Real>
bool World<Real>::command_gripper(std::size_t gripper, const GripperCommand& command) {
  if (gripper >= grippers_.size()) return false;
  validate(command, "");
  weft::command_gripper(command, grippers_[gripper]);
  return true;
}

template <class Real>
bool World<Real>::release_collider(std::size_t collider) {
  if (collider >= colliders_.size()) return false;
  refuse_jaw(collider);
  colliders_[collider].move.reset();
  return true;
}

template <class Real>
void World<Real>::set_environment(const EnvironmentDef& environment) {
  validate(environment);
  turn_wind(environment.wind);
  environment_ = environment;
  wake_all();
  allocate_external();
  report_motion();
}

/// Changes the mean wind. The gusts go on where they are.
template <class Real>
void World<Real>::turn_wind(const Vec3d& wind) {
  const double time = static_cast<double>(tick_) / def_.tick_rate;
  surroundings_.gusts_ahead += (environment_.wind - wind) * time;
  environment_.wind = wind;
}

template <class Real>
void World<Real>::set_softness(double softness) {
  check_field("", {"softness", kSoftnessRange, "", "fraction of the springs' stiffness"}, softness);
  ClothModel<Real> model = model_of<Real>(def_);
  soften(softness, model);
  for (std::size_t p = 0; p < model_.parts.size(); ++p)
    refuse_wound_up(model_, model, p, state_.x, "softness");
  softness_ = softness;
  assert(model.springs.size() == model_.springs.size());
  assert(model.parts.size() == model_.parts.size());
  model_.springs = std::move(model.springs);
  model_.locks = std::move(model.locks);
  for (std::size_t p = 0; p < model_.parts.size(); ++p) {
    model_.parts[p].grid_springs = model.parts[p].grid_springs;
    model_.parts[p].membrane_tensor = model.parts[p].membrane_tensor;
    FrequencyBounds& bounds = model_.parts[p].bounds;  // of bending they stay
    bounds.membrane_omega2 = model.parts[p].bounds.membrane_omega2;
    bounds.membrane_shear_omega2 = model.parts[p].bounds.membrane_shear_omega2;
    bounds.locking_omega2 = model.parts[p].bounds.locking_omega2;
    bounds.membrane_damping_rate = model.parts[p].bounds.membrane_damping_rate;
  }
  wake_all();
  prepare_solver();
  report_present_state();
}

template <class Real>
std::optional<ClothHit> World<Real>::pick(const Vec3d& origin, const Vec3d& direction) const {
  check_field("pick.", {"origin", -1e6, 1e6, "m", "start of the ray"}, origin);
  check_field("pick.", {"direction", -1e6, 1e6, "", "direction of the ray"}, direction);
  const double length = direction.norm();
  if (!(length > kShortestRay))
    throw DefinitionError("pick.direction", "0,0,0", "a direction",
                          "give a vector that is not zero");
  std::vector<Aabb<Real>> boxes;
  triangle_boxes(state_.x, model_.triangles, boxes);
  Bvh<Real> hierarchy = pick_tree_;
  hierarchy.refit(boxes);
  const Vec3<Real> from = origin.template cast<Real>();
  const Vec3<Real> along = (direction / length).template cast<Real>();
  const auto hit = cast_ray<Real>(from, along, hierarchy, state_.x, model_.triangles);
  if (!hit) return std::nullopt;
  ClothHit result;
  result.distance = static_cast<double>(hit->distance);
  result.triangle = hit->triangle;
  const Triangle& corners = model_.triangles[static_cast<std::size_t>(hit->triangle)];
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    result.barycentric[k] = static_cast<double>(hit->barycentric[k]);
    result.position += result.barycentric[k] *
                       state_.x[static_cast<std::size_t>(corners[k])].template cast<double>();
  }
  for (const Index i : corners) {
    const double d =
        (state_.x[static_cast<std::size_t>(i)].template cast<double>() - result.position).norm();
    if (d >= nearest) continue;
    nearest = d;
    result.nearest_particle = i;
  }
  return result;
}

template <class Real>
std::uint64_t World<Real>::hash() const {
  return state_hash(state_, pins_, grabs_, def_.colliders, colliders_, grippers_, sleep_.asleep(),
                    {environment_, def_.environment, surroundings_.gusts_ahead, softness_,
                     def_.cloths, scene_fabrics_},
                    tick_);
}

template <class Real>
std::uint64_t World<Real>::hash_before_tick() const {
  const Checkpoint& before = checkpoint_;
  assert(before.state.x.size() == model_.mass.size() && "keep_checkpoint comes first");
  EnvironmentDef environment = environment_;
  environment.wind = before.wind;
  const Sleep<Real>& sleep = before.sleep ? *before.sleep : sleep_;
  return state_hash(
      before.state, before.pins, before.grabs, def_.colliders, before.colliders, before.grippers,
      sleep.asleep(),
      {environment, def_.environment, before.gusts_ahead, softness_, def_.cloths, scene_fabrics_},
      tick_);
}

template <class Real>
double World<Real>::deepest_penetration() const {
  return contact_.objects.deepest_penetration(state_.x);
}

template <class Real>
std::vector<std::string> World<Real>::bad_starts() const {
  std::vector<std::string> list;
  const auto name_of = [this](Index k) { return cloth_name(def_, k); };
  for (const BadStart<Real>& start : contact_.objects.bad_starts()) {
    if (colliders_[start.collider].voided) continue;  // it was forced there
    list.push_back(name_of(start.cloth) + " started inside " + object_name(def_, start.collider));
  }
  if (!contact_.guard || contact_.guard->open_pairs() == 0) return list;
  for (const auto& [one, other] : contact_.guard->tangled_cloths())
    list.push_back(name_of(one) + " started through " + (one == other ? "itself" : name_of(other)));
  return list;
}

template <class Real>
std::size_t World<Real>::open_pairs() const {
  std::size_t pairs = contact_.guard ? contact_.guard->open_pairs() : 0;
  for (const BadStart<Real>& start : contact_.objects.bad_starts())
    pairs += colliders_[start.collider].voided ? 0 : start.particles;
  return pairs;
}

template <class Real>
std::vector<Aabb<float>> World<Real>::debug_boxes(const std::string& tree, int level) {
  if (!debug_trees_) debug_trees_.emplace(model_, def_.colliders);
  return debug_trees_->boxes(tree, level, state_.x);
}

template <class Real>
std::vector<std::string> World<Real>::debug_tree_names() {
  if (!debug_trees_) debug_trees_.emplace(model_, def_.colliders);
  return debug_trees_->names();
}

template <class Real>
int World<Real>::debug_tree_levels(const std::string& tree) {
  if (!debug_trees_) debug_trees_.emplace(model_, def_.colliders);
  return debug_trees_->level_count(tree);
}

#define WEFT_INSTANTIATE(Real)                                                          \
  template PinId World<Real>::pin(const PinDef&);                                       \
  template PinId World<Real>::hold(const PinDef&);                                      \
  template void World<Real>::renew_clamps();                                            \
  template void World<Real>::restore_hinges(std::size_t);                               \
  template bool World<Real>::unpin(PinId);                                              \
  template void World<Real>::unpin(std::span<const PinId>);                             \
  template bool World<Real>::move_pin(PinId, const PinMove&);                           \
  template bool World<Real>::stop_pin(PinId);                                           \
  template void World<Real>::finish_pins();                                             \
  template GrabId World<Real>::grab(const GrabDef&);                                    \
  template bool World<Real>::move_grab(GrabId, const Vec3d&);                           \
  template bool World<Real>::release(GrabId);                                           \
  template std::optional<Vec3d> World<Real>::fire(GrabId);                              \
  template void World<Real>::refuse_jaw(std::size_t) const;                             \
  template bool World<Real>::move_collider(std::size_t, const MoveDef&);                \
  template bool World<Real>::command_gripper(std::size_t, const GripperCommand&);       \
  template bool World<Real>::release_collider(std::size_t);                             \
  template void World<Real>::set_environment(const EnvironmentDef&);                    \
  template void World<Real>::turn_wind(const Vec3d&);                                   \
  template void World<Real>::set_softness(double);                                      \
  template std::optional<ClothHit> World<Real>::pick(const Vec3d&, const Vec3d&) const; \
  template std::uint64_t World<Real>::hash() const;                                     \
  template std::uint64_t World<Real>::hash_before_tick() const;                         \
  template double World<Real>::deepest_penetration() const;                             \
  template std::vector<std::string> World<Real>::bad_starts() const;                    \
  template std::size_t World<Real>::open_pairs() const;                                 \
  template std::vector<Aabb<float>> World<Real>::debug_boxes(const std::string&, int);  \
  template std::vector<std::string> World<Real>::debug_tree_names();                    \
  template int World<Real>::debug_tree_levels(const std::string&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
