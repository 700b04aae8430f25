#pragma once

#include "core/cloth/membrane_triangle.h"
#include "core/types.h"

// Gradients in the fabric's axes of what the corners of a membrane triangle carry.

namespace weft {

/// Derivatives, along warp and weft, of a field that is linear in a triangle.
/// @param d1,d2  vectors of corners 1 and 2 minus that of corner 0
template <class Real>
Vec3<Real> gradient_u(const MembraneTriangle<Real>& t, const Vec3<Real>& d1, const Vec3<Real>& d2) {
  return d1 * t.u1 + d2 * t.u2;
}
template <class Real>
Vec3<Real> gradient_v(const MembraneTriangle<Real>& t, const Vec3<Real>& d1, const Vec3<Real>& d2) {
  return d1 * t.v1 + d2 * t.v2;
}

}  // namespace weft
