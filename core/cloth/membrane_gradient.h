#pragma once

#include <array>

#include "core/cloth/membrane_triangle.h"
#include "core/types.h"

// Gradients in the fabric's axes of what the corners of a membrane triangle carry.

namespace weft {

/// Derivatives, along warp and weft, of the linear functions that are 1 at one corner and 0 at the
/// others [1/m].
template <class Number>
struct CornerGradients {
  std::array<Number, 3> u, v;
};

template <class Number, class Real>
CornerGradients<Number> corner_gradients(const MembraneTriangle<Real>& t) {
  const auto u1 = static_cast<Number>(t.u1), u2 = static_cast<Number>(t.u2),
             v1 = static_cast<Number>(t.v1), v2 = static_cast<Number>(t.v2);
  return {{-(u1 + u2), u1, u2}, {-(v1 + v2), v1, v2}};
}

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
