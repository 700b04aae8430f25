// The narrow phase of Contact: planes between the cloth's features and the objects', frozen for a few
// substeps.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/contact.h"

namespace weft {
namespace {

/// Substeps of a particle's present motion for which rows shall hold.
constexpr double kRowSubsteps = 4;

/// A pair of edges closest at an end belongs to a particle or a vertex instead.
constexpr double kEdgeEnd = 0.01;

/// Direction from q to p, and their distance, negative if p lies behind a solid's feature.
template <class Real>
struct Separation {
  Vec3<Real> normal;
  Real distance;
};

/// @param outward  normal of the object's feature, for points on it and for the side of a solid
template <class Real>
Separation<Real> separate(const Vec3<Real>& p, const Vec3<Real>& q, const Vec3<Real>& outward,
                          bool solid) {
  const Vec3<Real> away = p - q;
  const Real distance = away.norm();
  if (!(distance > Real(1e-6))) return {outward, Real(0)};
  const Vec3<Real> normal = away / distance;
  if (solid && normal.dot(outward) < 0) return {-normal, -distance};
  return {normal, distance};
}

}  // namespace

/// Whether all lists stay valid through the coming drift.
template <class Real>
bool Contact<Real>::rows_hold(const ClothState<Real>& state, Real dt) const {
  if (!collected_ || !rows_built_) return false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3<Real> next = state.x[i] + state.v[i] * dt;
    if (!((next - x_rows_[i]).squaredNorm() <= row_reach_[i] * row_reach_[i])) return false;
  }
  return true;
}

/// Builds the rows anew from the candidates, which are collected again first if they do not hold.
template <class Real>
void Contact<Real>::rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  const std::size_t n = state.x.size();
  row_reach_.resize(n);
  const auto allow = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      const Real moved = (state.x[i] - x_collected_[i]).norm();
      const Real left = skin_[i] - moved;
      const Real step = state.v[i].norm() * dt;
      if (!(left >= step * Real(1.5))) return false;
      const Real wanted = std::max(thickness_ / 2, step * Real(kRowSubsteps));
      row_reach_[i] = active_[i] ? std::min(left, wanted) : left;
    }
    return true;
  };
  if (!collected_ || !allow()) {
    collect(state, profile);
    allow();
  }
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  x_rows_ = state.x;
  rows_.clear();
  add_particle_rows(state, profile);
  particle_rows_ = rows_.size();
  add_edge_rows(state, profile);
  add_triangle_rows(state, profile);
  rows_built_ = true;
}

template <class Real>
void Contact<Real>::add_row(const ClothState<Real>& state, std::initializer_list<Index> particles,
                            const std::array<Real, 3>& weights, const Vec3<Real>& normal,
                            Real distance) {
  ContactRow<Real> row;
  Real mobility = 0, height = 0;
  for (const Index i : particles) {
    const auto k = static_cast<std::size_t>(row.count++);
    row.particle[k] = i;
    row.weight[k] = weights[k];
    mobility += weights[k] * weights[k] * state.inverse_mass[static_cast<std::size_t>(i)];
    height += weights[k] * normal.dot(state.x[static_cast<std::size_t>(i)]);
  }
  if (!(mobility > 0)) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
    row.share[k] =
        row.weight[k] * state.inverse_mass[static_cast<std::size_t>(row.particle[k])] / mobility;
  row.normal = normal;
  row.offset = height - distance;
  rows_.push_back(row);
}

/// Of the rows of one particle from `first` on: if it is inside a solid, only the nearest way out.
template <class Real>
void Contact<Real>::drop_deeper_rows(std::size_t first, const ClothState<Real>& state) {
  std::size_t best = rows_.size();
  Real nearest = -std::numeric_limits<Real>::infinity();
  bool inside = false;
  for (std::size_t k = first; k < rows_.size(); ++k) {
    const Vec3<Real>& x = state.x[static_cast<std::size_t>(rows_[k].particle[0])];
    const Real gap = rows_[k].normal.dot(x) - rows_[k].offset;
    if (gap >= 0) continue;
    inside = true;
    if (gap > nearest) {
      nearest = gap;
      best = k;
    }
  }
  if (!inside) return;
  rows_[first] = rows_[best];
  rows_.resize(first + 1);
}

template <class Real>
void Contact<Real>::add_particle_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto reach_of = [&](Index i) { return thickness_ + row_reach_[static_cast<std::size_t>(i)]; };
  const auto add = [&](Index i, const Vec3<Real>& normal, Real distance) {
    if (distance <= reach_of(i)) add_row(state, {i}, {Real(1), 0, 0}, normal, distance);
  };
  cursor_.assign(meshes_.size(), 0);
  for (const Index i : active_particles_) {
    const Vec3<Real>& p = state.x[static_cast<std::size_t>(i)];
    for (const Plane& plane : planes_) add(i, plane.normal, plane.normal.dot(p) - plane.offset);
    for (const Ball& ball : balls_) {
      const auto s = separate<Real>(p, ball.centre, Vec3<Real>::UnitY(), false);
      add(i, s.normal, s.distance - ball.radius);
    }
    for (const Rod& rod : rods_) {
      const Vec3<Real> q = rod.a + (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b);
      const auto s = separate<Real>(p, q, Vec3<Real>::UnitY(), false);
      add(i, s.normal, s.distance - rod.radius);
    }
    tests += planes_.size() + balls_.size() + rods_.size();
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      // The pairs stand in the order of the active particles.
      const auto& pairs = particle_pairs_[m];
      const std::size_t first = rows_.size();
      const auto k = static_cast<std::size_t>(i);
      const Real moved = (p - x_collected_[k]).norm();
      for (; cursor_[m] < pairs.size() && pairs[cursor_[m]].cloth == i; ++cursor_[m]) {
        if (pairs[cursor_[m]].distance - moved > reach_of(i)) continue;
        const MeshDistance<Real> d = distance_to_triangle(meshes_[m], pairs[cursor_[m]].feature, p);
        ++tests;
        add(i, d.normal, d.distance);
      }
      if (meshes_[m].closed) drop_deeper_rows(first, state);
    }
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
  const auto add = [&](const Edge& e, Real s, const Separation<Real>& d, Real radius) {
    if (s <= Real(kEdgeEnd) || s >= Real(1 - kEdgeEnd) || d.distance - radius > reach_of(e)) return;
    add_row(state, {e[0], e[1]}, {Real(1) - s, s, 0}, d.normal, d.distance - radius);
  };
  for (const Index k : near_edges_) {
    const Edge& e = edges_[static_cast<std::size_t>(k)];
    for (const Ball& ball : balls_) {
      const Real s = closest_on_segment(ball.centre, x(e[0]), x(e[1]));
      const Vec3<Real> p = x(e[0]) + (x(e[1]) - x(e[0])) * s;
      add(e, s, separate<Real>(p, ball.centre, Vec3<Real>::UnitY(), false), ball.radius);
    }
    for (const Rod& rod : rods_) {
      const auto c = closest_of_segments<Real>(x(e[0]), x(e[1]), rod.a, rod.b);
      add(e, c.s, separate<Real>(c.p, c.q, Vec3<Real>::UnitY(), false), rod.radius);
    }
    tests += balls_.size() + rods_.size();
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    for (const ContactCandidate<Real>& pair : edge_pairs_[m]) {
      const Edge& e = edges_[static_cast<std::size_t>(pair.cloth)];
      const Real moved = std::max((x(e[0]) - x_collected_[static_cast<std::size_t>(e[0])]).norm(),
                                  (x(e[1]) - x_collected_[static_cast<std::size_t>(e[1])]).norm());
      if (pair.distance - moved > reach_of(e)) continue;
      const MeshEdge& other = mesh.edges[static_cast<std::size_t>(pair.feature)];
      const auto c = closest_of_segments<Real>(x(e[0]), x(e[1]),
                                               mesh.positions[static_cast<std::size_t>(other.a)],
                                               mesh.positions[static_cast<std::size_t>(other.b)]);
      ++tests;
      if (c.t <= Real(kEdgeEnd) || c.t >= Real(1 - kEdgeEnd)) continue;
      const Vec3<Real>& outward = mesh.edge_normals[static_cast<std::size_t>(pair.feature)];
      add(e, c.s, separate<Real>(c.p, c.q, outward, mesh.closed), Real(0));
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

template <class Real>
void Contact<Real>::add_triangle_rows(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  const auto x = [&](Index i) -> const Vec3<Real>& { return state.x[static_cast<std::size_t>(i)]; };
  const auto over = [&](const Triangle& t, const std::vector<Real>& values) {
    return std::max({values[static_cast<std::size_t>(t[0])], values[static_cast<std::size_t>(t[1])],
                     values[static_cast<std::size_t>(t[2])]});
  };
  /// A point of the object with a radius against the inside of a cloth triangle.
  const auto add = [&](const Triangle& t, const Vec3<Real>& q, Real radius,
                       const Vec3<Real>& outward, bool solid) {
    const TrianglePoint<Real> c = closest_on_triangle<Real>(q, x(t[0]), x(t[1]), x(t[2]));
    ++tests;
    if (c.feature != 0) return;
    const Separation<Real> d = separate<Real>(c.point, q, outward, solid);
    if (d.distance - radius > thickness_ + over(t, row_reach_)) return;
    add_row(state, {t[0], t[1], t[2]}, c.barycentric, d.normal, d.distance - radius);
  };
  for (const Index k : near_triangles_) {
    const Triangle& t = triangles_[static_cast<std::size_t>(k)];
    for (const Ball& ball : balls_) add(t, ball.centre, ball.radius, Vec3<Real>::UnitY(), false);
    for (const Rod& rod : rods_) {
      add(t, rod.a, rod.radius, Vec3<Real>::UnitY(), false);
      add(t, rod.b, rod.radius, Vec3<Real>::UnitY(), false);
    }
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    for (const ContactCandidate<Real>& pair : triangle_pairs_[m]) {
      const Triangle& t = triangles_[static_cast<std::size_t>(pair.cloth)];
      Real moved = 0;
      for (const Index i : t)
        moved = std::max(moved, (x(i) - x_collected_[static_cast<std::size_t>(i)]).norm());
      if (pair.distance - moved > thickness_ + over(t, row_reach_)) continue;
      add(t, mesh.positions[static_cast<std::size_t>(pair.feature)], Real(0),
          mesh.vertex_normals[static_cast<std::size_t>(pair.feature)], mesh.closed);
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

#define WEFT_INSTANTIATE(Real)                                                                      \
  template bool Contact<Real>::rows_hold(const ClothState<Real>&, Real) const;                      \
  template void Contact<Real>::rebuild_rows(const ClothState<Real>&, Real, Profile&);               \
  template void Contact<Real>::add_particle_rows(const ClothState<Real>&, Profile&);                \
  template void Contact<Real>::add_edge_rows(const ClothState<Real>&, Profile&);                    \
  template void Contact<Real>::add_triangle_rows(const ClothState<Real>&, Profile&);                \
  template void Contact<Real>::add_row(const ClothState<Real>&, std::initializer_list<Index>,       \
                                       const std::array<Real, 3>&, const Vec3<Real>&, Real);        \
  template void Contact<Real>::drop_deeper_rows(std::size_t, const ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
