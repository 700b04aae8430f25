#pragma once

#include <cmath>
#include <limits>

// Sine and cosine from + - * / only, like the inverse tangent in angle.h: the same bits on every
// processor.

namespace weft {

struct SineCosine {
  double sine = 0, cosine = 1;
};

/// Sine and cosine of an angle within +-1000 [rad]. Absolute error below 4e-16 times (1 + |angle|).
/// NaN for all others: the angle of a hinge whose corners have flown too far apart is infinite.
inline SineCosine sine_cosine(double angle) {
  if (!(std::abs(angle) <= 1000)) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  // A quarter turn in two parts; the first has few enough bits that its multiples are exact.
  constexpr double kQuarterHigh = 1.5707963267341256, kQuarterLow = 6.0771005065061922e-11;
  const double quarters = std::nearbyint(angle / (kQuarterHigh + kQuarterLow));
  const double t = (angle - quarters * kQuarterHigh) - quarters * kQuarterLow;
  // Taylor series on +-pi/4; the first omitted term is below 1e-18.
  const double t2 = t * t;
  constexpr int kTerms = 9;
  double sine = 1, cosine = 1;
  for (int n = kTerms; n >= 1; --n) {
    const double even = 2.0 * n;
    sine = 1 - sine * t2 / (even * (even + 1));
    cosine = 1 - cosine * t2 / (even * (even - 1));
  }
  sine *= t;
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace weft
