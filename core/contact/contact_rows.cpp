// The narrow phase of Contact: planes between the cloth's features and the objects', frozen for a
// few substeps.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/contact.h"
#include "core/contact/corner_span.h"

namespace weft {
namespace {

/// Substeps of a particle's present motion for which rows shall hold.
constexpr double kRowSubsteps = 14;

/// A pair of edges closest at an end belongs to a particle or a vertex instead.
constexpr double kEdgeEnd = 0.01;

/// What keeps corners off now, while what they may come to is only certified: at rest particles
/// alone carry the cloth on a smooth object.
template <class Corners>
Corners as_now(Corners corners, double part) {
  using Real = decltype(corners.reach);
  corners.span -= 2 * corners.reach * static_cast<Real>(part);
  corners.gap += corners.reach;
  corners.reach = 0;
  return corners;
}

/// Direction from q to p, and their distance.
template <class Real>
struct Separation {
  Vec3<Real> normal;
  Real distance;
};

/// @param outward  serves for points so near that their direction is rounding
template <class Real>
Separation<Real> separate(const Vec3<Real>& p, const Vec3<Real>& q, const Vec3<Real>& outward) {
  const Vec3<Real> away = p - q;
  const Real distance = away.norm();
  if (!(distance > Real(1e-6))) return {outward, Real(0)};
  return {away / distance, distance};
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
    if (!((next - x_rows_[i]).squaredNorm() <= reach * std::abs(reach))) return false;
  }
  return true;
}

/// Builds the rows anew from the candidates, which are collected again first if they do not hold.
template <class Real>
void Contact<Real>::rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  const std::size_t n = state.x.size();
  row_reach_.resize(n);
  moved_.resize(n);
  const auto allow = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      moved_[i] = (state.x[i] - x_collected_[i]).norm();
      const Real left = skin_[i] - moved_[i] - gone_;
      const Real step = state.v[i].norm() * dt;
      // An object and what it carries along both go its way.
      if (!(left >= step * Real(1.5) + way_step_ * Real(3))) return false;
      const Real wanted = std::max(thickness_ / 2, (step + way_step_) * Real(kRowSubsteps));
      row_reach_[i] = paired_[i] ? std::min(left, wanted) : left;
    }
    return true;
  };
  if (!collected_ || !allow()) {
    collect(state, dt, profile);
    allow();
  }
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  x_rows_ = state.x;
  for (ColliderFrame<Real>& frame : frames_) frame.way_rows = 0;
  way_rows_ = way_step_;
  take_to_own(state.x);
  rows_.clear();
  moving_rows_.clear();
  travel2_.resize(n);
  gap_.resize(n);
  for (std::size_t i = 0; i < n; ++i) gap_[i] = thickness_ + row_reach_[i];
  add_particle_rows(state, profile);
  add_edge_rows(state, profile);
  add_triangle_rows(state, profile);
  std::erase_if(exits_, [](const BadStart<Real>& exit) { return exit.particles == 0; });
  measure_rooms();
  rows_built_ = true;
}

template <class Real>
void Contact<Real>::add_row(const ClothState<Real>& state, std::initializer_list<Index> particles,
                            const std::array<Real, 3>& weights, const Vec3<Real>& normal,
                            Real distance, std::size_t collider, bool responds) {
  ContactRow<Real> row;
  Real mobility = 0, height = 0;
  for (const Index i : particles) {
    const auto k = static_cast<std::size_t>(row.count++);
    row.particle[k] = i;
    row.weight[k] = weights[k];
    mobility += weights[k] * weights[k] * state.inverse_mass[static_cast<std::size_t>(i)];
    height += weights[k] * normal.dot(state.x[static_cast<std::size_t>(i)]);
  }
  // What is pinned stops only what moves.
  const bool held = !(mobility > 0);
  if (held && !frames_[collider].tracked) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count) && !held; ++k)
    row.share[k] =
        row.weight[k] * state.inverse_mass[static_cast<std::size_t>(row.particle[k])] / mobility;
  row.least_height = std::numeric_limits<Real>::infinity();
  for (const Index i : particles)
    row.least_height = std::min(
        row.least_height, normal.dot(state.x[static_cast<std::size_t>(i)]) - (height - distance));
  row.distance = distance;
  row.collider = static_cast<Index>(collider);
  row.responds = responds && !held;
  row.cloth = cloth_of(row.particle[0]);
  row.thickness = static_cast<Real>(cloths_[static_cast<std::size_t>(row.cloth)].thickness);
  row.normal = normal;
  row.offset = height - distance;
  if (frames_[collider].tracked) {
    row.mover = static_cast<Index>(moving_rows_.size());
    follow(row, collider, mobility);
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
  const Real moved = moved_[p] + frame.way_collected;
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
    inside_[p] = 1;
    add_inside(state, i, frame.world_direction(nearby_[nearest].normal), nearby_[nearest].distance,
               collider);
    return nearby_.size();
  }
  for (const MeshDistance<Real>& d : nearby_) {
    const Real distance = std::abs(d.distance);
    if (distance > reach) continue;
    const Vec3<Real> normal = d.distance < 0 ? (-d.normal).eval() : d.normal;
    add_row(state, {i}, {Real(1), 0, 0}, frame.world_direction(normal), distance, collider);
  }
  return nearby_.size();
}

template <class Real>
void Contact<Real>::add_particle_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto reach_of = [&](Index i) {
    return thickness_ + row_reach_[static_cast<std::size_t>(i)];
  };
  const auto add = [&](Index i, const Vec3<Real>& normal, Real distance, std::size_t collider) {
    if (distance <= reach_of(i)) add_row(state, {i}, {Real(1), 0, 0}, normal, distance, collider);
  };
  const auto add_round = [&](Index i, const Vec3<Real>& normal, Real distance,
                             std::size_t collider) {
    if (distance < 0)
      add_inside(state, i, normal, distance, collider);
    else
      add(i, normal, distance, collider);
  };
  for (BadStart<Real>& exit : exits_) exit.particles = 0;
  cursor_.assign(meshes_.size(), 0);
  inside_.assign(state.x.size(), 0);
  for (const Index i : active_particles_) {
    const Vec3<Real>& p = state.x[static_cast<std::size_t>(i)];
    for (const Plane& plane : planes_)
      add(i, plane.normal, plane.normal.dot(p) - plane.offset, plane.collider);
    for (const Ball& ball : balls_) {
      const auto s = separate<Real>(p, ball.centre, Vec3<Real>::UnitY());
      add_round(i, s.normal, s.distance - ball.radius, ball.collider);
    }
    for (const Rod& rod : rods_) {
      const Vec3<Real> q = rod.a + (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b);
      const auto s = separate<Real>(p, q, Vec3<Real>::UnitY());
      add_round(i, s.normal, s.distance - rod.radius, rod.collider);
    }
    tests += planes_.size() + balls_.size() + rods_.size();
    for (std::size_t m = 0; m < meshes_.size(); ++m) tests += add_mesh_rows(state, m, i);
  }
  profile[Stage::narrow_phase].work += tests;
}

template <class Real>
void Contact<Real>::add_edge_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto reach_of = [&](const Edge& e) {
    return thickness_ + std::max(row_reach_[static_cast<std::size_t>(e[0])],
                                 row_reach_[static_cast<std::size_t>(e[1])]);
  };
  const auto x = [&](Index i) -> const Vec3<Real>& { return state.x[static_cast<std::size_t>(i)]; };
  const auto from_axis = [](const Vec3<Real>& p, const Rod& rod) {
    return (p - rod.a - (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b)).norm();
  };
  const auto between_ends = [](Real s) { return s > Real(kEdgeEnd) && s < Real(1 - kEdgeEnd); };
  const auto add = [&](const Edge& e, Real s, const Separation<Real>& d, Real radius,
                       std::size_t collider, bool responds) {
    if (d.distance - radius > reach_of(e)) return;
    add_row(state, {e[0], e[1]}, {Real(1) - s, s, 0}, d.normal, d.distance - radius, collider,
            responds);
  };
  const auto is_inside = [&](Index i) { return inside_[static_cast<std::size_t>(i)] != 0; };
  // An edge that cuts a corner of what its cloth is just leaving goes on outward.
  const auto still_leaves = [&](Index i, std::size_t m) {
    for (BadStart<Real>& exit : exits_) {
      if (exit.collider != mesh_collider_[m] || exit.cloth != cloth_of(i)) continue;
      ++exit.particles;
      return true;
    }
    return false;
  };
  for (const Index k : near_edges_) {
    const Edge& e = patches_.edges[static_cast<std::size_t>(k)];
    if (is_inside(e[0]) || is_inside(e[1])) continue;
    const Corners ends = corners_of(state, e.data(), 2), now = as_now(ends, kEdgeSpan);
    for (const Ball& ball : balls_) {
      const Real core = std::sqrt(
          std::min((x(e[0]) - ball.centre).squaredNorm(), (x(e[1]) - ball.centre).squaredNorm()));
      if (ends.clear(core, ball.radius)) continue;
      const Real s = closest_on_segment(ball.centre, x(e[0]), x(e[1]));
      const Vec3<Real> p = x(e[0]) + (x(e[1]) - x(e[0])) * s;
      add(e, s, separate<Real>(p, ball.centre, Vec3<Real>::UnitY()), ball.radius, ball.collider,
          between_ends(s) && !now.clear(core, ball.radius));
    }
    for (const Rod& rod : rods_) {
      const Real core = std::min(from_axis(x(e[0]), rod), from_axis(x(e[1]), rod));
      if (ends.clear(core, rod.radius)) continue;
      const auto c = closest_of_segments<Real>(x(e[0]), x(e[1]), rod.a, rod.b);
      add(e, c.s, separate<Real>(c.p, c.q, Vec3<Real>::UnitY()), rod.radius, rod.collider,
          between_ends(c.s) && !now.clear(core, rod.radius));
    }
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const ColliderFrame<Real>& frame = frames_[mesh_collider_[m]];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    for (const ContactCandidate<Real>& pair : edge_pairs_[m]) {
      const Edge& e = patches_.edges[static_cast<std::size_t>(pair.cloth)];
      if (is_inside(e[0]) || is_inside(e[1])) continue;
      const Real moved =
          std::max(moved_[static_cast<std::size_t>(e[0])], moved_[static_cast<std::size_t>(e[1])]);
      if (pair.distance - moved - frame.way_collected > reach_of(e)) continue;
      const Corners ends = corners_of(state, e.data(), 2);
      const Rise<Real>& rise = mesh.edge_rises[static_cast<std::size_t>(pair.feature)];
      if (ends.clear(rise)) continue;
      const MeshEdge& other = mesh.edges[static_cast<std::size_t>(pair.feature)];
      const auto c = closest_of_segments<Real>(own[static_cast<std::size_t>(e[0])],
                                               own[static_cast<std::size_t>(e[1])],
                                               mesh.positions[static_cast<std::size_t>(other.a)],
                                               mesh.positions[static_cast<std::size_t>(other.b)]);
      ++tests;
      const Vec3<Real>& outward = mesh.edge_normals[static_cast<std::size_t>(pair.feature)];
      Separation<Real> d = separate<Real>(c.p, c.q, outward);
      const bool between = between_ends(c.s) && between_ends(c.t);
      if (mesh.closed && between && d.normal.dot(outward) < 0 && still_leaves(e[0], m))
        d = {-d.normal, -d.distance};
      d.normal = frame.world_direction(d.normal);
      add(e, c.s, d, Real(0), mesh_collider_[m], between && !as_now(ends, kEdgeSpan).clear(rise));
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

template <class Real>
void Contact<Real>::add_triangle_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto x = [&](Index i) -> const Vec3<Real>& { return state.x[static_cast<std::size_t>(i)]; };
  const auto from_axis = [](const Vec3<Real>& p, const Rod& rod) {
    return (p - rod.a - (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b)).norm();
  };
  const auto is_inside = [&](Index i) { return inside_[static_cast<std::size_t>(i)] != 0; };
  const auto over = [&](const Triangle& t, const std::vector<Real>& values) {
    return std::max({values[static_cast<std::size_t>(t[0])], values[static_cast<std::size_t>(t[1])],
                     values[static_cast<std::size_t>(t[2])]});
  };
  /// A point of the object with a radius against the inside of a cloth triangle.
  const auto add = [&](const Triangle& t, const Vec3<Real>& q, Real radius,
                       const Vec3<Real>& outward, std::size_t collider, bool responds) {
    const TrianglePoint<Real> c = closest_on_triangle<Real>(q, x(t[0]), x(t[1]), x(t[2]));
    ++tests;
    const Separation<Real> d = separate<Real>(c.point, q, outward);
    if (d.distance - radius > thickness_ + over(t, row_reach_)) return;
    add_row(state, {t[0], t[1], t[2]}, c.barycentric, d.normal, d.distance - radius, collider,
            responds && c.feature == 0);
  };
  for (const Index k : near_triangles_) {
    const Triangle& t = patches_.triangles[static_cast<std::size_t>(k)];
    if (std::any_of(t.begin(), t.end(), is_inside)) continue;
    const Corners corners = corners_of(state, t.data(), 3), now = as_now(corners, kTriangleSpan);
    for (const Ball& ball : balls_) {
      const Real core = std::sqrt(
          std::min({(x(t[0]) - ball.centre).squaredNorm(), (x(t[1]) - ball.centre).squaredNorm(),
                    (x(t[2]) - ball.centre).squaredNorm()}));
      if (!corners.clear(core, ball.radius))
        add(t, ball.centre, ball.radius, Vec3<Real>::UnitY(), ball.collider,
            !now.clear(core, ball.radius));
    }
    for (const Rod& rod : rods_) {
      const Real core =
          std::min({from_axis(x(t[0]), rod), from_axis(x(t[1]), rod), from_axis(x(t[2]), rod)});
      if (corners.clear(core, rod.radius)) continue;
      const bool responds = !now.clear(core, rod.radius);
      add(t, rod.a, rod.radius, Vec3<Real>::UnitY(), rod.collider, responds);
      add(t, rod.b, rod.radius, Vec3<Real>::UnitY(), rod.collider, responds);
    }
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const ColliderFrame<Real>& frame = frames_[mesh_collider_[m]];
    for (const ContactCandidate<Real>& pair : triangle_pairs_[m]) {
      const Triangle& t = patches_.triangles[static_cast<std::size_t>(pair.cloth)];
      if (std::any_of(t.begin(), t.end(), is_inside)) continue;
      const Real moved = over(t, moved_) + frame.way_collected;
      if (pair.distance - moved > thickness_ + over(t, row_reach_)) continue;
      const auto v = static_cast<std::size_t>(pair.feature);
      const Corners corners = corners_of(state, t.data(), 3);
      if (corners.clear(mesh.vertex_rises[v])) continue;
      add(t, frame.world(mesh.positions[v]), Real(0), frame.world_direction(mesh.vertex_normals[v]),
          mesh_collider_[m], !as_now(corners, kTriangleSpan).clear(mesh.vertex_rises[v]));
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template bool Contact<Real>::rows_hold(const ClothState<Real>&, Real);                      \
  template void Contact<Real>::rebuild_rows(const ClothState<Real>&, Real, Profile&);         \
  template void Contact<Real>::add_particle_rows(const ClothState<Real>&, Profile&);          \
  template void Contact<Real>::add_edge_rows(const ClothState<Real>&, Profile&);              \
  template void Contact<Real>::add_triangle_rows(const ClothState<Real>&, Profile&);          \
  template void Contact<Real>::add_row(const ClothState<Real>&, std::initializer_list<Index>, \
                                       const std::array<Real, 3>&, const Vec3<Real>&, Real,   \
                                       std::size_t, bool);                                    \
  template std::uint64_t Contact<Real>::add_mesh_rows(const ClothState<Real>&, std::size_t, Index);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
