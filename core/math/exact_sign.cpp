#include "core/math/exact_sign.h"

#include <cmath>
#include <limits>
#include <vector>

namespace weft {
namespace {

/// A number as an exact sum of doubles of growing size that do not overlap.
using Expansion = std::vector<double>;

/// sum + error = a + b exactly.
double two_sum(double a, double b, double& error) {
  const double sum = a + b, b_part = sum - a, a_part = sum - b_part;
  error = (a - a_part) + (b - b_part);
  return sum;
}

void add(Expansion& e, double b) {
  for (double& term : e) b = two_sum(b, term, term);
  e.push_back(b);
}

void add(Expansion& e, const Expansion& f) {
  for (const double term : f) add(e, term);
}

Expansion difference(double a, double b) {
  double error;
  const double sum = two_sum(a, -b, error);
  return {error, sum};
}

Expansion product(const Expansion& e, const Expansion& f) {
  Expansion result;
  for (const double a : e) {
    for (const double b : f) {
      const double high = a * b;
      add(result, std::fma(a, b, -high));
      add(result, high);
    }
  }
  return result;
}

Expansion minor(const Expansion& a, const Expansion& b, const Expansion& c, const Expansion& d) {
  Expansion result = product(a, d);
  Expansion other = product(b, c);
  for (double& term : other) term = -term;
  add(result, other);
  return result;
}

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

int sign_of(const Expansion& e) {
  for (auto term = e.rbegin(); term != e.rend(); ++term)
    if (*term != 0) return sign_of(*term);
  return 0;
}

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  Expansion u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(a[k], d[k]);
    v[k] = difference(b[k], d[k]);
    w[k] = difference(c[k], d[k]);
  }
  Expansion sum = product(u[0], minor(v[1], v[2], w[1], w[2]));
  add(sum, product(u[1], minor(v[2], v[0], w[2], w[0])));
  add(sum, product(u[2], minor(v[0], v[1], w[0], w[1])));
  return sign_of(sum);
}

}  // namespace

int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = a - d, v = b - d, w = c - d;
  const double vw_x = v[1] * w[2], wv_x = v[2] * w[1], vw_y = v[2] * w[0], wv_y = v[0] * w[2],
               vw_z = v[0] * w[1], wv_z = v[1] * w[0];
  const double determinant = u[0] * (vw_x - wv_x) + u[1] * (vw_y - wv_y) + u[2] * (vw_z - wv_z);
  const double size = std::abs(u[0]) * (std::abs(vw_x) + std::abs(wv_x)) +
                      std::abs(u[1]) * (std::abs(vw_y) + std::abs(wv_y)) +
                      std::abs(u[2]) * (std::abs(vw_z) + std::abs(wv_z));
  constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
  constexpr double kBound = (7 + 56 * kUnit) * kUnit;  // Shewchuk's o3derrboundA
  if (std::abs(determinant) > kBound * size) return sign_of(determinant);
  return exact_orientation(a, b, c, d);
}

}  // namespace weft
