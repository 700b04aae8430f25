#pragma once

#include "core/types.h"

// The cantilever test of bending stiffness.

namespace weft {

/// Angle below the horizontal of the chord of a heavy elastica [rad], 0 to pi/2.
/// @param gamma  sigma g L^3 / B, 0 to 1000; solved by shooting, to 1e-5 rad
double elastica_chord_angle(double gamma);

/// The gamma with this chord angle; see elastica_chord_angle.
/// @param angle  [rad], clamped to the range of gamma = 0 to 1000
double elastica_gamma(double angle);

struct CantileverMeasurement {
  double droop = 0;           ///< height of the clamp above the tip [m]
  double chord_angle = 0;     ///< of the line from clamp to tip, below the horizontal [degrees]
  double bending_length = 0;  ///< c = (B / (sigma g))^(1/3) [m], from the angle and the overhang
};

/// Evaluates an overhanging strip as the bending test does (ASTM D1388), but with the exact
/// elastica in place of Peirce's formula, which is off by 1.9 % at 41.5 degrees.
/// @param clamp,tip  ends of the overhang [m]
/// @param overhang   its length along the fabric [m], positive
CantileverMeasurement measure_cantilever(const Vec3d& clamp, const Vec3d& tip, double overhang);

}  // namespace weft
