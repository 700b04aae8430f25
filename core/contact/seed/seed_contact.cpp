// Contact of the seed with objects.

#include "core/contact/seed/seed_contact.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/geometry/distance.h"

namespace weft {
template <class Real>
SeedContact<Real>::SeedContact(const SeedContactDef& def, const ClothModel<Real>& model,
                               const std::vector<ColliderDef>& colliders)
    : def_(def), rest_positions_(model.rest_positions), edges_(model.edges),
      triangles_(model.triangles) {
  for (const ClothPart<Real>& part : model.parts) {
    cloth_of_.insert(cloth_of_.end(), static_cast<std::size_t>(part.particles.count),
                     static_cast<Index>(thickness_.size()));
    thickness_.push_back(static_cast<Real>(part.fabric.thickness));
    friction_.push_back(static_cast<Real>(part.fabric.friction));
    dissipation_.push_back(static_cast<Real>(part.fabric.restitution));
    thickest_ = std::max(thickest_, thickness_.back());
  }
  assert(thickest_ > 0 && def.lift >= 0 && def.passes >= 1);
  reach_ = thickest_;
  if (def.correction == Correction::fold_map)
    reach_ = std::max(reach_, static_cast<Real>(def.fold_depth));
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    validate(colliders[k], "colliders[" + std::to_string(k) + "].");
    shapes_.push_back(make_seed_shape<Real>(colliders[k].shape, reach_));
    frames_.emplace_back();
    frames_.back().pivot = pivot_of(colliders[k].shape);
    frames_.back().radius = radius_of(colliders[k].shape);
    frames_.back().pose = rest_pose(colliders[k].shape);
  }
  trees_.build(rest_positions_, edges_, triangles_);
  nearest_.resize(rest_positions_.size());
  deepest_.resize(shapes_.size());
  prepare_self_contact();
}

template <class Real>
void SeedContact<Real>::begin_tick(double tick_seconds, ColliderStates* colliders) {
  assert(tick_seconds > 0);
  assert(frames_.empty() || (colliders && colliders->size() == frames_.size()));
  tick_seconds_ = tick_seconds;
  touches_ = false;
  colliders_ = colliders;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const ColliderState& state = (*colliders)[k];
    if (!(state.pose == frames_[k].pose)) frames_[k].place(state.pose);
    frames_[k].tracked = state.is_active();
    frames_[k].stand();
  }
}

/// Moves objects through anything in their path: the seed considers only present positions.
template <class Real>
void SeedContact<Real>::move_colliders(Real dt) {
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    ColliderFrame<Real>& frame = frames_[k];
    if (!frame.tracked) continue;
    assert(colliders_ && "begin_tick comes first");
    ColliderState& state = (*colliders_)[k];
    frame.plan(state, static_cast<double>(dt), tick_seconds_);
    advance_collider(static_cast<double>(dt), tick_seconds_, state);
    if (!(state.pose == frame.pose)) frame.place(state.pose);
  }
}

/// Positions of the particles in an object's frame.
template <class Real>
const Vec3Array<Real>& SeedContact<Real>::in_frame_of(std::size_t object,
                                                      const Vec3Array<Real>& x) {
  const ColliderFrame<Real>& frame = frames_[object];
  if (!frame.displaced) return x;
  x_own_.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x_own_[i] = frame.own(x[i]);
  return x_own_;
}

/// Keeps the nearest candidate for a particle.
template <class Real>
void SeedContact<Real>::offer(std::size_t i, Real distance, const Vec3<Real>& normal,
                              Index object) {
  assert(object >= 0 && static_cast<std::size_t>(object) < frames_.size());
  if (std::abs(distance) < std::abs(nearest_[i].distance)) nearest_[i] = {distance, normal, object};
}

/// Eqs. (7) and (8) for all particles near a mesh, found by both trees; the distance itself for
/// simple shapes. A particle inside a simple shape counts as near at any depth; inside a mesh only
/// within the reach.
template <class Real>
void SeedContact<Real>::find_nearest(const ClothState<Real>& state, Real dt, Profile& profile) {
  std::fill(nearest_.begin(), nearest_.end(),
            Nearest{std::numeric_limits<Real>::infinity(), Vec3<Real>::Zero(), kNone});
  const BottomUpTree<Real>* particles = nullptr;
  const Vec3Array<Real>* around = nullptr;  // positions that the tree is fitted to
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const SeedShape<Real>& shape = shapes_[k];
    const ColliderFrame<Real>& frame = frames_[k];
    const Vec3Array<Real>& x = in_frame_of(k, state.x);
    const auto object = static_cast<Index>(k);
    if (!shape.is_mesh) {
      const StageTimer timer(profile, Stage::narrow_phase, state.x.size());
      for (std::size_t i = 0; i < state.x.size(); ++i) {
        const SurfacePoint<Real> point = distance_from(shape.simple, x[i]);
        if (point.distance < reach_)
          offer(i, point.distance, frame.world_direction(point.normal), object);
      }
      continue;
    }
    const StageTimer timer(profile, Stage::broad_phase, 0);
    if (around != &x || frame.displaced) particles = &trees_.particles(x, reach_ / 2);
    around = &x;
    std::uint64_t tests = 0;
    particles->for_each_pair(shape.tree, [&](Index particle, Index triangle) {
      ++tests;
      const auto i = static_cast<std::size_t>(particle);
      const Triangle& t = shape.triangles[static_cast<std::size_t>(triangle)];
      const Vec3<Real>& x1 = shape.positions[static_cast<std::size_t>(t[0])];
      const Vec3<Real>& x2 = shape.positions[static_cast<std::size_t>(t[1])];
      const Vec3<Real>& x3 = shape.positions[static_cast<std::size_t>(t[2])];
      const seed::Proximity<Real> p = seed::proximity<Real>(x[i], x1, x2, x3, reach_);
      if (!p.near) return;
      // At a surface without an inside, the particle belongs on the side from which it came.
      Vec3<Real> came_from = state.x[i] - state.v[i] * dt;
      if (frame.moves) came_from += frame.velocity_at(state.x[i]) * dt;
      const bool flip = !shape.closed && (frame.own(came_from) - x3).dot(p.normal) < 0;
      const Vec3<Real> normal = frame.world_direction(p.normal);
      if (flip)
        offer(i, -p.distance, -normal, object);
      else
        offer(i, p.distance, normal, object);
    });
    profile[Stage::broad_phase].work += tests;
    profile[Stage::narrow_phase].work += tests;
  }
}

/// Eq. (10) for all particles that touch and approach, or are behind the surface, and the
/// correction.
template <class Real>
void SeedContact<Real>::respond(ClothState<Real>& state) {
  const Real lift = static_cast<Real>(def_.lift);
  std::fill(deepest_.begin(), deepest_.end(), std::numeric_limits<Real>::infinity());
  const auto is_free = [&](std::size_t i) {
    return nearest_[i].object != kNone && state.inverse_mass[i] > 0;
  };
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (!is_free(i)) continue;
    Real& deepest = deepest_[static_cast<std::size_t>(nearest_[i].object)];
    deepest = std::min(deepest, nearest_[i].distance);
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (!is_free(i)) continue;
    const Nearest& near = nearest_[i];
    const auto cloth = static_cast<std::size_t>(cloth_of_[i]);
    const ColliderFrame<Real>& frame = frames_[static_cast<std::size_t>(near.object)];
    Vec3<Real> v = state.v[i];
    if (frame.moves) v -= frame.velocity_at(state.x[i]);
    const bool coming = v.dot(near.normal) < 0;
    const bool contact = near.distance < thickness_[cloth] && (coming || near.distance < 0);
    touches_ = touches_ || contact;
    if (contact && coming) {
      state.v[i] = seed::after_contact<Real>(v, near.normal, friction_[cloth], dissipation_[cloth]);
      if (frame.moves) state.v[i] += frame.velocity_at(state.x[i]);
    }
    if (def_.correction == Correction::fold_map) {
      const Real phi_min = deepest_[static_cast<std::size_t>(near.object)];
      const Real tau = static_cast<Real>(def_.fold_depth);
      state.x[i] +=
          near.normal * (seed::fold_map(near.distance, phi_min, tau, lift) - near.distance);
    } else if (contact) {
      state.x[i] += near.normal * (lift - near.distance);
    }
  }
}

/// Edges of the cloth against sharp edges of meshes: the same response for the nearest points of
/// both, shared by the ends of the cloth's edge.
template <class Real>
std::uint64_t SeedContact<Real>::collide_edges(ClothState<Real>& state) {
  std::uint64_t tests = 0;
  const BottomUpTree<Real>* cloth_edges = nullptr;
  const Vec3Array<Real>* around = nullptr;
  for (std::size_t o = 0; o < shapes_.size(); ++o) {
    const SeedShape<Real>& shape = shapes_[o];
    const ColliderFrame<Real>& frame = frames_[o];
    if (shape.sharp_edges.empty()) continue;
    const Vec3Array<Real>& x = in_frame_of(o, state.x);
    if (around != &x || frame.displaced) cloth_edges = &trees_.edges(x, edges_, reach_ / 2);
    around = &x;
    cloth_edges->for_each_pair(shape.edge_tree, [&](Index edge, Index sharp) {
      ++tests;
      const auto& e = edges_[static_cast<std::size_t>(edge)];
      const auto& r = shape.sharp_edges[static_cast<std::size_t>(sharp)];
      const auto i = static_cast<std::size_t>(e[0]), j = static_cast<std::size_t>(e[1]);
      const auto cloth = static_cast<std::size_t>(cloth_of_[i]);
      const SegmentPoints<Real> nearest =
          closest_of_segments<Real>(x[i], x[j], shape.positions[static_cast<std::size_t>(r.a)],
                                    shape.positions[static_cast<std::size_t>(r.b)]);
      if (!is_within_edge(nearest.s) || !is_within_edge(nearest.t)) return;
      const Vec3<Real> away = nearest.p - nearest.q;
      const bool outside = away.dot(r.normal) >= 0;
      const Real length = away.norm(), distance = outside ? length : -length;
      if (!(length < thickness_[cloth])) return;
      const Vec3<Real> normal =
          frame.world_direction(length > 0 ? (away / distance).eval() : r.normal);
      const Real wi = (Real(1) - nearest.s) * state.inverse_mass[i];
      const Real wj = nearest.s * state.inverse_mass[j];
      const Real mobility = (Real(1) - nearest.s) * wi + nearest.s * wj;
      if (!(mobility > 0)) return;
      Vec3<Real> v = state.v[i] * (Real(1) - nearest.s) + state.v[j] * nearest.s;
      if (frame.moves) v -= frame.velocity_at(state.x[i]);
      const bool coming = v.dot(normal) < 0;
      if (!coming && outside) return;
      touches_ = true;
      if (coming) {
        const Vec3<Real> change =
            (seed::after_contact<Real>(v, normal, friction_[cloth], dissipation_[cloth]) - v) /
            mobility;
        state.v[i] += change * wi;
        state.v[j] += change * wj;
      }
      const Vec3<Real> correction = normal * ((static_cast<Real>(def_.lift) - distance) / mobility);
      state.x[i] += correction * wi;
      state.x[j] += correction * wj;
    });
  }
  return tests;
}

template <class Real>
void SeedContact<Real>::collide(ClothState<Real>& state, Real dt, Profile& profile) {
  assert(dt > 0);
  assert(state.x.size() == nearest_.size() && state.v.size() == nearest_.size());
  if (shapes_.empty()) return;
  move_colliders(dt);
  find_nearest(state, dt, profile);
  const StageTimer timer(profile, Stage::contact, state.x.size());
  respond(state);
  if (def_.objects == ObjectContact::particles_and_edges)
    profile[Stage::narrow_phase].work += collide_edges(state);
}

template class SeedContact<float>;
template class SeedContact<double>;

}  // namespace weft
