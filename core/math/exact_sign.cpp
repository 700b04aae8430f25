// Adaptive-precision orientation test by floating-point expansions.

#include "core/math/exact_sign.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace weft {
namespace {

/// sum + error = a + b exactly.
double two_sum(double a, double b, double& error) {
  const double sum = a + b, b_part = sum - a, a_part = sum - b_part;
  error = (a - a_part) + (b - b_part);
  return sum;
}

/// A number as an exact sum of non-overlapping, non-zero doubles of increasing size. Holds the most
/// that an orientation needs: 3 products of 2 and 16 terms, 2 each.
struct Expansion {
  std::array<double, 192> term;
  std::size_t size = 0;

  void add(double b) {
    assert(size < term.size());
    std::size_t kept = 0;
    for (std::size_t k = 0; k < size; ++k) {
      double error;
      b = two_sum(b, term[k], error);
      if (error != 0) term[kept++] = error;
    }
    if (b != 0) term[kept++] = b;
    size = kept;
  }
  /// @param sign  1 or -1
  void add(const Expansion& e, double sign = 1) {
    assert(sign == 1 || sign == -1);
    for (std::size_t k = 0; k < e.size; ++k) add(sign * e.term[k]);
  }
};

Expansion difference(double a, double b) {
  Expansion result;
  result.add(a);
  result.add(-b);
  return result;
}

Expansion product(const Expansion& e, const Expansion& f) {
  Expansion result;
  for (std::size_t k = 0; k < e.size; ++k) {
    for (std::size_t n = 0; n < f.size; ++n) {
      const double high = e.term[k] * f.term[n];
      result.add(std::fma(e.term[k], f.term[n], -high));
      result.add(high);
    }
  }
  return result;
}

Expansion minor(const Expansion& a, const Expansion& b, const Expansion& c, const Expansion& d) {
  Expansion result = product(a, d);
  result.add(product(b, c), -1);
  return result;
}

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

int sign_of(const Expansion& e) {
  return e.size > 0 ? sign_of(e.term[e.size - 1]) : 0;
}

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  Expansion u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(a[k], d[k]);
    v[k] = difference(b[k], d[k]);
    w[k] = difference(c[k], d[k]);
  }
  Expansion sum = product(u[0], minor(v[1], v[2], w[1], w[2]));
  sum.add(product(u[1], minor(v[2], v[0], w[2], w[0])));
  sum.add(product(u[2], minor(v[0], v[1], w[0], w[1])));
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
