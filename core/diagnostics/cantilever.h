#pragma once

#include "core/types.h"

namespace weft {

/// Angle below the level of the line from clamp to tip of a heavy elastica [rad], 0 to pi/2.
/// @param gamma  sigma g L^3 / B, 0 to 1000; solved by shooting, to 1e-5 rad
double elastica_chord_angle(double gamma);

/// The gamma that gives this chord angle; see elastica_chord_angle.
/// @param angle  [rad], clamped to what gamma = 0 to 1000 gives
double elastica_gamma(double angle);

struct CantileverMeasurement {
  double droop = 0;           ///< height of the clamp over the tip [m]
  double chord_angle = 0;     ///< of the line from clamp to tip below the level [degrees]
  double bending_length = 0;  ///< c = (B / (sigma g))^(1/3) [m], from the angle and the overhang
};

/// Reads a strip that hangs over an edge as the bending test does (ASTM D1388), but with the exact
/// elastica in place of Peirce's formula, which is 1.9 % off at 41.5 degrees.
/// @param clamp,tip  ends of the overhang [m]
/// @param overhang   its length along the fabric [m], positive
CantileverMeasurement measure_cantilever(const Vec3d& clamp, const Vec3d& tip, double overhang);

}  // namespace weft
