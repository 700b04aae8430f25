// Rotations and rigid motion.

#include "core/contact/colliders/pose.h"

#include <cassert>
#include <cmath>

#include "core/contact/colliders/constants.h"
#include "core/definition.h"
#include "core/error.h"
#include "core/math/angle.h"
#include "core/math/sine.h"

namespace weft {

bool operator==(const Pose& a, const Pose& b) {
  return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

void check_unit(const std::string& field, const Eigen::Quaterniond& q) {
  const double norm = q.norm();
  if (!(std::abs(norm - 1) < kUnitQuaternionSlack))
    throw DefinitionError(field, "of norm " + number_text(norm), "a unit quaternion [x, y, z, w]",
                          "its norm must be 1");
}

Eigen::Quaterniond rotation_by(const Vec3d& v) {
  const double angle = std::sqrt(v.squaredNorm());
  if (!(angle > 0)) return Eigen::Quaterniond::Identity();
  const SineCosine half = sine_cosine(angle / 2);
  const Vec3d axis = v * (half.sine / angle);
  return {half.cosine, axis[0], axis[1], axis[2]};
}

Vec3d rotation_vector(const Eigen::Quaterniond& q) {
  assert(std::abs(q.squaredNorm() - 1) < 1e-3);
  const Vec3d axis = q.w() < 0 ? (-q.vec()).eval() : q.vec().eval();
  const double sine = std::sqrt(axis.squaredNorm());
  if (!(sine > 0)) return Vec3d::Zero();
  return axis * (2 * angle_of(sine, std::abs(q.w())) / sine);
}

Pose moved(const Pose& from, const Twist& twist, double seconds) {
  assert(std::abs(from.rotation.squaredNorm() - 1) < 1e-3);
  Pose pose = from;
  pose.position += twist.linear * seconds;
  if (!twist.angular.isZero(0)) {
    pose.rotation = rotation_by(twist.angular * seconds) * from.rotation;
    pose.rotation.coeffs() /= std::sqrt(pose.rotation.coeffs().squaredNorm());
  }
  return pose;
}

}  // namespace weft
