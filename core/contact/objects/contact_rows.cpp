// The narrow phase of Contact: planes between the cloth's features and the objects', frozen for a
// few substeps.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/objects/apart.h"
#include "core/contact/objects/contact.h"

namespace weft {
namespace {

/// Substeps of a particle's present motion for which rows shall hold. Among objects at rest it need
/// not go farther than so many thicknesses, or in long substeps for so few of them: of who may go
/// far, edges and triangles need rows of their own.
constexpr double kRowSubsteps = 14, kRowThicknesses = 2, kFewSubsteps = 2;

/// Rows shall hold for so much of the way of a particle to the next analytic shape, too.
constexpr double kFreePart = 0.4;

/// Whether a triangle has the corner, or both corners of the edge, that another one is nearest at.
template <class Real>
bool shares_nearest(const MeshShape<Real>& mesh, const MeshDistance<Real>& d, Index t) {
  const Triangle &own = mesh.triangles[static_cast<std::size_t>(d.triangle)],
                 &other = mesh.triangles[static_cast<std::size_t>(t)];
  const auto has = [&](int corner) {
    return std::find(other.begin(), other.end(), own[static_cast<std::size_t>(corner % 3)]) !=
           other.end();
  };
  if (d.feature == 0) return false;
  return d.feature <= 3 ? has(d.feature - 1) : has(d.feature - 4) && has(d.feature - 3);
}

}  // namespace

/// Whether all lists stay valid through the coming drift.
template <class Real>
bool Contact<Real>::rows_hold(const ClothState<Real>& state, Real dt) {
  if (!collected_ || !rows_built_) return false;
  if (stands_still()) return measure_way(state, dt);
  const Real less = way_rows_ + way_step_;  // what objects have taken of the reach, and will
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3<Real> next = state.x[i] + state.v[i] * dt;
    const Real reach = row_reach_[i] - less;
    const Real way2 =
        std::max((next - x_rows_[i]).squaredNorm(), (state.x[i] - x_rows_[i]).squaredNorm());
    if (!(way2 <= reach * std::abs(reach))) return false;
  }
  return true;
}

/// Builds the rows anew from the candidates, which are collected again first if they do not hold.
template <class Real>
void Contact<Real>::rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  const std::size_t n = state.x.size();
  row_reach_.resize(n);
  moved_.resize(n);
  const bool edges_matter = !(balls_.empty() && rods_.empty() && meshes_.empty());
  const auto allow = [&] {
    bool enough = true;
    for (std::size_t i = 0; i < n; ++i) {
      moved_[i] = (state.x[i] - x_collected_[i]).norm();
      const Real left = skin_[i] - moved_[i] - gone_;
      const Real step = state.v[i].norm() * dt;
      // An object and what it carries along both go its way.
      enough &= left >= step * Real(1.5) + way_step_ * Real(3);
      Real wanted = (step + way_step_) * Real(kRowSubsteps);
      if (edges_matter && !any_tracked_)
        wanted = std::min(wanted,
                          std::max(thickness_ * Real(kRowThicknesses), step * Real(kFewSubsteps)));
      wanted = std::max(wanted, thickness_ / 2);
      // Who is clear of everything may go farther without touching.
      if (meshes_.empty() && paired_[i] && wanted < left)
        wanted =
            std::max(wanted, (analytic_clearance(state.x[i], left / Real(kFreePart)) - thickness_) *
                                 Real(kFreePart));
      row_reach_[i] = paired_[i] ? std::min(left, wanted) : left;
    }
    return enough;
  };
  if (!collected_ || !allow()) {
    collect(state, dt, profile);
    allow();
  }
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  x_rows_ = state.x;
  for (ColliderFrame<Real>& frame : frames_) frame.travel_since_rows = 0;
  way_rows_ = way_step_;
  take_to_own(state.x);
  log_.before_rebuild(rows_);
  rows_.clear();
  moving_rows_.clear();
  travel2_.resize(n);
  gap_.resize(n);
  for (std::size_t i = 0; i < n; ++i) gap_[i] = thickness_ + row_reach_[i];
  add_particle_rows(state, profile);
  add_features_on_rounds(state, profile);
  add_edges_on_meshes(state, profile);
  add_triangles_on_meshes(state, profile);
  std::erase_if(exits_, [](const BadStart<Real>& exit) { return exit.particles == 0; });
  measure_rooms();
  find_lone_rows(n);
  rows_built_ = true;
}

/// What the plane is worth is told by the heights of the particles over it, in double precision,
/// whatever it was found by.
template <class Real>
void Contact<Real>::add_row(const ClothState<Real>& state, std::initializer_list<Index> particles,
                            const std::array<Real, 3>& weights, const Barrier& barrier,
                            std::size_t collider, bool responds) {
  ContactRow<Real> row;
  Real mobility = 0;
  double least = std::numeric_limits<double>::infinity();
  const Vec3d normal = barrier.normal.template cast<double>();
  for (const Index i : particles) {
    const auto k = static_cast<std::size_t>(row.count++);
    const auto p = static_cast<std::size_t>(i);
    row.particle[k] = i;
    row.weight[k] = weights[k];
    mobility += weights[k] * weights[k] * state.inverse_mass[p];
    least = std::min(least, normal.dot(state.x[p].template cast<double>()) - barrier.top);
  }
  // What is pinned stops only what moves.
  const bool held = !(mobility > 0);
  if (held && !frames_[collider].tracked) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count) && !held; ++k)
    row.share[k] =
        row.weight[k] * state.inverse_mass[static_cast<std::size_t>(row.particle[k])] / mobility;
  row.least_height = static_cast<Real>(least);
  row.distance = barrier.distance;
  row.keep = std::max(barrier.keep, smallest_gap_);
  row.collider = static_cast<Index>(collider);
  row.responds = responds && !held;
  row.cloth = cloth_of(row.particle[0]);
  row.thickness = static_cast<Real>(cloths_[static_cast<std::size_t>(row.cloth)].thickness);
  row.normal = barrier.normal;
  row.offset = static_cast<Real>(barrier.top);
  if (frames_[collider].tracked) {
    row.mover = static_cast<Index>(moving_rows_.size());
    follow(row, barrier.top, collider, mobility);
  }
  rows_.push_back(row);
}

/// Rows of one particle with the triangles of one mesh. Whether it is inside a solid is told by the
/// nearest triangle alone; inside, only the nearest way out counts. Outside, every triangle is kept
/// off from the side on which the particle is, whatever side of a thin solid that is.
/// @return closest points computed
template <class Real>
std::uint64_t Contact<Real>::add_mesh_rows(const ClothState<Real>& state, std::size_t m, Index i) {
  const auto p = static_cast<std::size_t>(i);
  const std::size_t collider = mesh_collider_[m];
  const ColliderFrame<Real>& frame = frames_[collider];
  const Vec3<Real>& x = in_frame_of(m, state.x)[p];
  const Real reach = thickness_ + row_reach_[p];
  const Real moved = moved_[p] + frame.travel_since_pairs;
  // Whoever is inside looks for the way out, however far it is.
  const bool outside = clearance_[p] >= 0;
  const auto& pairs = particle_pairs_[m];  // in the order of the active particles
  std::size_t nearest = 0;
  nearby_.clear();
  for (; cursor_[m] < pairs.size() && pairs[cursor_[m]].cloth == i; ++cursor_[m]) {
    if (outside && pairs[cursor_[m]].distance - moved > reach) continue;
    nearby_.push_back(distance_to_triangle(meshes_[m], pairs[cursor_[m]].feature, x));
    if (std::abs(nearby_.back().distance) < std::abs(nearby_[nearest].distance))
      nearest = nearby_.size() - 1;
  }
  if (nearby_.empty()) return 0;
  gap_[p] = std::min(gap_[p], nearby_[nearest].distance);
  if (nearby_[nearest].distance < 0) {
    note_inside(i, collider);
    add_inside(state, i, frame.world_direction(nearby_[nearest].normal), nearby_[nearest].distance,
               collider);
    return nearby_.size();
  }
  for (const MeshDistance<Real>& d : nearby_) {
    const Real distance = std::abs(d.distance);
    if (distance > reach) continue;
    Barrier barrier{frame.world_direction(d.distance < 0 ? (-d.normal).eval() : d.normal), 0,
                    distance};
    const Triangle& t = meshes_[m].triangles[static_cast<std::size_t>(d.triangle)];
    barrier.top = top_of(m, barrier.normal, {t[0], t[1], t[2]});
    // Where the surface goes on from the border of a triangle, nearer to the particle, what lies
    // beyond carries: a plane at the border would stand in the way of whatever slides over it.
    const bool goes_on =
        std::any_of(nearby_.begin(), nearby_.end(), [&](const MeshDistance<Real>& other) {
          return std::abs(other.distance) < distance &&
                 shares_nearest(meshes_[m], d, other.triangle);
        });
    add_row(state, {i}, {Real(1), 0, 0}, barrier, collider, !goes_on);
  }
  return nearby_.size();
}

template <class Real>
void Contact<Real>::add_particle_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto reach_of = [&](Index i) {
    return thickness_ + row_reach_[static_cast<std::size_t>(i)];
  };
  /// The axis of the object from a to b, and a radius about it.
  const auto add_round = [&](Index i, const Vec3<Real>& from, const Vec3<Real>& to, Real radius,
                             std::size_t collider) {
    const Vec3<Real>& x = state.x[static_cast<std::size_t>(i)];
    const Real far = radius + reach_of(i) + smallest_gap_;
    if ((x - from - (to - from) * closest_on_segment(x, from, to)).squaredNorm() > far * far)
      return;
    const Vec3d p = in_double(x), a = in_double(from), b = in_double(to);
    const Vec3d q = a + (b - a) * closest_on_segment<double>(p, a, b);
    const Apart side = apart(p, q);
    const Vec3<Real> normal = side.normal.cast<Real>();
    const Real distance = static_cast<Real>(side.distance) - radius;
    if (distance > reach_of(i)) return;
    if (distance < 0) return add_inside(state, i, normal, distance, collider);
    const Vec3d n = in_double(normal);
    const double top = std::max(n.dot(a), n.dot(b)) + static_cast<double>(radius);
    add_row(state, {i}, {Real(1), 0, 0}, {normal, top, distance, kept_height(i, distance)},
            collider);
  };
  for (BadStart<Real>& exit : exits_) exit.particles = 0;
  cursor_.assign(meshes_.size(), 0);
  inside_.assign(state.x.size(), kOutside);
  for (const Index i : active_particles_) {
    const Vec3<Real>& p = state.x[static_cast<std::size_t>(i)];
    for (const Plane& plane : planes_) {
      const Real distance = plane.normal.dot(p) - plane.offset;
      if (distance <= reach_of(i))
        add_row(state, {i}, {Real(1), 0, 0},
                {plane.normal, static_cast<double>(plane.offset), distance}, plane.collider);
    }
    for (const Ball& ball : balls_)
      add_round(i, ball.centre, ball.centre, ball.radius, ball.collider);
    for (const Rod& rod : rods_) add_round(i, rod.a, rod.b, rod.radius, rod.collider);
    tests += planes_.size() + balls_.size() + rods_.size();
    for (std::size_t m = 0; m < meshes_.size(); ++m) tests += add_mesh_rows(state, m, i);
  }
  profile[Stage::narrow_phase].work += tests;
}

/// The highest of some vertices of a mesh along a direction [m].
/// @param normal  in the world
template <class Real>
double Contact<Real>::top_of(std::size_t m, const Vec3<Real>& normal,
                             std::initializer_list<Index> vertices) const {
  const ColliderFrame<Real>& frame = frames_[mesh_collider_[m]];
  const Vec3d n = normal.template cast<double>();
  double top = -std::numeric_limits<double>::infinity();
  for (const Index v : vertices) {
    const Vec3<Real> at = frame.world(meshes_[m].positions[static_cast<std::size_t>(v)]);
    top = std::max(top, n.dot(at.template cast<double>()));
  }
  return top;
}

#define WEFT_INSTANTIATE(Real)                                                                  \
  template bool Contact<Real>::rows_hold(const ClothState<Real>&, Real);                        \
  template void Contact<Real>::rebuild_rows(const ClothState<Real>&, Real, Profile&);           \
  template void Contact<Real>::add_particle_rows(const ClothState<Real>&, Profile&);            \
  template void Contact<Real>::add_row(const ClothState<Real>&, std::initializer_list<Index>,   \
                                       const std::array<Real, 3>&, const Barrier&, std::size_t, \
                                       bool);                                                   \
  template double Contact<Real>::top_of(std::size_t, const Vec3<Real>&,                         \
                                        std::initializer_list<Index>) const;                    \
  template std::uint64_t Contact<Real>::add_mesh_rows(const ClothState<Real>&, std::size_t, Index);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
