// The broad phase of Contact: who is near what, and for how long that is known.

#include <algorithm>
#include <cmath>

#include "core/contact/contact.h"

namespace weft {
namespace {

/// How far beyond the distance that matters a clearance is searched for, so that a cloth that comes
/// nearer is not measured at every step [m].
constexpr double kClearanceHorizon = 0.1;

/// No point of a triangle is farther from its nearest corner than this part of its longest edge; it
/// is 1/sqrt(3), for the centre of an equilateral one.
constexpr double kTriangleSpan = 0.578;

/// Ticks of a particle's present motion for which candidates shall hold.
constexpr double kSkinTicks = 2.5;

/// Substeps of it for which they shall hold at least, however fast it is.
constexpr double kSkinSubsteps = 3;

/// Collections between two measurements of a particle that is near without having pairs.
constexpr std::size_t kTurns = 8;

}  // namespace

/// Clearance from the analytic shapes alone, at most `reach`.
template <class Real>
Real Contact<Real>::analytic_clearance(const Vec3<Real>& p, Real reach) const {
  Real nearest = reach;
  for (const Plane& plane : planes_)
    nearest = std::min(nearest, plane.normal.dot(p) - plane.offset);
  for (const Ball& ball : balls_)
    nearest = std::min(nearest, (p - ball.centre).norm() - ball.radius);
  for (const Rod& rod : rods_) {
    const Vec3<Real> q = rod.a + (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b);
    nearest = std::min(nearest, (p - q).norm() - rod.radius);
  }
  return nearest;
}

template <class Real>
Real Contact<Real>::clearance(const Vec3<Real>& p, Real reach) const {
  Real nearest = analytic_clearance(p, reach);
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const Vec3<Real> own = frames_[mesh_collider_[m]].own(p);
    if (mesh.triangle_tree.bounds().squared_distance(own) > reach * reach) continue;
    const MeshDistance<Real> d = distance_to_mesh(mesh, own, reach);
    if (d.triangle != kNone) nearest = std::min(nearest, d.distance);
  }
  return nearest;
}

/// A lower bound of the clearance of a point that is outside of every solid: boxes that could only
/// lower it by less than the slack are not looked into.
template <class Real>
Real Contact<Real>::least_clearance(const Vec3<Real>& p, Real reach) const {
  constexpr Real kSlack = Real(0.6);
  const Real nearest = analytic_clearance(p, reach);
  Real bound = nearest * nearest;
  if (!(nearest > 0)) return nearest;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const Vec3<Real> own = frames_[mesh_collider_[m]].own(p);
    bound = mesh.triangle_tree.nearest(
        bound, [&](const Aabb<Real>& box) { return box.squared_distance(own); },
        [&](Index t, Real best) {
          const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(t)];
          const auto corner = [&](std::size_t k) {
            return mesh.positions[static_cast<std::size_t>(triangle[k])];
          };
          const Real distance2 =
              (own - closest_on_triangle<Real>(own, corner(0), corner(1), corner(2)).point)
                  .squaredNorm();
          return std::min(best, distance2 * kSlack);
        });
  }
  return std::sqrt(bound);
}

template <class Real>
void Contact<Real>::collect(const ClothState<Real>& state, Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  measure_clearance(state, dt, profile);
  ++collections_;
  mark_near(state);
  collect_particle_pairs(state, profile);
  collect_feature_pairs(state, profile);
  mark_paired();
  x_collected_ = state.x;
  for (ColliderFrame<Real>& frame : frames_) frame.way_collected = 0;
  gone_ = 0;
  collected_ = true;
}

/// Brings each particle's clearance up to date; measures it anew only where the old one, less the
/// way gone since, no longer says that nothing is near.
template <class Real>
void Contact<Real>::measure_clearance(const ClothState<Real>& state, Real dt, Profile& profile) {
  const std::size_t n = state.x.size();
  const bool known = collected_ && clearance_.size() == n;
  if (!known) {
    clearance_.assign(n, Real(-1));
    near_.assign(n, 0);
    has_pairs_.assign(n, 0);
    collections_ = 0;
  }
  skin_.resize(n);
  span_.assign(n, Real(0));
  for (const Edge& e : edges_) {
    const auto i = static_cast<std::size_t>(e[0]), j = static_cast<std::size_t>(e[1]);
    const Real span = Real(kTriangleSpan) * (state.x[i] - state.x[j]).norm();
    span_[i] = std::max(span_[i], span);
    span_[j] = std::max(span_[j], span);
  }
  std::array<std::uint64_t, kChunks> tests{};
  run_chunks(executor_, kChunks, [&](int chunk) {
    const auto c = static_cast<std::size_t>(chunk);
    for (std::size_t i = n * c / kChunks; i < n * (c + 1) / kChunks; ++i) {
      const Real speed = state.v[i].norm() + surface_speed_;
      const Real most = std::max(widest_skin_, speed * dt * Real(kSkinSubsteps));
      skin_[i] = std::max(thickness_ * 2, std::min(speed * tick_seconds_ * Real(kSkinTicks), most));
      const Real needed = thickness_ + span_[i] + skin_[i];
      if (known) clearance_[i] -= (state.x[i] - x_collected_[i]).norm() + gone_;
      if (clearance_[i] > needed) continue;
      // Who was near before had its clearance measured by its pairs. Those without pairs are
      // measured now and then, in turns, to see whether they have gone.
      const bool turn = (collections_ + i) % kTurns == 0;
      if (known && near_[i] && (has_pairs_[i] || !turn)) continue;
      const Real horizon = needed + static_cast<Real>(kClearanceHorizon);
      // Who was clear of everything is still outside, and a bound is cheaper than the distance.
      const Real bound = clearance_[i] > 0 ? least_clearance(state.x[i], horizon) : Real(0);
      clearance_[i] = bound > needed ? bound : clearance(state.x[i], horizon);
      ++tests[c];
    }
  });
  for (const std::uint64_t count : tests) profile[Stage::broad_phase].work += count;
}

/// A particle is near if it, or a point of an edge or triangle at it, can touch something within
/// its skin. Those joined to it are kept on as short a leash; the others may go as far as they are
/// clear.
template <class Real>
void Contact<Real>::mark_near(const ClothState<Real>& state) {
  const std::size_t n = state.x.size();
  for (std::size_t i = 0; i < n; ++i) near_[i] = clearance_[i] <= thickness_ + span_[i] + skin_[i];
  active_ = near_;
  near_edges_.clear();
  near_triangles_.clear();
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto i = static_cast<std::size_t>(edges_[e][0]),
               j = static_cast<std::size_t>(edges_[e][1]);
    if (!near_[i] && !near_[j]) continue;
    active_[i] = active_[j] = 1;
    near_edges_.push_back(static_cast<Index>(e));
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto is_near = [&](Index i) { return near_[static_cast<std::size_t>(i)] != 0; };
    if (std::any_of(triangles_[t].begin(), triangles_[t].end(), is_near))
      near_triangles_.push_back(static_cast<Index>(t));
  }
  active_particles_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (active_[i])
      active_particles_.push_back(static_cast<Index>(i));
    else
      skin_[i] = clearance_[i] - thickness_ - span_[i];
  }
}

/// Runs `visit(n, Found&)` for n below count in chunks and joins what they find in order.
template <class Real>
template <class Visit>
void Contact<Real>::collect_kind(std::size_t count, std::vector<ContactCandidate<Real>>& into,
                                 Profile& profile, Visit&& visit) {
  run_chunks(executor_, kChunks, [&](int chunk) {
    const auto c = static_cast<std::size_t>(chunk);
    found_[c].pairs.clear();
    found_[c].tests = 0;
    for (std::size_t n = count * c / kChunks; n < count * (c + 1) / kChunks; ++n)
      visit(n, found_[c]);
  });
  into.clear();
  for (const Found& found : found_) {
    into.insert(into.end(), found.pairs.begin(), found.pairs.end());
    profile[Stage::narrow_phase].work += found.tests;
  }
  profile[Stage::broad_phase].work += into.size();
}

/// Particles against triangles of the meshes; measures their clearance on the way.
template <class Real>
void Contact<Real>::collect_particle_pairs(const ClothState<Real>& state, Profile& profile) {
  const auto x = [&](Index i) -> const Vec3<Real>& { return state.x[static_cast<std::size_t>(i)]; };
  const auto skin = [&](Index i) { return skin_[static_cast<std::size_t>(i)]; };
  const auto clear = [&](Index i) { return clearance_[static_cast<std::size_t>(i)]; };
  fresh_clearance_.resize(state.x.size());
  for (const Index i : active_particles_) {
    fresh_clearance_[static_cast<std::size_t>(i)] = analytic_clearance(x(i), thickness_ + skin(i));
    has_pairs_[static_cast<std::size_t>(i)] = 0;
  }
  take_to_own(state.x);
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto own_x = [&](Index i) -> const Vec3<Real>& {
      return own[static_cast<std::size_t>(i)];
    };
    collect_kind(active_particles_.size(), particle_pairs_[m], profile,
                 [&](std::size_t n, Found& found) {
                   const Index i = active_particles_[n];
                   const Real reach = thickness_ + skin(i);
                   if (clear(i) > reach) return;
                   Aabb<Real> box;
                   box.add(own_x(i));
                   bool any = false;
                   Real nearest = reach;
                   mesh.triangle_tree.for_each_overlap(box.grown(reach), [&](Index t) {
                     const MeshDistance<Real> d = distance_to_triangle(mesh, t, own_x(i));
                     ++found.tests;
                     if (std::abs(d.distance) > reach) return;
                     found.pairs.push_back({i, t, std::abs(d.distance)});
                     if (std::abs(d.distance) < std::abs(nearest)) nearest = d.distance;
                     any = true;
                   });
                   const auto p = static_cast<std::size_t>(i);
                   // Deep inside a solid nothing is within reach, yet the particle must find its
                   // way out.
                   if (!any && mesh.closed && clearance_[p] < 0) {
                     const MeshDistance<Real> d = distance_to_mesh(mesh, own_x(i), Real(1000));
                     if (d.triangle != kNone && d.distance < 0)
                       found.pairs.push_back({i, d.triangle, Real(0)});
                     nearest = std::min(nearest, d.distance);
                     any = d.distance < 0;
                   }
                   has_pairs_[p] = has_pairs_[p] || any;
                   fresh_clearance_[p] = std::min(fresh_clearance_[p], nearest);
                 });
  }
  // The pairs have measured the clearance, up to the reach; both this and the old one are bounds.
  for (const Index i : active_particles_) {
    const auto p = static_cast<std::size_t>(i);
    const Real fresh = fresh_clearance_[p];
    clearance_[p] = fresh < thickness_ + skin_[p] ? fresh : std::max(clearance_[p], fresh);
  }
}

/// Only those that are in a pair need planes that follow them closely.
template <class Real>
void Contact<Real>::mark_paired() {
  paired_.assign(active_.size(), 0);
  const auto mark = [&](Index i) { paired_[static_cast<std::size_t>(i)] = 1; };
  for (const Index i : active_particles_) {
    const auto p = static_cast<std::size_t>(i);
    if (clearance_[p] <= thickness_ + skin_[p]) mark(i);
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    for (const auto& pair : particle_pairs_[m]) mark(pair.cloth);
    for (const auto& pair : edge_pairs_[m]) {
      for (const Index i : edges_[static_cast<std::size_t>(pair.cloth)]) mark(i);
    }
    for (const auto& pair : triangle_pairs_[m]) {
      for (const Index i : triangles_[static_cast<std::size_t>(pair.cloth)]) mark(i);
    }
  }
  if (balls_.empty() && rods_.empty()) return;
  // Edges and triangles meet round shapes without pairs, so all near ones may.
  for (const Index e : near_edges_) {
    for (const Index i : edges_[static_cast<std::size_t>(e)]) mark(i);
  }
}

/// Edges against ridges and triangles against corners of the meshes.
template <class Real>
void Contact<Real>::collect_feature_pairs(const ClothState<Real>& state, Profile& profile) {
  const auto skin = [&](Index i) { return skin_[static_cast<std::size_t>(i)]; };
  const auto clear = [&](Index i) { return clearance_[static_cast<std::size_t>(i)]; };
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto x = [&](Index i) -> const Vec3<Real>& { return own[static_cast<std::size_t>(i)]; };
    const auto at = [&](Index v) -> const Vec3<Real>& {
      return mesh.positions[static_cast<std::size_t>(v)];
    };
    collect_kind(near_edges_.size(), edge_pairs_[m], profile, [&](std::size_t n, Found& found) {
      const Edge& e = edges_[static_cast<std::size_t>(near_edges_[n])];
      const Real reach = thickness_ + std::max(skin(e[0]), skin(e[1]));
      // No point of the edge is nearer than this, by the clearances of its ends.
      if ((clear(e[0]) + clear(e[1]) - (x(e[0]) - x(e[1])).norm()) / 2 > reach) return;
      Aabb<Real> box;
      box.add(x(e[0]));
      box.add(x(e[1]));
      mesh.edge_tree.for_each_overlap(box.grown(reach), [&](Index s) {
        const Index k = mesh.sharp_edges[static_cast<std::size_t>(s)];
        const MeshEdge& other = mesh.edges[static_cast<std::size_t>(k)];
        const auto c = closest_of_segments<Real>(x(e[0]), x(e[1]), at(other.a), at(other.b));
        const Real distance = (c.p - c.q).norm();
        ++found.tests;
        if (distance <= reach) found.pairs.push_back({near_edges_[n], k, distance});
      });
    });
    collect_kind(near_triangles_.size(), triangle_pairs_[m], profile,
                 [&](std::size_t n, Found& found) {
                   const Triangle& t = triangles_[static_cast<std::size_t>(near_triangles_[n])];
                   const Real reach = thickness_ + std::max({skin(t[0]), skin(t[1]), skin(t[2])});
                   const auto lowest = [&](const std::vector<Real>& values) {
                     return std::min({values[static_cast<std::size_t>(t[0])],
                                      values[static_cast<std::size_t>(t[1])],
                                      values[static_cast<std::size_t>(t[2])]});
                   };
                   const auto span = [&](Index i) { return span_[static_cast<std::size_t>(i)]; };
                   if (lowest(clearance_) - std::max({span(t[0]), span(t[1]), span(t[2])}) > reach)
                     return;
                   Aabb<Real> box;
                   for (const Index i : t) box.add(x(i));
                   mesh.vertex_tree.for_each_overlap(box.grown(reach), [&](Index s) {
                     const Index v = mesh.sharp_vertices[static_cast<std::size_t>(s)];
                     const auto c = closest_on_triangle<Real>(at(v), x(t[0]), x(t[1]), x(t[2]));
                     const Real distance = (c.point - at(v)).norm();
                     ++found.tests;
                     if (distance <= reach)
                       found.pairs.push_back({near_triangles_[n], v, distance});
                   });
                 });
  }
}

#define WEFT_INSTANTIATE(Real)                                                             \
  template Real Contact<Real>::analytic_clearance(const Vec3<Real>&, Real) const;          \
  template Real Contact<Real>::clearance(const Vec3<Real>&, Real) const;                   \
  template Real Contact<Real>::least_clearance(const Vec3<Real>&, Real) const;             \
  template void Contact<Real>::collect(const ClothState<Real>&, Real, Profile&);           \
  template void Contact<Real>::measure_clearance(const ClothState<Real>&, Real, Profile&); \
  template void Contact<Real>::mark_near(const ClothState<Real>&);                         \
  template void Contact<Real>::collect_particle_pairs(const ClothState<Real>&, Profile&);  \
  template void Contact<Real>::mark_paired();                                              \
  template void Contact<Real>::collect_feature_pairs(const ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
