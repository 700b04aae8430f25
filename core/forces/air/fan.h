#pragma once

#include <algorithm>
#include <cassert>

#include "core/definition.h"
#include "core/forces/constants.h"

// Fans: local jets of air.

namespace weft {

/// A local wind: a jet from a disc that keeps its speed along its core and then slows down as it
/// widens, like free round jets (speed ~ 1 / distance beyond the potential core; Rajaratnam 1976).
struct FanDef {
  Vec3d position = Vec3d(0, 1, 1);    ///< centre of the outlet disc [m]
  Vec3d direction = -Vec3d::UnitZ();  ///< of the jet; any length but 0
  double speed = 5;                   ///< in the core [m/s]; 0: off
  double radius = 0.25;               ///< of the disc [m]
  double spread = 0.2;                ///< growth of the jet's radius per distance, a slope
  double reach = 1.5;                 ///< distance along which the core keeps its speed [m]
};

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_fan(Def& f, Visitor&& visit) {
  visit(FieldInfo{"position", kPositionRange, "m", "centre of the outlet disc"}, f.position);
  visit(FieldInfo{"direction", kPositionRange, "", "direction of the jet"}, f.direction);
  visit(FieldInfo{"speed", kFanSpeedRange, "m/s", "speed in the core"}, f.speed);
  visit(FieldInfo{"radius", kFanRadiusRange, "m", "radius of the disc"}, f.radius);
  visit(FieldInfo{"spread", kFanSpreadRange, "", "growth of the jet's radius per distance"},
        f.spread);
  visit(FieldInfo{"reach", kFanReachRange, "m", "length of the core"}, f.reach);
}

/// A fan prepared for evaluation at many points.
template <class Real>
struct FanJet {
  Vec3<Real> position, direction;  ///< direction of unit length
  Real speed, radius, spread, reach;

  explicit FanJet(const FanDef& def)
      : position(def.position.cast<Real>()),
        direction((def.direction / def.direction.norm()).template cast<Real>()),
        speed(static_cast<Real>(def.speed)), radius(static_cast<Real>(def.radius)),
        spread(static_cast<Real>(def.spread)), reach(static_cast<Real>(def.reach)) {
    assert(def.direction.norm() > 0);
    assert(def.radius > 0 && def.spread >= 0 && def.reach > 0);
  }

  /// Velocity of its air at a point [m/s]; exactly 0 behind the disc and outside the jet.
  Vec3<Real> operator()(const Vec3<Real>& point) const {
    const Vec3<Real> from_disc = point - position;
    const Real along = from_disc.dot(direction);
    if (!(along > 0)) return Vec3<Real>::Zero();
    const Real edge = radius + spread * along;
    const Real away2 = (from_disc - direction * along).squaredNorm();
    if (!(away2 < edge * edge)) return Vec3<Real>::Zero();
    const Real core = static_cast<Real>(kFanCore);
    const Real outwards = (std::sqrt(away2) / edge - core) / (Real(1) - core);
    const Real start = smooth(along / (radius * static_cast<Real>(kFanStart)));
    const Real fade = smooth(Real(1) - outwards);
    return direction * (speed * start * fade * std::min(Real(1), reach / along));
  }

 private:
  /// 0 below 0, 1 above 1, with zero slope at both.
  static Real smooth(Real t) {
    t = std::clamp(t, Real(0), Real(1));
    return t * t * (Real(3) - Real(2) * t);
  }
};

}  // namespace weft
