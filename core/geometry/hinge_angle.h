#pragma once

#include <array>
#include <cassert>
#include <cmath>

#include "core/math/angle.h"
#include "core/types.h"

// Dihedral angle of two triangles that share an edge.

namespace weft {

/// Dihedral angle of a hinge and its gradient by the four corners.
template <class Real>
struct HingeAngle {
  Real theta = 0;                           ///< [rad]; 0 when flat
  std::array<Vec3<Real>, 4> gradient = {};  ///< d theta / d x_a [rad/m]
};

/// Angle by atan2 of ((n1 x n2) . e, n1 . n2), gradient after Bridson, Marino, Fedkiw 2003 (the
/// bending mode u of their N1, N2, E; the gradient is its negative).
///
/// @param x0,x1  ends of the shared edge [m]
/// @param x2,x3  the opposite corners of triangles (x0,x1,x2) and (x1,x0,x3) [m]
/// @param smallest_normal2  [m^4]; see Hinge::smallest_normal2. While the squared length of a
///                          normal is below it, the whole gradient is scaled down in proportion:
///                          otherwise it would grow as one over the height of the triangle, and
///                          forces in a crumpled cloth would be unbounded. One factor for all four
///                          corners conserves both momenta.
/// A hinge with an edge of zero length or a triangle without area has angle 0 and no gradient.
template <class Real>
inline HingeAngle<Real> hinge_angle(const Vec3<Real>& x0, const Vec3<Real>& x1,
                                    const Vec3<Real>& x2, const Vec3<Real>& x3,
                                    Real smallest_normal2 = 0) {
  assert(smallest_normal2 >= 0);
  HingeAngle<Real> result;
  for (Vec3<Real>& g : result.gradient) g.setZero();
  const Vec3<Real> e = x1 - x0, a = x2 - x0, b = x3 - x0;
  const Vec3<Real> n1 = e.cross(a), n2 = b.cross(e);
  const Real l2 = e.squaredNorm(), n1_2 = n1.squaredNorm(), n2_2 = n2.squaredNorm();
  if (!(l2 > 0) || !(n1_2 > 0) || !(n2_2 > 0)) return result;
  const Real l = std::sqrt(l2);
  result.theta = angle_of(n1.cross(n2).dot(e) / l, n1.dot(n2));
  const Real smaller = n1_2 < n2_2 ? n1_2 : n2_2;
  const Real lever = smaller < smallest_normal2 ? l * (smaller / smallest_normal2) : l;
  const Vec3<Real> p1 = n1 * (lever / n1_2), p2 = n2 * (lever / n2_2);
  // Positions of the feet of the two heights along the edge, as fractions of its length.
  const Real s1 = a.dot(e) / l2, s2 = b.dot(e) / l2;
  result.gradient[2] = -p1;
  result.gradient[3] = -p2;
  result.gradient[1] = p1 * s1 + p2 * s2;
  result.gradient[0] = p1 * (Real(1) - s1) + p2 * (Real(1) - s2);
  return result;
}

}  // namespace weft
