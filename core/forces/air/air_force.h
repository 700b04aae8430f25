#pragma once

#include <cmath>

#include "core/types.h"

// Force of the air on a triangle.

namespace weft {

/// Force of the air on a triangle [N], the drag of a plate and skin friction:
/// 1/2 rho C_n A |u_n| u_n n + c_t A u_t, with u the wind relative to the triangle.
///
/// @param doubled_normal  (b - a) x (c - a), twice the area vector [m^2]
/// @param u               wind minus mean velocity of the corners [m/s]
/// @param pressure        1/2 rho C_n [kg/m^3]
/// @param skin            c_t [kg/(m^2 s)]
/// The force is even in the normal, so the winding of the triangle does not matter.
template <class Real>
inline Vec3<Real> air_force(const Vec3<Real>& doubled_normal, const Vec3<Real>& u, Real pressure,
                            Real skin) {
  const Real length2 = doubled_normal.squaredNorm();
  if (!(length2 > 0)) return Vec3<Real>::Zero();
  const Real length = std::sqrt(length2), area = Real(0.5) * length;
  const Vec3<Real> n = doubled_normal / length;
  const Real un = u.dot(n);
  return n * (area * un * (pressure * std::abs(un) - skin)) + u * (skin * area);
}

}  // namespace weft
