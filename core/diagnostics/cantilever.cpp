// Solves the elastica for the cantilever test.

#include "core/diagnostics/cantilever.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "core/diagnostics/constants.h"

namespace weft {
namespace {

using std::numbers::pi;

struct Curve {
  double clamp_angle = 0, x = 0, drop = 0;
};

/// Integrates the elastica from its free tip, where the moment is zero, to the clamp. With the
/// distance q = 1 - s from the tip, theta'' = -gamma q cos theta; midpoint rule.
Curve shoot(double gamma, double tip_angle) {
  const double h = 1.0 / kElasticaSteps;
  double angle = tip_angle, slope = 0;
  Curve curve;
  for (int k = 0; k < kElasticaSteps; ++k) {
    const double q = k * h;
    const double middle_angle = angle + 0.5 * h * slope;
    const double middle_slope = slope - 0.5 * h * gamma * q * std::cos(angle);
    slope -= h * gamma * (q + 0.5 * h) * std::cos(middle_angle);
    angle += h * middle_slope;
    if (angle < 0) break;  // already below the level: the tip must hang more steeply
    curve.x += h * std::cos(middle_angle);
    curve.drop += h * std::sin(middle_angle);
  }
  curve.clamp_angle = angle;
  return curve;
}

}  // namespace

double elastica_chord_angle(double gamma) {
  assert(gamma >= 0 && gamma <= kLargestGamma);
  double low = 0, high = pi / 2;
  for (int k = 0; k < kElasticaHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (shoot(gamma, middle).clamp_angle < 0 ? low : high) = middle;
  }
  const Curve curve = shoot(gamma, high);
  return std::atan2(curve.drop, curve.x);
}

double elastica_gamma(double angle) {
  double low = 0, high = kLargestGamma;
  for (int k = 0; k < kElasticaHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (elastica_chord_angle(middle) < angle ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

CantileverMeasurement measure_cantilever(const Vec3d& clamp, const Vec3d& tip, double overhang) {
  assert(overhang > 0);
  CantileverMeasurement result;
  result.droop = clamp[1] - tip[1];
  const double angle = std::atan2(result.droop, std::hypot(tip[0] - clamp[0], tip[2] - clamp[2]));
  result.chord_angle = angle * 180 / pi;
  const double gamma = elastica_gamma(angle);
  if (gamma > 0) result.bending_length = overhang / std::cbrt(gamma);
  return result;
}

}  // namespace weft
