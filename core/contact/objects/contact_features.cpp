// The narrow phase of Contact, second half: edges and triangles of the cloth against ridges and
// corners of the objects. Each pair that could meet while the rows hold gets a plane that proves it
// apart; whether it responds besides is a matter of where particles alone do not carry the cloth.

#include <algorithm>
#include <cmath>

#include "core/contact/feature_pair.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/corner_span.h"

namespace weft {
namespace {

/// A pair of edges closest at an end belongs to a particle or a vertex instead.
constexpr double kEdgeEnd = 0.01;

/// So near, the direction between two points is rounding [m].
constexpr double kTouching = 1e-6;

bool between_ends(double s) {
  return s > kEdgeEnd && s < 1 - kEdgeEnd;
}

/// What keeps corners off where they lie, while what they may come to is only certified: at rest
/// particles alone carry the cloth on a smooth object. From a mesh they lie off by the thickness,
/// whatever their gap is now: what carries in one step and not in the next never rests.
template <class Corners, class Real>
Corners as_lying(Corners corners, double part, Real thickness) {
  corners.span -= 2 * corners.reach * static_cast<Real>(part);
  corners.gap = thickness;
  corners.reach = 0;
  return corners;
}

template <class Real>
Vec3d in_double(const Vec3<Real>& v) {
  return v.template cast<double>();
}

/// Distance of a point from a rod's axis [m]. Most of the time of a bed of needles goes here and
/// into Corners::clear, so that both are part of the loops over all rods.
template <class Rod, class Real>
[[gnu::always_inline]] inline Real from_axis(const Vec3<Real>& p, const Rod& rod) {
  return (p - rod.a - (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b)).norm();
}

/// Direction in which p is from q, and how far.
struct Apart {
  Vec3d normal;
  double distance;  ///< [m]
};

Apart apart(const Vec3d& p, const Vec3d& q) {
  const Vec3d away = p - q;
  const double distance = away.norm();
  if (!(distance > kTouching)) return {Vec3d::UnitY(), 0};
  return {away / distance, distance};
}

}  // namespace

/// What the corners of an edge or a triangle keep to while the rows hold.
template <class Real>
typename Contact<Real>::Corners Contact<Real>::corners_of(const ClothState<Real>& state,
                                                          const Index* first, int count) const {
  Corners corners;
  corners.unseen = smallest_gap_;
  Real longest = 0, reach = 0;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(first[k]),
               j = static_cast<std::size_t>(first[(k + 1) % count]);
    longest = std::max(longest, (state.x[i] - state.x[j]).squaredNorm());
    reach = std::max(reach, row_reach_[i]);
    corners.gap = std::min(corners.gap, gap_[i] - row_reach_[i]);
  }
  corners.reach = reach;
  corners.span = (std::sqrt(longest) + 2 * reach) * Real(count == 2 ? kEdgeSpan : kTriangleSpan);
  return corners;
}

/// Whether corners alone keep off a round object, as they are so far from its core: of points at
/// x_i with weights w_i the middle is off any point q by less than the corners are, in squares, by
/// sum w_i w_j |x_i - x_j|^2 over pairs.
/// @param core  of the nearest corner, when the rows are built [m]
template <class Real>
bool Contact<Real>::Corners::clear(Real core, Real radius) const {
  const Real least = core - reach, most = radius + unseen;
  return least > 0 && least * least - span * span > most * most;
}

/// Whether corners alone keep off a ridge or corner of a mesh, if it goes on as it is there: an
/// estimate, and nothing to rely on.
template <class Real>
bool Contact<Real>::Corners::clear(const Rise<Real>& rise) const {
  return gap > rise.over(span) + unseen;
}

template <class Real>
void Contact<Real>::add_edges_on_rounds(const ClothState<Real>& state, Profile&) {
  if (balls_.empty() && rods_.empty()) return;
  /// @param c  closest points of the edge and the axis from a to b
  const auto add = [&](const Edge& e, Real reach, const SegmentPoints<double>& c, const Vec3d& a,
                       const Vec3d& b, Real radius, std::size_t collider, bool responds) {
    const Apart side = apart(c.p, c.q);
    const Real distance = static_cast<Real>(side.distance) - radius, s = static_cast<Real>(c.s);
    if (distance > thickness_ + reach) return;
    Barrier barrier{side.normal.cast<Real>(), 0, distance};
    const Vec3d n = in_double(barrier.normal);
    barrier.top = std::max(n.dot(a), n.dot(b)) + static_cast<double>(radius);
    add_row(state, {e[0], e[1]}, {Real(1) - s, s, 0}, barrier, collider,
            responds && between_ends(c.s));
  };
  for (const Index k : near_edges_) {
    const Edge& e = patches_.edges[static_cast<std::size_t>(k)];
    const Corners ends = corners_of(state, e.data(), 2), now = as_lying(ends, kEdgeSpan, Real(0));
    const Vec3<Real>&a = state.x[static_cast<std::size_t>(e[0])],
          &b = state.x[static_cast<std::size_t>(e[1])];
    const Vec3d from = in_double(a), to = in_double(b);
    const auto barred = [&](std::size_t collider) {
      return is_inside(e[0], collider) || is_inside(e[1], collider);
    };
    for (const Ball& ball : balls_) {
      const Real core =
          std::sqrt(std::min((a - ball.centre).squaredNorm(), (b - ball.centre).squaredNorm()));
      if (ends.clear(core, ball.radius) || barred(ball.collider)) continue;
      const Vec3d centre = in_double(ball.centre);
      const auto c = closest_of_segments<double>(from, to, centre, centre);
      add(e, ends.reach, c, centre, centre, ball.radius, ball.collider,
          !now.clear(core, ball.radius));
    }
    for (const Rod& rod : rods_) {
      const Real core = std::min(from_axis(a, rod), from_axis(b, rod));
      if (ends.clear(core, rod.radius) || barred(rod.collider)) continue;
      const Vec3d base = in_double(rod.a), tip = in_double(rod.b);
      const auto c = closest_of_segments<double>(from, to, base, tip);
      add(e, ends.reach, c, base, tip, rod.radius, rod.collider, !now.clear(core, rod.radius));
    }
  }
}

template <class Real>
void Contact<Real>::add_triangles_on_rounds(const ClothState<Real>& state, Profile& profile) {
  if (balls_.empty() && rods_.empty()) return;
  /// A point of the object with a radius against the inside of a cloth triangle.
  const auto add = [&](const Triangle& t, const std::array<Vec3d, 3>& x, Real reach,
                       const Vec3<Real>& centre, Real radius, std::size_t collider, bool responds) {
    const Vec3d q = in_double(centre);
    const TrianglePoint<double> c = closest_on_triangle<double>(q, x[0], x[1], x[2]);
    ++profile[Stage::narrow_phase].work;
    const Apart side = apart(c.point, q);
    const Real distance = static_cast<Real>(side.distance) - radius;
    if (distance > thickness_ + reach) return;
    Barrier barrier{side.normal.cast<Real>(), 0, distance};
    barrier.top = in_double(barrier.normal).dot(q) + static_cast<double>(radius);
    std::array<Real, 3> weights;
    for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(c.barycentric[n]);
    add_row(state, {t[0], t[1], t[2]}, weights, barrier, collider, responds && c.feature == 0);
  };
  for (const Index k : near_triangles_) {
    const Triangle& t = patches_.triangles[static_cast<std::size_t>(k)];
    const auto x = [&](std::size_t n) -> const Vec3<Real>& {
      return state.x[static_cast<std::size_t>(t[n])];
    };
    const auto barred = [&](std::size_t collider) {
      return is_inside(t[0], collider) || is_inside(t[1], collider) || is_inside(t[2], collider);
    };
    const Corners corners = corners_of(state, t.data(), 3),
                  now = as_lying(corners, kTriangleSpan, Real(0));
    const std::array<Vec3d, 3> at = {in_double(x(0)), in_double(x(1)), in_double(x(2))};
    for (const Ball& ball : balls_) {
      const Real core = std::sqrt(
          std::min({(x(0) - ball.centre).squaredNorm(), (x(1) - ball.centre).squaredNorm(),
                    (x(2) - ball.centre).squaredNorm()}));
      if (corners.clear(core, ball.radius) || barred(ball.collider)) continue;
      add(t, at, corners.reach, ball.centre, ball.radius, ball.collider,
          !now.clear(core, ball.radius));
    }
    for (const Rod& rod : rods_) {
      const Real core =
          std::min({from_axis(x(0), rod), from_axis(x(1), rod), from_axis(x(2), rod)});
      if (corners.clear(core, rod.radius) || barred(rod.collider)) continue;
      const bool responds = !now.clear(core, rod.radius);
      add(t, at, corners.reach, rod.a, rod.radius, rod.collider, responds);
      add(t, at, corners.reach, rod.b, rod.radius, rod.collider, responds);
    }
  }
}

/// What a pair of features of the cloth and a mesh needs; nothing if they cannot meet while the
/// rows hold.
/// @param particles  of the cloth's feature
/// @param span       kEdgeSpan or kTriangleSpan
/// @param rise       of the mesh about its feature
template <class Real>
std::optional<typename Contact<Real>::Look> Contact<Real>::look_at(
    const ClothState<Real>& state, const ContactCandidate<Real>& pair,
    std::span<const Index> particles, double span, const Rise<Real>& rise,
    std::size_t collider) const {
  const auto most = [&](const std::vector<Real>& values) {
    Real largest = values[static_cast<std::size_t>(particles[0])];
    for (const Index i : particles)
      largest = std::max(largest, values[static_cast<std::size_t>(i)]);
    return largest;
  };
  const Real reach = most(row_reach_);
  const Real bound = pair.distance - most(moved_) - frames_[collider].way_collected;
  if (bound > thickness_ + reach) return {};
  if (std::any_of(particles.begin(), particles.end(),
                  [&](Index i) { return is_inside(i, collider); }))
    return {};
  const Corners corners = corners_of(state, particles.data(), static_cast<int>(particles.size()));
  const bool carried = as_lying(corners, span, thickness_of(particles[0])).clear(rise);
  if (carried && bound > beyond_reach(reach)) return {};
  return Look{reach, carried};
}

template <class Real>
void Contact<Real>::add_edges_on_meshes(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const std::size_t collider = mesh_collider_[m];
    const ColliderFrame<Real>& frame = frames_[collider];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
    const auto corner = [&](Index v) {
      return in_double(mesh.positions[static_cast<std::size_t>(v)]);
    };
    for (const ContactCandidate<Real>& pair : edge_pairs_[m]) {
      const Edge& e = patches_.edges[static_cast<std::size_t>(pair.cloth)];
      const auto ridge = static_cast<std::size_t>(pair.feature);
      const std::optional<Look> look =
          look_at(state, pair, e, kEdgeSpan, mesh.edge_rises[ridge], collider);
      if (!look) continue;
      const MeshEdge& other = mesh.edges[ridge];
      ++tests;
      const PairSeparation<double> s = separate_pair<double>(
          PairKind::edge_edge, {at(e[0]), at(e[1]), corner(other.a), corner(other.b)});
      const Real distance = static_cast<Real>(s.gap);
      const bool responds = !look->carried && s.inside;
      if (distance > (responds ? thickness_ + look->reach : beyond_reach(look->reach))) continue;
      const Vec3<Real>& outward = mesh.edge_normals[ridge];
      Vec3<Real> normal = s.normal.template cast<Real>();
      Barrier barrier;
      barrier.distance = std::max(distance, Real(0));
      if (!(s.gap > kTouching)) normal = outward;
      // An edge that cuts a ridge of what its cloth is just leaving goes on outward.
      if (mesh.closed && s.inside && normal.dot(outward) < 0 && still_leaves(e[0], collider)) {
        normal = -normal;
        barrier.distance = -barrier.distance;
      }
      barrier.normal = frame.world_direction(normal);
      barrier.top = top_of(m, barrier.normal, {other.a, other.b});
      add_row(state, {e[0], e[1]},
              {static_cast<Real>(s.weight[0]), static_cast<Real>(s.weight[1]), 0}, barrier,
              collider, responds);
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

template <class Real>
void Contact<Real>::add_triangles_on_meshes(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const std::size_t collider = mesh_collider_[m];
    const ColliderFrame<Real>& frame = frames_[collider];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
    for (const ContactCandidate<Real>& pair : triangle_pairs_[m]) {
      const Triangle& t = patches_.triangles[static_cast<std::size_t>(pair.cloth)];
      const auto v = static_cast<std::size_t>(pair.feature);
      const std::optional<Look> look =
          look_at(state, pair, t, kTriangleSpan, mesh.vertex_rises[v], collider);
      if (!look) continue;
      ++tests;
      const PairSeparation<double> s = separate_pair<double>(
          PairKind::vertex_triangle, {in_double(mesh.positions[v]), at(t[0]), at(t[1]), at(t[2])});
      const Real distance = static_cast<Real>(s.gap);
      const bool responds = !look->carried && s.inside;
      if (distance > (responds ? thickness_ + look->reach : beyond_reach(look->reach))) continue;
      Barrier barrier;
      barrier.distance = std::max(distance, Real(0));
      const Vec3<Real> normal =
          s.gap > kTouching ? (-s.normal).template cast<Real>().eval() : mesh.vertex_normals[v];
      barrier.normal = frame.world_direction(normal);
      barrier.top = top_of(m, barrier.normal, {pair.feature});
      std::array<Real, 3> weights;
      for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(-s.weight[n + 1]);
      add_row(state, {t[0], t[1], t[2]}, weights, barrier, collider, responds);
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

#define WEFT_INSTANTIATE(Real)                                                                 \
  template typename Contact<Real>::Corners Contact<Real>::corners_of(const ClothState<Real>&,  \
                                                                     const Index*, int) const; \
  template bool Contact<Real>::Corners::clear(Real, Real) const;                               \
  template bool Contact<Real>::Corners::clear(const Rise<Real>&) const;                        \
  template std::optional<typename Contact<Real>::Look> Contact<Real>::look_at(                 \
      const ClothState<Real>&, const ContactCandidate<Real>&, std::span<const Index>, double,  \
      const Rise<Real>&, std::size_t) const;                                                   \
  template void Contact<Real>::add_edges_on_rounds(const ClothState<Real>&, Profile&);         \
  template void Contact<Real>::add_edges_on_meshes(const ClothState<Real>&, Profile&);         \
  template void Contact<Real>::add_triangles_on_rounds(const ClothState<Real>&, Profile&);     \
  template void Contact<Real>::add_triangles_on_meshes(const ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
