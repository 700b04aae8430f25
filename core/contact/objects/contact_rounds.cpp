// The narrow phase of Contact: edges and triangles of the cloth against balls and rods. On most of
// a smooth object particles alone keep the cloth off, and a bound that is quickly told says so.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/constants.h"
#include "core/contact/feature_pair.h"
#include "core/contact/objects/apart.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/corners.h"

namespace weft {
namespace {

/// What a bound is widened by for rounding.
constexpr double kSurely = 1.001;

/// Times the rounding of a radius that distances from the core may be off.
constexpr double kCoreRoundings = 16;

/// Part of its thickness that a cloth keeps of a round object even if it is pressed on it.
constexpr double kKeptPart = 0.25;

bool between_ends(double s) {
  return s > kEdgeEnd && s < 1 - kEdgeEnd;
}

/// The smallest of the corners' numbers.
template <class Real, class Feature>
Real nearest(const std::vector<Real>& numbers, const Feature& corners) {
  Real least = numbers[static_cast<std::size_t>(corners[0])];
  for (const Index i : corners) least = std::min(least, numbers[static_cast<std::size_t>(i)]);
  return least;
}

}  // namespace

/// Told without a root: (a + b)^2 <= 2 a^2 + 2 b^2.
template <class Real>
CornerBound<Real> Contact<Real>::bound_of(const ClothState<Real>& state, const Index* first,
                                          int count) const {
  const Real part = static_cast<Real>(count == 2 ? kEdgeSpan : kTriangleSpan);
  CornerBound<Real> bound;
  Real longest2 = 0, reach = 0;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(first[k]),
               j = static_cast<std::size_t>(first[(k + 1) % count]);
    longest2 = std::max(longest2, (state.x[i] - state.x[j]).squaredNorm());
    reach = std::max(reach, row_reach_[i]);
  }
  reach += thickness_ * Real(kRoomForPush);
  const Real both2 = longest2 + 4 * reach * reach;
  bound.span2 = part * part * 2 * both2 * static_cast<Real>(kSurely);
  return bound;
}

/// Height over the plane between it and a round object that a particle keeps while the rows hold,
/// so that edges and triangles are proved off by their corners. Where objects move none is kept.
/// @param distance  when the rows are built [m]
template <class Real>
Real Contact<Real>::kept_height(Index particle, Real distance) const {
  if (any_tracked_) return 0;
  return std::min(thickness_of(particle) * Real(kKeptPart), distance / 2);
}

/// Distance of each active particle from the core of a round object, now and while the rows hold: a
/// particle within reach of the object is kept over a plane.
template <class Real>
void Contact<Real>::measure_cores(const ClothState<Real>& state, const Round& round) {
  core_.resize(state.x.size());
  least_core_.resize(state.x.size());
  const auto& [a, b, radius, collider] = round.rod;
  const Real rounding = radius * std::numeric_limits<Real>::epsilon() * Real(kCoreRoundings);
  for (const Index k : active_particles_) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3<Real> from = state.x[i] - a;
    core_[i] = round.is_ball ? from.norm()
                             : (from - (b - a) * closest_on_segment(state.x[i], a, b)).norm();
    least_core_[i] = core_[i] - row_reach_[i] - thickness_ * Real(kRoomForPush);
    if (state.inverse_mass[i] > 0 && core_[i] > radius)
      least_core_[i] =
          std::max(least_core_[i], radius + kept_height(k, core_[i] - radius) - smallest_gap_);
    least_core_[i] -= rounding;
  }
}

template <class Real>
void Contact<Real>::add_features_on_rounds(const ClothState<Real>& state, Profile& profile) {
  if (balls_.empty() && rods_.empty()) return;
  edge_bounds_.clear();
  triangle_bounds_.clear();
  for (const Index k : near_edges_)
    edge_bounds_.push_back(bound_of(state, patches_.edges[static_cast<std::size_t>(k)].data(), 2));
  for (const Index k : near_triangles_)
    triangle_bounds_.push_back(
        bound_of(state, patches_.triangles[static_cast<std::size_t>(k)].data(), 3));
  const auto add = [&](const Round& round) {
    measure_cores(state, round);
    add_edges_on(round, state);
    add_triangles_on(round, state, profile);
  };
  for (const Ball& ball : balls_)
    add({{ball.centre, ball.centre, ball.radius, ball.collider}, true});
  for (const Rod& rod : rods_) add({rod, false});
}

template <class Real>
void Contact<Real>::add_edges_on(const Round& round, const ClothState<Real>& state) {
  const Vec3d base = in_double(round.rod.a), tip = in_double(round.rod.b);
  const Real most = round.rod.radius + smallest_gap_, push = thickness_ * Real(kRoomForPush);
  for (std::size_t n = 0; n < near_edges_.size(); ++n) {
    const Edge& e = patches_.edges[static_cast<std::size_t>(near_edges_[n])];
    const Real least = nearest(least_core_, e);
    if (edge_bounds_[n].clear(least, most)) continue;
    const Corners<Real> ends = corners_of(state, e.data(), 2);
    if (ends.pushed(kEdgeSpan, push).clear(least, round.rod.radius)) continue;
    if (is_inside(e[0], round.rod.collider) || is_inside(e[1], round.rod.collider)) continue;
    const Vec3d from = in_double(state.x[static_cast<std::size_t>(e[0])]),
                to = in_double(state.x[static_cast<std::size_t>(e[1])]);
    const SegmentPoints<double> c = closest_of_segments<double>(from, to, base, tip);
    const Apart side = apart(c.p, c.q);
    const Real distance = static_cast<Real>(side.distance) - round.rod.radius;
    if (distance > thickness_ + ends.reach) continue;
    Barrier barrier{side.normal.cast<Real>(), 0, distance};
    const Vec3d normal = in_double(barrier.normal);
    barrier.top =
        std::max(normal.dot(base), normal.dot(tip)) + static_cast<double>(round.rod.radius);
    const bool carried =
        ends.as_lying(kEdgeSpan, Real(0)).clear(nearest(core_, e), round.rod.radius);
    const Real s = static_cast<Real>(c.s);
    add_row(state, {e[0], e[1]}, {Real(1) - s, s, 0}, barrier, round.rod.collider,
            !carried && between_ends(c.s));
  }
}

/// The centre of a ball, and both ends of a rod, against the inside of triangles.
template <class Real>
void Contact<Real>::add_triangles_on(const Round& round, const ClothState<Real>& state,
                                     Profile& profile) {
  const Real most = round.rod.radius + smallest_gap_, push = thickness_ * Real(kRoomForPush);
  const auto add = [&](const Triangle& t, const Corners<Real>& corners, const Vec3<Real>& centre,
                       bool responds) {
    const auto at = [&](std::size_t n) {
      return in_double(state.x[static_cast<std::size_t>(t[n])]);
    };
    const Vec3d q = in_double(centre);
    const TrianglePoint<double> c = closest_on_triangle<double>(q, at(0), at(1), at(2));
    ++profile[Stage::narrow_phase].work;
    const Apart side = apart(c.point, q);
    const Real distance = static_cast<Real>(side.distance) - round.rod.radius;
    if (distance > thickness_ + corners.reach) return;
    Barrier barrier{side.normal.cast<Real>(), 0, distance};
    barrier.top = in_double(barrier.normal).dot(q) + static_cast<double>(round.rod.radius);
    std::array<Real, 3> weights;
    for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(c.barycentric[n]);
    add_row(state, {t[0], t[1], t[2]}, weights, barrier, round.rod.collider,
            responds && c.feature == 0);
  };
  for (std::size_t n = 0; n < near_triangles_.size(); ++n) {
    const Triangle& t = patches_.triangles[static_cast<std::size_t>(near_triangles_[n])];
    const Real least = nearest(least_core_, t);
    if (triangle_bounds_[n].clear(least, most)) continue;
    const Corners<Real> corners = corners_of(state, t.data(), 3);
    if (corners.pushed(kTriangleSpan, push).clear(least, round.rod.radius)) continue;
    const auto is_barred = [&](Index i) { return is_inside(i, round.rod.collider); };
    if (std::any_of(t.begin(), t.end(), is_barred)) continue;
    const bool responds =
        !corners.as_lying(kTriangleSpan, Real(0)).clear(nearest(core_, t), round.rod.radius);
    add(t, corners, round.rod.a, responds);
    if (!round.is_ball) add(t, corners, round.rod.b, responds);
  }
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template CornerBound<Real> Contact<Real>::bound_of(const ClothState<Real>&, const Index*, int) \
      const;                                                                                     \
  template Real Contact<Real>::kept_height(Index, Real) const;                                   \
  template void Contact<Real>::measure_cores(const ClothState<Real>&, const Round&);             \
  template void Contact<Real>::add_features_on_rounds(const ClothState<Real>&, Profile&);        \
  template void Contact<Real>::add_edges_on(const Round&, const ClothState<Real>&);              \
  template void Contact<Real>::add_triangles_on(const Round&, const ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
