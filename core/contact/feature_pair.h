#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/contact/constants.h"
#include "core/geometry/distance.h"
#include "core/types.h"

// Pairs of features of cloths, and planes that separate them.

namespace weft {

/// A particle and a triangle, or two edges.
enum class PairKind : std::uint8_t { vertex_triangle, edge_edge };

/// Number of a pair's particles on its first side; the rest of the four are on the second.
inline constexpr std::size_t first_side(PairKind kind) {
  return kind == PairKind::vertex_triangle ? 1 : 2;
}

/// Positions of a pair's particles: particle and corners of the triangle, or the ends of both edges
/// [m].
template <class Real>
using PairPoints = std::array<Vec3<Real>, 4>;

/// Separation of the two sides of a pair.
template <class Real>
struct PairSeparation {
  Vec3<Real> normal = Vec3<Real>::Zero();  ///< unit, from the second side to the first
  Real gap = 0;  ///< certified: min over the first side minus max over the second of n.x [m]
  /// Of the closest points: sum w x leads from the second side to the first.
  std::array<Real, 4> weight = {0, 0, 0, 0};
  bool inside = true;  ///< both closest points lie inside their triangle or between the edge's ends
};

/// min over the first side minus max over the second of n.x [m]. Both sides are convex, so a
/// positive value proves a distance of at least that, for any n.
/// @param n  unit
template <class Real>
Real gap_along(PairKind kind, const PairPoints<Real>& x, const Vec3<Real>& n) {
  // Relative to one of the points, so that distance from the origin costs no precision.
  const Real b = n.dot(x[1] - x[0]), c = n.dot(x[2] - x[0]), d = n.dot(x[3] - x[0]);
  if (kind == PairKind::vertex_triangle) return -std::max(b, std::max(c, d));
  return std::min(Real(0), b) - std::max(c, d);
}

/// The largest gap along candidate axes for a pair whose closest points are lost in rounding: the
/// cross product of the edges or of the triangle, and vectors between the features.
template <class Real>
void improve_separation(PairKind kind, const PairPoints<Real>& x, PairSeparation<Real>& best) {
  PairPoints<double> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = (x[k] - x[0]).template cast<double>();
  const bool point = kind == PairKind::vertex_triangle;
  const auto from_line = [](const Vec3d& q, const Vec3d& a, const Vec3d& b) -> Vec3d {
    return q - (a + (b - a) * closest_on_segment<double>(q, a, b));
  };
  std::array<Vec3d, 5> axes;
  if (point) {
    const TrianglePoint<double> c = closest_on_thin_triangle<double>(p[0], p[1], p[2], p[3]);
    axes = {(p[2] - p[1]).cross(p[3] - p[1]), p[0] - c.point, from_line(p[0], p[1], p[2]),
            from_line(p[0], p[2], p[3]), from_line(p[0], p[3], p[1])};
  } else {
    const SegmentPoints<double> c = closest_of_segments<double>(p[0], p[1], p[2], p[3]);
    axes = {(p[1] - p[0]).cross(p[3] - p[2]), c.p - c.q, from_line(p[0], p[2], p[3]),
            from_line(p[1], p[2], p[3]), -from_line(p[2], p[0], p[1])};
  }
  for (const Vec3d& axis : axes) {
    const double length = axis.norm();
    if (!(length > 1e-30)) continue;
    for (const double sign : {1.0, -1.0}) {
      const Vec3d n = axis * (sign / length);
      const auto gap = static_cast<Real>(gap_along<double>(kind, p, n));
      if (!(gap > best.gap)) continue;
      best.gap = gap;
      best.normal = n.cast<Real>();
    }
  }
}

/// Separates a pair along the line of its closest points, or along a better axis if these nearly
/// coincide. A gap that is not positive means that no axis was found: the pair intersects, or
/// nearly touches.
template <class Real>
PairSeparation<Real> separate_pair(PairKind kind, const PairPoints<Real>& x) {
  PairSeparation<Real> s;
  const Vec3<Real> zero = Vec3<Real>::Zero();
  const Vec3<Real> b = x[1] - x[0], c = x[2] - x[0], d = x[3] - x[0];
  Vec3<Real> away;
  if (kind == PairKind::vertex_triangle) {
    const TrianglePoint<Real> t = closest_on_triangle<Real>(zero, b, c, d);
    s.weight = {Real(1), -t.barycentric[0], -t.barycentric[1], -t.barycentric[2]};
    s.inside = t.feature == 0;
    away = -t.point;
  } else {
    constexpr Real kEnd = static_cast<Real>(kEdgeEnd);
    const SegmentPoints<Real> e = closest_of_segments<Real>(zero, b, c, d);
    s.weight = {Real(1) - e.s, e.s, e.t - Real(1), -e.t};
    s.inside = e.s > kEnd && e.s < 1 - kEnd && e.t > kEnd && e.t < 1 - kEnd;
    away = e.p - e.q;
  }
  const Real distance = away.norm();
  s.gap = -std::numeric_limits<Real>::infinity();
  if (distance > Real(1e-12)) {
    s.normal = away / distance;
    s.gap = gap_along(kind, x, s.normal);
  }
  if (!(s.gap > Real(kCloseGap))) improve_separation(kind, x, s);
  return s;
}

}  // namespace weft
