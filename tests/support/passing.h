#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/types.h"

namespace weft::test {

/// Four moving points: a vertex and a triangle, or the ends of two edges.
using FourPoints = std::array<Vec3d, 4>;

inline FourPoints between(const FourPoints& from, const FourPoints& to, double t) {
  FourPoints q;
  for (std::size_t k = 0; k < 4; ++k) q[k] = from[k] + (to[k] - from[k]) * t;
  return q;
}

inline double volume(const FourPoints& q) {
  return (q[1] - q[0]).dot((q[2] - q[0]).cross(q[3] - q[0]));
}

/// Whether the flat quad has its vertex inside its triangle, or its edges crossing.
inline bool meet_in_plane(bool vertex, const FourPoints& q) {
  if (vertex) {
    const Vec3d n = (q[2] - q[1]).cross(q[3] - q[1]);
    const double longest =
        std::max({(q[2] - q[1]).norm(), (q[3] - q[2]).norm(), (q[1] - q[3]).norm()});
    if (!(n.norm() > 1e-9 * longest * longest)) return false;
    const double a = n.dot((q[2] - q[1]).cross(q[0] - q[1])),
                 b = n.dot((q[3] - q[2]).cross(q[0] - q[2])),
                 c = n.dot((q[1] - q[3]).cross(q[0] - q[3]));
    return a >= 0 && b >= 0 && c >= 0;
  }
  const Vec3d u = q[1] - q[0], v = q[3] - q[2], n = u.cross(v), r = q[2] - q[0];
  const double n2 = n.squaredNorm();
  if (!(n2 > 1e-18 * u.squaredNorm() * v.squaredNorm())) return false;
  const double s = r.cross(v).dot(n) / n2, t = r.cross(u).dot(n) / n2;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1;
}

/// Whether the features pass through each other on straight lines: finds where the four points are
/// in one plane by dense sampling and bisection. Slow, and shares nothing with what it judges. Does
/// not see those that stay in one plane, or touch and part between two samples, and leaves out
/// triangles without area and parallel edges, whose place in the plane is rounding.
inline bool pass_through(bool vertex, const FourPoints& from, const FourPoints& to,
                         int samples = 400) {
  double before = volume(from), t_before = 0;
  for (int k = 1; k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples, now = volume(between(from, to, t));
    if ((before < 0) != (now < 0)) {
      double low = t_before, high = t;
      for (int n = 0; n < 60; ++n) {
        const double middle = 0.5 * (low + high);
        ((volume(between(from, to, middle)) < 0) == (before < 0) ? low : high) = middle;
      }
      if (meet_in_plane(vertex, between(from, to, high))) return true;
    }
    before = now;
    t_before = t;
  }
  return false;
}

}  // namespace weft::test
