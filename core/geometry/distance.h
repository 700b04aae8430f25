#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/types.h"

// Closest points of simple shapes: pure functions on fixed-size vectors, safe for degenerate input.

namespace weft {

/// Closest point of a triangle to a point.
template <class Real>
struct TrianglePoint {
  Vec3<Real> point;                 ///< on the triangle [m]
  std::array<Real, 3> barycentric;  ///< its weights: >= 0, sum 1
  int feature = 0;  ///< 0: inside; 1, 2, 3: corner a, b, c; 4, 5, 6: edge ab, bc, ca
};

/// Closest points of two segments.
template <class Real>
struct SegmentPoints {
  Real s = 0, t = 0;  ///< parameters on the first and the second segment, 0 to 1
  Vec3<Real> p, q;    ///< the points [m]
};

/// Closest parameter, 0 to 1, of segment a + t (b - a) to point p; 0 if the segment has zero
/// length.
template <class Real>
inline Real closest_on_segment(const Vec3<Real>& p, const Vec3<Real>& a, const Vec3<Real>& b) {
  const Vec3<Real> d = b - a;
  const Real length2 = d.squaredNorm();
  if (!(length2 > 0)) return 0;
  return std::clamp((p - a).dot(d) / length2, Real(0), Real(1));
}

/// Closest point of a thin or degenerate triangle. Cross products keep the weights accurate where
/// differences of products would cancel.
template <class Real>
TrianglePoint<Real> closest_on_thin_triangle(const Vec3<Real>& p, const Vec3<Real>& a,
                                             const Vec3<Real>& b, const Vec3<Real>& c) {
  const Vec3<Real> ab = b - a, ac = c - a, ap = p - a, n = ab.cross(ac);
  const Real n2 = n.squaredNorm();
  constexpr Real kRounding = 16 * std::numeric_limits<Real>::epsilon();
  if (n2 > ab.squaredNorm() * ac.squaredNorm() * (kRounding * kRounding)) {
    const Real wb = ap.cross(ac).dot(n) / n2, wc = ab.cross(ap).dot(n) / n2, wa = Real(1) - wb - wc;
    if (wa > 0 && wb > 0 && wc > 0) return {a + ab * wb + ac * wc, {wa, wb, wc}, 0};
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

/// Closest point of triangle abc to p. The signs of the weights of p's projection, and of its
/// positions along the edges, tell whether a corner, an edge or the inside is closest (Ericson
/// 2005, section 5.1.5). Safe for a triangle without area.
template <class Real>
TrianglePoint<Real> closest_on_triangle(const Vec3<Real>& p, const Vec3<Real>& a,
                                        const Vec3<Real>& b, const Vec3<Real>& c) {
  const Vec3<Real> ab = b - a, ac = c - a, ap = p - a;
  const Real ab_p = ab.dot(ap), ac_p = ac.dot(ap);
  if (ab_p <= 0 && ac_p <= 0) return {a, {1, 0, 0}, 1};
  const Real ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), abc = ab.dot(ac);
  const Real area = ab2 * ac2 - abc * abc;  // squared doubled area
  // The square root of Real's precision: below it the weights lose half of their digits.
  constexpr Real kThin = std::numeric_limits<Real>::digits > 30 ? Real(1e-8) : Real(3e-4);
  if (!(area > ab2 * ac2 * kThin)) return closest_on_thin_triangle(p, a, b, c);
  const Real ab_pb = ab_p - ab2, ac_pb = ac_p - abc;  // the same products from corner b
  if (ab_pb >= 0 && ac_pb <= ab_pb) return {b, {0, 1, 0}, 2};
  const Real ab_pc = ab_p - abc, ac_pc = ac_p - ac2;  // and from corner c
  if (ac_pc >= 0 && ab_pc <= ac_pc) return {c, {0, 0, 1}, 3};
  const Real weight_c = ab_p * ac_pb - ab_pb * ac_p;
  if (weight_c <= 0 && ab_p >= 0 && ab_pb <= 0) {
    const Real t = ab_p / ab2;
    return {a + ab * t, {Real(1) - t, t, 0}, 4};
  }
  const Real weight_b = ab_pc * ac_p - ab_p * ac_pc;
  if (weight_b <= 0 && ac_p >= 0 && ac_pc <= 0) {
    const Real t = ac_p / ac2;
    return {a + ac * t, {Real(1) - t, 0, t}, 6};
  }
  const Real weight_a = ab_pb * ac_pc - ab_pc * ac_pb;
  const Real from_b = ac_pb - ab_pb, from_c = ab_pc - ac_pc;
  if (weight_a <= 0 && from_b >= 0 && from_c >= 0) {
    const Real t = from_b / (from_b + from_c);
    return {b + (c - b) * t, {0, Real(1) - t, t}, 5};
  }
  const Real sum = Real(1) / (weight_a + weight_b + weight_c);
  const Real wb = weight_b * sum, wc = weight_c * sum, wa = Real(1) - wb - wc;
  return {a + ab * wb + ac * wc, {wa, wb, wc}, 0};
}

/// Closest points of segments ab and cd (Ericson 2005, section 5.1.9); for parallel or zero-length
/// segments one of the closest pairs.
template <class Real>
SegmentPoints<Real> closest_of_segments(const Vec3<Real>& a, const Vec3<Real>& b,
                                        const Vec3<Real>& c, const Vec3<Real>& d) {
  const Vec3<Real> u = b - a, v = d - c, r = a - c;
  const Real uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r);
  const Real determinant = uu * vv - uv * uv;
  SegmentPoints<Real> result;
  // Relative to uu vv the determinant is the squared sine of the angle between the segments.
  constexpr Real kParallel = std::numeric_limits<Real>::digits > 30 ? Real(1e-14) : Real(1e-10);
  if (determinant > uu * vv * kParallel)
    result.s = std::clamp((uv * v.dot(r) - ur * vv) / determinant, Real(0), Real(1));
  result.t = closest_on_segment<Real>(a + u * result.s, c, d);
  result.q = c + v * result.t;
  result.s = closest_on_segment(result.q, a, b);
  result.p = a + u * result.s;
  // Once more for t: the second clamp may have moved the first point.
  result.t = closest_on_segment(result.p, c, d);
  result.q = c + v * result.t;
  return result;
}

}  // namespace weft
