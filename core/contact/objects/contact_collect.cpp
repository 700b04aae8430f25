// The broad phase of Contact: who is near what, and for how long that is known.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/constants.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/corners.h"

namespace weft {
namespace {

/// How far beyond the distance that matters a clearance is searched for, so that a cloth that comes
/// nearer is not measured at every step [m].
constexpr double kClearanceHorizon = 0.1;

/// Ticks of a particle's present motion for which candidates shall hold.
constexpr double kSkinTicks = 2.5;

/// Substeps of it for which they shall hold at least, however fast it is.
constexpr double kSkinSubsteps = 4;

/// Clearance of what sleeps [m]: no list ever has it.
constexpr double kOutOfReach = 1e9;

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
  Real farthest = 0;
  for (const Vec3<Real>& x : state.x) farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
  const Real rounding = farthest * std::numeric_limits<Real>::epsilon();
  smallest_gap_ = std::max(Real(kSmallestGap), rounding * Real(kRoundings));
  measure_clearance(state, dt, profile);
  ++collections_;
  mark_near(state);
  collect_pairs(state, profile);
  extend_skins();
  mark_paired();
  x_collected_ = state.x;
  for (ColliderFrame<Real>& frame : frames_) frame.travel_since_pairs = 0;
  gone_ = 0;
  collected_ = true;
}

template <class Real>
Real Contact<Real>::wanted_skin(const ClothState<Real>& state, std::size_t i, Real dt) const {
  const Real speed = state.v[i].norm() + surface_speed_;
  const Real most = std::max(widest_skin_, speed * dt * Real(kSkinSubsteps));
  return std::max(thickness_ * 2, std::min(speed * tick_seconds_ * Real(kSkinTicks), most));
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
  for (const Edge& e : patches_.edges) {
    const auto i = static_cast<std::size_t>(e[0]), j = static_cast<std::size_t>(e[1]);
    const Real span = Real(kTriangleSpan) * (state.x[i] - state.x[j]).norm();
    span_[i] = std::max(span_[i], span);
    span_[j] = std::max(span_[j], span);
  }
  std::array<std::uint64_t, kChunks> tests{};
  run_chunks(executor_, kChunks, [&](int chunk) {
    const auto c = static_cast<std::size_t>(chunk);
    for (std::size_t i = n * c / kChunks; i < n * (c + 1) / kChunks; ++i) {
      if (!resting_.empty() && resting_[i]) {
        clearance_[i] = Real(kOutOfReach);
        skin_[i] = 0;
        continue;
      }
      skin_[i] = wanted_skin(state, i, dt);
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

template <class Real>
Real Contact<Real>::calm_room(const ClothState<Real>& state) const {
  if (!collected_ || !rows_built_ || !rows_.empty() || !exits_.empty() || !stands_still()) return 0;
  Real room = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < state.x.size(); ++i)
    room = std::min(room, row_reach_[i] - (state.x[i] - x_rows_[i]).norm());
  return std::max(room, Real(0));
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
  active_particles_.clear();
  near_patches_.clear();
  const auto is_near = [&](Index i) { return near_[static_cast<std::size_t>(i)] != 0; };
  const auto number = [](const auto& list) { return static_cast<Index>(list.size()); };
  for (std::size_t e = 0; e < patches_.edges.size(); ++e) {
    const Edge& ends = patches_.edges[e];
    if (is_near(ends[0]) || is_near(ends[1]))
      active_[static_cast<std::size_t>(ends[0])] = active_[static_cast<std::size_t>(ends[1])] = 1;
  }
  for (std::size_t p = 0; p < patches_.list.size(); ++p) {
    const ClothPatch& patch = patches_.list[p];
    NearPatch near{
        p, {number(active_particles_), 0}, {number(near_edges_), 0}, {number(near_triangles_), 0}};
    for (Index k = patch.particles.first; k < patch.particles.end(); ++k) {
      const Index i = patches_.particles[static_cast<std::size_t>(k)];
      if (active_[static_cast<std::size_t>(i)]) active_particles_.push_back(i);
    }
    for (Index e = patch.edges.first; e < patch.edges.end(); ++e) {
      const Edge& ends = patches_.edges[static_cast<std::size_t>(e)];
      if (is_near(ends[0]) || is_near(ends[1])) near_edges_.push_back(e);
    }
    for (Index t = patch.triangles.first; t < patch.triangles.end(); ++t) {
      const Triangle& corners = patches_.triangles[static_cast<std::size_t>(t)];
      if (std::any_of(corners.begin(), corners.end(), is_near)) near_triangles_.push_back(t);
    }
    near.particles.count = number(active_particles_) - near.particles.first;
    near.edges.count = number(near_edges_) - near.edges.first;
    near.triangles.count = number(near_triangles_) - near.triangles.first;
    if (near.particles.count + near.edges.count + near.triangles.count > 0)
      near_patches_.push_back(near);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!active_[i]) skin_[i] = clearance_[i] - thickness_ - span_[i];
  }
}

/// Gives particles that are in no list, and that go farther than they may, a new clearance.
/// @return whether all stay within their reach then, so that every list stays valid
template <class Real>
bool Contact<Real>::renew_clear(const ClothState<Real>& state, Real dt, Profile& profile) {
  if (!collected_ || !rows_built_ || !stands_still()) return false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (travel2_[i] <= row_reach_[i] * row_reach_[i]) continue;
    if (!renew_clearance(state, i, dt)) return false;
    ++profile[Stage::broad_phase].work;
  }
  return measure_way(state, dt);
}

/// Measures the clearance of a particle that is in no list, and neither are its edges and
/// triangles.
/// @return whether they are still clear of everything
template <class Real>
bool Contact<Real>::renew_clearance(const ClothState<Real>& state, std::size_t i, Real dt) {
  if (active_[i]) return false;
  const auto joined = [&](auto&& visit) {
    for (const auto& neighbour : patches_.neighbours.of(i)) {
      const auto j = static_cast<std::size_t>(neighbour.particle);
      visit(j, Real(kTriangleSpan) * (state.x[i] - state.x[j]).norm());
    }
  };
  Real longest = 0;
  joined([&](std::size_t, Real span) { longest = std::max(longest, span); });
  const Real needed = thickness_ + longest + state.v[i].norm() * dt * Real(kSkinSubsteps);
  const Real clear = least_clearance(state.x[i], needed + static_cast<Real>(kClearanceHorizon));
  if (!(clear > needed)) return false;
  clearance_[i] = clear;
  span_[i] = longest;
  skin_[i] = row_reach_[i] = clear - thickness_ - longest;
  x_collected_[i] = x_rows_[i] = state.x[i];
  // Edges may have grown since the other end was measured.
  joined([&](std::size_t j, Real span) {
    const Real growth = span - span_[j];
    if (!(growth > 0)) return;
    span_[j] = span;
    skin_[j] = std::max(Real(0), skin_[j] - growth);
    row_reach_[j] = std::max(Real(0), row_reach_[j] - growth);
  });
  return true;
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
      for (const Index i : patches_.edges[static_cast<std::size_t>(pair.cloth)]) mark(i);
    }
    for (const auto& pair : triangle_pairs_[m]) {
      for (const Index i : patches_.triangles[static_cast<std::size_t>(pair.cloth)]) mark(i);
    }
  }
  if (balls_.empty() && rods_.empty()) return;
  // Edges and triangles meet round shapes without pairs, so all near ones may.
  for (const Index e : near_edges_) {
    for (const Index i : patches_.edges[static_cast<std::size_t>(e)]) mark(i);
  }
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template void Contact<Real>::mark_paired();                                                 \
  template Real Contact<Real>::calm_room(const ClothState<Real>&) const;                      \
  template Real Contact<Real>::analytic_clearance(const Vec3<Real>&, Real) const;             \
  template Real Contact<Real>::clearance(const Vec3<Real>&, Real) const;                      \
  template Real Contact<Real>::least_clearance(const Vec3<Real>&, Real) const;                \
  template void Contact<Real>::collect(const ClothState<Real>&, Real, Profile&);              \
  template void Contact<Real>::measure_clearance(const ClothState<Real>&, Real, Profile&);    \
  template void Contact<Real>::mark_near(const ClothState<Real>&);                            \
  template Real Contact<Real>::wanted_skin(const ClothState<Real>&, std::size_t, Real) const; \
  template bool Contact<Real>::renew_clear(const ClothState<Real>&, Real, Profile&);          \
  template bool Contact<Real>::renew_clearance(const ClothState<Real>&, std::size_t, Real);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
