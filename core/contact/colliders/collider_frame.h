#pragma once

#include "core/contact/colliders/collider_state.h"

// Pose and motion of a collider in one substep.

namespace weft {

/// Pose and motion of a collider in the coming substep, as contact needs them: shapes stay in the
/// frame of their definition ("own"), points are transformed to it and back.
template <class Real>
struct ColliderFrame {
  using Mat3 = Eigen::Matrix<Real, 3, 3>;

  Vec3d pivot = Vec3d::Zero();
  double radius = 0;           ///< of the surface about the pivot [m]
  double friction_factor = 1;  ///< of the collider

  Pose pose;
  bool displaced = false;            ///< not as defined; otherwise nothing below is used
  Mat3 rotation = Mat3::Identity();  ///< world = rotation own + shift
  Vec3<Real> shift = Vec3<Real>::Zero();

  bool tracked = false;    ///< moves in this tick, or is meant to
  Real surface_speed = 0;  ///< bound of any surface point's speed in this tick [m/s]

  // The coming substep: p moves to centre + step + turn (p - centre).
  bool moves = false, blocked = false;
  Vec3<Real> centre = Vec3<Real>::Zero(), step = Vec3<Real>::Zero();
  Mat3 turn = Mat3::Identity();
  Vec3<Real> velocity = Vec3<Real>::Zero();  ///< mean velocity of the centre [m/s]
  Mat3 spin = Mat3::Zero();                  ///< (turn - 1) / dt
  Real travel = 0;                           ///< bound of any surface point's displacement [m]

  /// Number of substeps in which no particle follows too closely for the object to stand still.
  int wary = 0;
  int rest = 0;  ///< number of substeps for which it stands, because cloth has stopped it

  Real travel_since_pairs = 0;  ///< sum of `travel` since the pairs were made [m]
  Real travel_since_rows = 0;   ///< and since the rows were made [m]

  Vec3<Real> own(const Vec3<Real>& p) const {
    return displaced ? (rotation.transpose() * (p - shift)).eval() : p;
  }
  Vec3<Real> world(const Vec3<Real>& p) const {
    return displaced ? (rotation * p + shift).eval() : p;
  }
  Vec3<Real> world_direction(const Vec3<Real>& d) const {
    return displaced ? (rotation * d).eval() : d;
  }
  Vec3<Real> own_direction(const Vec3<Real>& d) const {
    return displaced ? (rotation.transpose() * d).eval() : d;
  }
  /// Mean velocity of a point of the object over the coming substep [m/s].
  Vec3<Real> velocity_at(const Vec3<Real>& p) const { return velocity + spin * (p - centre); }
  /// Present position of a point of the object that is at p after the substep.
  Vec3<Real> taken_back(const Vec3<Real>& p) const {
    return centre + turn.transpose() * (p - centre - step);
  }

  void place(const Pose& at);
  /// Plans the coming substep of `dt` [s].
  void plan(const ColliderState& state, double dt, double tick_seconds);
  /// Makes the object stand still in the coming substep.
  void stand();
};

}  // namespace weft
