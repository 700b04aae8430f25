#pragma once

#include "core/types.h"

// Directions between points that may be very near each other, in double precision.

namespace weft {

/// So near, the direction between two points is rounding [m].
inline constexpr double kNoDirection = 1e-6;

template <class Real>
Vec3d in_double(const Vec3<Real>& v) {
  return v.template cast<double>();
}

/// Direction in which one point is from another, and how far; up if there is no direction.
struct Apart {
  Vec3d normal;
  double distance;  ///< [m]; 0 if there is no direction
};

/// How p is apart from q [m].
inline Apart apart(const Vec3d& p, const Vec3d& q) {
  const Vec3d away = p - q;
  const double distance = away.norm();
  if (!(distance > kNoDirection)) return {Vec3d::UnitY(), 0};
  return {away / distance, distance};
}

}  // namespace weft
