#pragma once

#include "core/types.h"

namespace weft {

/// Where a rigid object is, relative to how its definition places it: a point p of the definition
/// is at position + rotation (p - pivot), where the pivot is the object's own (collider.h).
struct Pose {
  Vec3d position = Vec3d::Zero();                                ///< of the pivot [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
};

bool operator==(const Pose& a, const Pose& b);

/// Rigid motion that is constant for a while.
struct Twist {
  Vec3d linear = Vec3d::Zero();   ///< velocity of the pivot [m/s]
  Vec3d angular = Vec3d::Zero();  ///< about the pivot, along the axis [rad/s]

  bool is_zero() const { return linear.isZero(0) && angular.isZero(0); }
};

/// The rotation by |v| about v [rad].
Eigen::Quaterniond rotation_by(const Vec3d& v);

/// The shortest v with rotation_by(v) = +-q, at most pi long [rad].
Vec3d rotation_vector(const Eigen::Quaterniond& q);

/// The pose after moving with a twist for some time [s].
Pose moved(const Pose& from, const Twist& twist, double seconds);

}  // namespace weft
