#pragma once

#include "core/contact/colliders/collider_state.h"

namespace weft {

/// Where a collider stands, and how it moves in the coming substep, as contact needs it: shapes
/// stay in the frame of their definition ("own"), points are brought there and back.
template <class Real>
struct ColliderFrame {
  using Mat3 = Eigen::Matrix<Real, 3, 3>;

  Vec3d pivot = Vec3d::Zero();
  double radius = 0;  ///< of the surface about the pivot [m]

  Pose pose;
  bool displaced = false;            ///< not as defined; else nothing below is looked at
  Mat3 rotation = Mat3::Identity();  ///< world = rotation own + shift
  Vec3<Real> shift = Vec3<Real>::Zero();

  bool tracked = false;    ///< moves in this tick, or would like to
  Real surface_speed = 0;  ///< no point of the surface is faster in this tick [m/s]

  // The coming substep: p goes to centre + step + turn (p - centre).
  bool moves = false, blocked = false;
  Vec3<Real> centre = Vec3<Real>::Zero(), step = Vec3<Real>::Zero();
  Mat3 turn = Mat3::Identity();
  Vec3<Real> velocity = Vec3<Real>::Zero();  ///< mean one, of the centre [m/s]
  Mat3 spin = Mat3::Zero();                  ///< (turn - 1) / dt
  Real way = 0;                              ///< no point of the surface goes farther [m]

  /// For so many substeps nobody follows so closely that the object could not stand still.
  int wary = 0;
  int rest = 0;  ///< for so many substeps it stands, as cloth has stopped it

  Real way_collected = 0, way_rows = 0;  ///< the same since the pairs, since the rows were made

  Vec3<Real> own(const Vec3<Real>& p) const {
    return displaced ? (rotation.transpose() * (p - shift)).eval() : p;
  }
  Vec3<Real> world(const Vec3<Real>& p) const {
    return displaced ? (rotation * p + shift).eval() : p;
  }
  Vec3<Real> world_direction(const Vec3<Real>& d) const {
    return displaced ? (rotation * d).eval() : d;
  }
  /// Mean velocity of a point of the object over the coming substep [m/s].
  Vec3<Real> velocity_at(const Vec3<Real>& p) const { return velocity + spin * (p - centre); }
  /// Where a point that is at p after the substep would be now, if it were a part of the object.
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
