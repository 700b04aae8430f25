#pragma once

#include <vector>

#include "core/definition.h"
#include "core/forces/air/fan.h"

// Gravity, wind and other properties of the air.

namespace weft {

/// Gravity and air around the cloth.
struct EnvironmentDef {
  Vec3d gravity = Vec3d(0, -9.81, 0);  ///< [m/s^2]
  Vec3d wind = Vec3d::Zero();          ///< mean wind velocity [m/s]
  double gust_speed = 0;               ///< bound of each component of the gusts [m/s]
  double gust_length = 0.6;            ///< size of an eddy [m]
  double air_density = 1.225;          ///< rho [kg/m^3]
  bool still_air = false;              ///< compute air forces even without wind
  double damping = 0;                  ///< alpha, uniform velocity damping [1/s]
  std::vector<FanDef> fans;            ///< local winds, at most kMostFans
};

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_environment(Def& e, Visitor&& visit) {
  visit(FieldInfo{"gravity", kGravityRange, "m/s^2", "acceleration of gravity"}, e.gravity);
  visit(FieldInfo{"wind", kWindRange, "m/s", "mean wind velocity"}, e.wind);
  visit(FieldInfo{"gust_speed", kGustSpeedRange, "m/s",
                  "bound of each component of the gusts; its rms is 0.4 of that"},
        e.gust_speed);
  visit(FieldInfo{"gust_length", kGustLengthRange, "m", "size of an eddy"}, e.gust_length);
  visit(FieldInfo{"air_density", kAirDensityRange, "kg/m^3", "density of the air"}, e.air_density);
  visit(FieldInfo{"still_air", 0, 1, "", "air forces even without wind"}, e.still_air);
  visit(FieldInfo{"drag", kDragRange, "1/s", "uniform velocity damping"}, e.damping);
}

/// Throws DefinitionError if a field is out of range or there are too many fans.
void validate(const EnvironmentDef& def);

}  // namespace weft
