// The stages of contact with objects in a substep.

#include "core/contact/objects/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/constants.h"
#include "core/contact/guard/cloth_guard.h"

namespace weft {
namespace {

/// Sweeps at the end of a tick over the rows of cloths with each other and these in turn.
constexpr int kClosingSweeps = 4;

bool is_thinner(const ContactDef& a, const ContactDef& b) {
  return a.thickness < b.thickness;
}

}  // namespace

template <class Real>
Contact<Real>::Contact(const std::vector<ContactDef>& cloths,
                       const std::vector<ColliderDef>& colliders, ClothPatches patches,
                       Executor* executor)
    : cloths_(cloths), executor_(executor), patches_(std::move(patches)) {
  bounces_ = std::any_of(cloths.begin(), cloths.end(),
                         [](const ContactDef& cloth) { return cloth.restitution > 0; });
  thickness_ =
      static_cast<Real>(std::max_element(cloths.begin(), cloths.end(), is_thinner)->thickness);
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    validate(colliders[k], "colliders[" + std::to_string(k) + "].");
    add_shape(colliders[k].shape, k);
    frames_.emplace_back();
    frames_.back().pivot = pivot_of(colliders[k].shape);
    frames_.back().radius = radius_of(colliders[k].shape);
    frames_.back().pose = rest_pose(colliders[k].shape);
  }
  own_planes_ = planes_;
  own_balls_ = balls_;
  own_rods_ = rods_;
  x_own_.resize(meshes_.size());
  // Beyond the size of a triangle the pairs grow with the square of the skin.
  for (const MeshShape<Real>& mesh : meshes_)
    widest_skin_ = std::min(widest_skin_, mesh.triangle_size);
  particle_pairs_.resize(meshes_.size());
  edge_pairs_.resize(meshes_.size());
  triangle_pairs_.resize(meshes_.size());
  neighbourhoods_.assign(meshes_.size(), std::vector<Neighbourhood>(patches_.list.size()));
}

template <class Real>
void Contact<Real>::add_shape(const ShapeDef& shape, std::size_t collider) {
  if (const auto* plane = std::get_if<PlaneDef>(&shape)) {
    const Vec3d n = plane->normal.normalized();
    planes_.push_back({n.cast<Real>(), static_cast<Real>(n.dot(plane->point)), collider});
  } else if (const auto* sphere = std::get_if<SphereDef>(&shape)) {
    balls_.push_back({sphere->centre.cast<Real>(), static_cast<Real>(sphere->radius), collider});
  } else if (const auto* capsule = std::get_if<CapsuleDef>(&shape)) {
    rods_.push_back({capsule->a.cast<Real>(), capsule->b.cast<Real>(),
                     static_cast<Real>(capsule->radius), collider});
  } else {
    const auto* box = std::get_if<BoxDef>(&shape);
    meshes_.push_back(prepare_mesh<Real>(box ? world_mesh(*box) : std::get<MeshDef>(shape).mesh));
    mesh_collider_.push_back(collider);
  }
}

template <class Real>
Index Contact<Real>::cloth_of(Index particle) const {
  std::size_t cloth = cloths_.size() - 1;
  while (cloth > 0 && particle < cloths_[cloth].first_particle) --cloth;
  return static_cast<Index>(cloth);
}

template <class Real>
void Contact<Real>::reset() {
  collected_ = rows_built_ = false;
  clearance_.clear();
  rows_.clear();
  log_.clear();
  moving_rows_.clear();
  exits_.clear();
  v_came_.clear();
  v_kicked_.clear();
  impacts_.clear();
  for (ColliderFrame<Real>& frame : frames_) frame.wary = frame.rest = 0;
  // What they have room for decides how long pairs hold, and with it the coming ticks.
  for (std::vector<Neighbourhood>& of_mesh : neighbourhoods_) {
    for (Neighbourhood& about : of_mesh) about.box = {};
  }
}

template <class Real>
void Contact<Real>::let_rest(const ClothState<Real>& state) {
  collected_ = rows_built_ = false;
  resting_.clear();
  if (state.asleep.empty()) return;
  for (std::size_t i = 0; i < state.x.size(); ++i)
    resting_.push_back(state.asleep[static_cast<std::size_t>(cloth_of(static_cast<Index>(i)))]);
}

template <class Real>
void Contact<Real>::begin_tick(double tick_seconds, ColliderStates* colliders) {
  tick_seconds_ = static_cast<Real>(tick_seconds);
  colliders_ = colliders;
  work_ = 0;
  log_.clear();
  any_tracked_ = any_jaw_ = false;
  first_substep_ = true;
  surface_speed_ = 0;
  if (!colliders) {
    for (ColliderFrame<Real>& frame : frames_) frame.tracked = false;
    return;
  }
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    ColliderFrame<Real>& frame = frames_[k];
    const ColliderState& state = (*colliders)[k];
    const bool tracked = state.is_active();
    if (tracked && !frame.tracked) rows_built_ = false;  // the old ones do not follow it
    frame.tracked = tracked;
    any_tracked_ = any_tracked_ || tracked;
    any_jaw_ = any_jaw_ || !state.press.isZero(0);
    (*colliders)[k].facing = 0;
    // What slips out of jaws goes round their rims, where planes that stay would stop it for ever.
    if (state.squeeze > 0) rows_built_ = false;
    const double turn = state.twist.angular.norm();
    const double speed = state.twist.linear.norm() + (turn > 0 ? turn * frame.radius : 0);
    surface_speed_ = std::max(surface_speed_, static_cast<Real>(speed));
  }
}

template <class Real>
void Contact<Real>::resolve(ClothState<Real>& state, Real dt, Profile& profile,
                            ClothGuard<Real>* guard) {
  if (empty()) return;
  plan_colliders(dt);
  bool holds;
  {
    const StageTimer timer(profile, Stage::broad_phase, 0);
    holds = rows_hold(state, dt) || renew_clear(state, dt, profile);
  }
  if (!holds) {
    rebuild_rows(state, dt, profile);
    measure_way(state, dt);
  }
  if (!rows_.empty()) {
    profile[Stage::contact].work += rows_.size();
    if (log_.wanted()) log_.see(rows_, state);
    find_busy_rows();
    push_out(state, dt);
    aim_rows(state, dt);
    // The kicks at the ends of a tick are halves, and friction has half as much to hold there.
    if (any_jaw_) share_squeeze(state, first_substep_ ? dt / 2 : dt);
    solve_rows(state, dt, profile, guard);
    bounce(state, profile, guard);
    if (guard) guard->push_apart(state);
    certify(state, dt, guard != nullptr);
  } else if (guard) {
    guard->respond_alone(state, dt);
    certify(state, dt, true);
  }
  first_substep_ = false;
  if (!any_tracked_ || !guard) return;
  x_certified_ = state.x;
  v_certified_ = state.v;
}

template <class Real>
void Contact<Real>::settle(ClothState<Real>& state, Real dt, Profile& profile,
                           ClothGuard<Real>* guard) {
  if (rows_.empty()) {
    if (guard) guard->sweep(state);
    return;
  }
  profile[Stage::contact].work += rows_.size();
  if (log_.wanted()) log_.see(rows_, state);
  measure_way(state, dt);
  find_busy_rows();
  if (lone_apart_) lone_response_ = lone_rows_.respond(lone_pass(state, dt));
  aim_rows(state, dt);
  if (any_jaw_) share_squeeze(state, dt / 2);
  solve_rows(state, dt, profile, guard);
  bounce(state, profile, guard);
  if (!guard || guard->rows().empty()) return;
  std::uint64_t friction_evaluations = 0;
  for (int sweep = 0; sweep < kClosingSweeps; ++sweep) {
    const bool changed = guard->sweep(state) > 0;
    sweep_rows(state, friction_evaluations, !changed);
  }
  profile[Stage::friction].work += friction_evaluations;
}

template <class Real>
std::vector<ContactPoint> Contact<Real>::contacts(const Vec3Array<Real>& x) {
  return log_.contacts(rows_, x, kTouching, static_cast<double>(tick_seconds_));
}

template <class Real>
bool Contact<Real>::touches(const Vec3Array<Real>& x) const {
  return std::any_of(rows_.begin(), rows_.end(), [&x](const ContactRow<Real>& row) {
    if (!row.responds) return false;
    Real height = -row.offset;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
      height += row.normal.dot(x[static_cast<std::size_t>(row.particle[k])]) * row.weight[k];
    return height <= row.thickness * static_cast<Real>(kTouching);
  });
}

/// Signed distance of a point from the nearest object; of meshes, only closed ones have an inside.
template <class Real>
Real Contact<Real>::signed_distance(const Vec3<Real>& p) const {
  constexpr Real kFar = Real(1000);
  Real nearest = analytic_clearance(p, kFar);
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    if (!mesh.closed) continue;
    const Vec3<Real> own = frames_[mesh_collider_[m]].own(p);
    const Real outside = std::sqrt(mesh.triangle_tree.bounds().squared_distance(own));
    nearest = std::min(nearest, outside > 0 ? outside : distance_to_mesh(mesh, own, kFar).distance);
  }
  return nearest;
}

template <class Real>
double Contact<Real>::deepest_penetration(const Vec3Array<Real>& x) const {
  Real least = 0;
  std::vector<Real> distance;
  for (std::size_t i = 0; i < x.size(); ++i) {
    // Nobody in the ball about a neighbour that reaches to the nearest surface needs measuring.
    Real known = 0, edge = 0;
    for (const auto& neighbour : patches_.neighbours.of(i)) {
      const auto j = static_cast<std::size_t>(neighbour.particle);
      if (j >= i) continue;
      edge = std::max(edge, (x[i] - x[j]).norm());
      known = std::max(known, distance[j] - (x[i] - x[j]).norm());
    }
    distance.push_back(known > edge * 2 ? known : signed_distance(x[i]));
    least = std::min(least, distance.back());
  }
  for (const Edge& edge : patches_.edges) {
    const auto i = static_cast<std::size_t>(edge[0]), j = static_cast<std::size_t>(edge[1]);
    const Vec3<Real> way = x[j] - x[i];
    const Real length = way.norm();
    for (const Real t : {Real(0.25), Real(0.5), Real(0.75)}) {
      // The ball about an end that reaches to the nearest surface holds no point of an object.
      if (length * t < distance[i] || length * (1 - t) < distance[j]) continue;
      least = std::min(least, signed_distance(x[i] + way * t));
    }
  }
  return static_cast<double>(-least);
}

template class Contact<float>;
template class Contact<double>;

}  // namespace weft
