#pragma once

#include <string>

#include "core/types.h"

// Poses and twists of rigid objects.

namespace weft {

/// Pose of a rigid object relative to its definition: a point p of the definition is at position +
/// rotation (p - pivot), with the object's pivot (collider.h).
struct Pose {
  Vec3d position = Vec3d::Zero();                                ///< of the pivot [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
};

bool operator==(const Pose& a, const Pose& b);

/// Throws DefinitionError if a quaternion is not of unit norm, within the rounding of three digits.
/// @param field  its name with the path
void check_unit(const std::string& field, const Eigen::Quaterniond& q);

/// Rigid motion at constant velocities.
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
