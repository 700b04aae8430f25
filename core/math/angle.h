#pragma once

#include <cmath>
#include <limits>
#include <numbers>

// Inverse tangent from + - * / only. The C library selects different code on different processors,
// which changes the last bit; this version gives the same bits everywhere.

namespace weft {

namespace angle_detail {

/// atan(t) for |t| <= tan(pi/8) by its Taylor series t - t^3/3 + t^5/5 - ...; the first omitted
/// term is below half a unit in the last place of Real.
template <class Real>
inline Real atan_series(Real t) {
  constexpr int kTerms = std::numeric_limits<Real>::digits > 30 ? 21 : 10;
  const Real t2 = t * t;
  Real sum = Real(1) / Real(2 * kTerms - 1);
  for (int n = kTerms - 2; n >= 0; --n) sum = Real(1) / Real(2 * n + 1) - t2 * sum;
  return t * sum;
}

}  // namespace angle_detail

/// Angle of the vector (x, y) from the x axis, in (-pi, pi] [rad]; 0 for the zero vector. Absolute
/// error below 4 units in the last place of pi. Selects instead of branching, so that loops over it
/// become vector code.
template <class Real>
inline Real angle_of(Real y, Real x) {
  constexpr Real kPi = std::numbers::pi_v<Real>;
  constexpr Real kTanEighth = Real(0.41421356237309504880);  // tan(pi/8)
  const Real ax = std::abs(x), ay = std::abs(y);
  const Real large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  // Either the ratio is below tan(pi/8), or that of its angle from the diagonal is.
  const bool near_diagonal = small > kTanEighth * large;
  const Real numerator = near_diagonal ? small - large : small;
  const Real sum = near_diagonal ? small + large : large;
  const Real denominator = sum > 0 ? sum : Real(1);
  const Real offset = near_diagonal ? kPi / 4 : Real(0);
  const Real octant = offset + angle_detail::atan_series(numerator / denominator);
  const Real quadrant = ay > ax ? kPi / 2 - octant : octant;
  const Real half = x < 0 ? kPi - quadrant : quadrant;
  return y < 0 ? -half : half;
}

}  // namespace weft
