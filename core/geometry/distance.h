#pragma once

#include <algorithm>
#include <array>

#include "core/types.h"

// Closest points of simple shapes: pure functions on fixed-size vectors, safe for degenerate input.

namespace weft {

/// Closest point of a triangle to a point.
template <class Real>
struct TrianglePoint {
  Vec3<Real> point;                  ///< on the triangle [m]
  std::array<Real, 3> barycentric;   ///< its weights: >= 0, sum 1
  int feature = 0;  ///< 0: inside; 1, 2, 3: corner a, b, c; 4, 5, 6: edge ab, bc, ca
};

/// Closest points of two segments.
template <class Real>
struct SegmentPoints {
  Real s = 0, t = 0;  ///< parameters on the first and the second segment, 0 to 1
  Vec3<Real> p, q;    ///< the points [m]
};

/// Closest parameter, 0 to 1, of segment a + t (b - a) to point p; 0 if the segment has no length.
template <class Real>
inline Real closest_on_segment(const Vec3<Real>& p, const Vec3<Real>& a, const Vec3<Real>& b) {
  const Vec3<Real> d = b - a;
  const Real length2 = d.squaredNorm();
  if (!(length2 > 0)) return 0;
  return std::clamp((p - a).dot(d) / length2, Real(0), Real(1));
}

/// Closest point of triangle abc to p, by the regions of the plane (Ericson 2005, section 5.1.5);
/// a triangle without area is treated as its edges.
template <class Real>
TrianglePoint<Real> closest_on_triangle(const Vec3<Real>& p, const Vec3<Real>& a,
                                        const Vec3<Real>& b, const Vec3<Real>& c) {
  const Vec3<Real> ab = b - a, ac = c - a, n = ab.cross(ac);
  const Real n2 = n.squaredNorm();
  const Real scale = ab.squaredNorm() * ac.squaredNorm();
  if (n2 > scale * Real(1e-12)) {
    // Barycentric weights of the projection; all positive means that it is inside.
    const Vec3<Real> ap = p - a;
    const Real wc = ab.cross(ap).dot(n) / n2, wb = ap.cross(ac).dot(n) / n2, wa = Real(1) - wb - wc;
    if (wa > 0 && wb > 0 && wc > 0) return {a * wa + b * wb + c * wc, {wa, wb, wc}, 0};
  }
  const Vec3<Real>* corner[3] = {&a, &b, &c};
  TrianglePoint<Real> best;
  Real best2 = std::numeric_limits<Real>::infinity();
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t next = (e + 1) % 3;
    const Real t = closest_on_segment(p, *corner[e], *corner[next]);
    const Vec3<Real> point = *corner[e] + (*corner[next] - *corner[e]) * t;
    const Real d2 = (p - point).squaredNorm();
    if (!(d2 < best2)) continue;
    best2 = d2;
    best.point = point;
    best.barycentric = {0, 0, 0};
    best.barycentric[e] = Real(1) - t;
    best.barycentric[next] = t;
    const int from = static_cast<int>(e), to = static_cast<int>(next);
    best.feature = t <= 0 ? 1 + from : t >= 1 ? 1 + to : 4 + from;
  }
  return best;
}

/// Closest points of segments ab and cd (Ericson 2005, section 5.1.9); parallel and zero-length ones
/// give one of their closest pairs.
template <class Real>
SegmentPoints<Real> closest_of_segments(const Vec3<Real>& a, const Vec3<Real>& b,
                                        const Vec3<Real>& c, const Vec3<Real>& d) {
  const Vec3<Real> u = b - a, v = d - c, r = a - c;
  const Real uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r);
  const Real determinant = uu * vv - uv * uv;
  SegmentPoints<Real> result;
  // Relative to uu vv the determinant is the squared sine of the angle between the segments.
  if (determinant > uu * vv * Real(1e-10))
    result.s = std::clamp((uv * v.dot(r) - ur * vv) / determinant, Real(0), Real(1));
  result.t = closest_on_segment<Real>(a + u * result.s, c, d);
  result.q = c + v * result.t;
  result.s = closest_on_segment(result.q, a, b);
  result.p = a + u * result.s;
  // One more turn: the second clamp may have moved the first point.
  result.t = closest_on_segment(result.p, c, d);
  result.q = c + v * result.t;
  return result;
}

}  // namespace weft
