#include "core/geometry/distance.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

/// Corners of a triangle or ends of two segments.
template <class Real>
using Points = std::array<Vec3<Real>, 4>;

template <class Real>
Vec3<Real> random_point(Random& random, double size) {
  return random.vector(size).template cast<Real>();
}

/// Triangles of every kind: plain, sliver, collinear, with two equal corners, with three.
template <class Real>
Points<Real> any_triangle(Random& random, int kind) {
  Points<Real> t;
  for (Vec3<Real>& p : t) p = random_point<Real>(random, 1);
  const auto along = static_cast<Real>(random.uniform(-0.5, 1.5));
  if (kind == 1) t[2] = t[0] + (t[1] - t[0]) * along + random_point<Real>(random, 1e-2);
  if (kind == 2) t[2] = t[0] + (t[1] - t[0]) * along;
  if (kind == 3) t[2] = t[1];
  if (kind == 4) t[1] = t[2] = t[0];
  return t;
}

/// How far a closest point is from the best: q is the closest point of a convex set to p exactly if
/// no corner lies in front of the plane through q across p - q. In metres: a corner at height h in
/// front over a set of size 1 means a distance wrong by at most about h.
template <class Real>
double excess(const Vec3<Real>& p, const Vec3<Real>& q, const Points<Real>& triangle) {
  const Vec3d away = (p - q).template cast<double>();
  double worst = 0;
  for (std::size_t k = 0; k < 3; ++k)
    worst = std::max(worst, away.dot((triangle[k] - q).template cast<double>()));
  return away.norm() > 0 ? worst / away.norm() : 0.0;
}

template <class Real>
void check_triangles(double tolerance) {
  SeededRandom random(1);
  for (int n = 0; n < 20000; ++n) {
    const int kind = n % 5;
    const Points<Real> t = any_triangle<Real>(random, kind);
    // Every third point is taken from the triangle itself or its plane.
    Vec3<Real> p = random_point<Real>(random, 2);
    if (n % 3 == 0) {
      const auto u = static_cast<Real>(random.uniform(-1, 2)),
                 v = static_cast<Real>(random.uniform(-1, 2));
      p = t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
    }
    const auto c = closest_on_triangle<Real>(p, t[0], t[1], t[2]);
    INFO("n " << n << " kind " << kind << " feature " << c.feature);
    Real sum = 0;
    Vec3<Real> blend = Vec3<Real>::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(c.barycentric[k] >= -std::numeric_limits<Real>::epsilon());
      sum += c.barycentric[k];
      blend += t[k] * c.barycentric[k];
    }
    REQUIRE(std::abs(static_cast<double>(sum) - 1) < tolerance);
    REQUIRE(static_cast<double>((blend - c.point).norm()) < tolerance);
    // Below this distance the direction is rounding.
    const double distance = static_cast<double>((p - c.point).norm());
    if (distance > 100 * tolerance)
      REQUIRE(excess(p, c.point, t) < tolerance / std::min(1.0, distance));
    REQUIRE(c.feature >= 0);
    REQUIRE(c.feature <= 6);
    if (c.feature >= 1 && c.feature <= 3)
      REQUIRE(c.barycentric[static_cast<std::size_t>(c.feature - 1)] == Real(1));
    if (c.feature >= 4)
      REQUIRE(c.barycentric[static_cast<std::size_t>((c.feature - 2) % 3)] == Real(0));
  }
}

template <class Real>
void check_segments(double tolerance) {
  SeededRandom random(2);
  for (int n = 0; n < 20000; ++n) {
    Points<Real> e;
    for (Vec3<Real>& p : e) p = random_point<Real>(random, 1);
    const int kind = n % 6;
    const auto shift = static_cast<Real>(random.uniform(-2, 2));
    if (kind == 1) e[3] = e[2] + (e[1] - e[0]) * shift;                               // parallel
    if (kind == 2) e[2] = e[0] + (e[1] - e[0]) * shift, e[3] = e[2] + (e[1] - e[0]);  // one line
    if (kind == 3) e[3] = e[2];                                                       // a point
    if (kind == 4) e[1] = e[0], e[3] = e[2];                                          // two points
    if (kind == 5) e[3] = e[2] + (e[1] - e[0]) * shift + random_point<Real>(random, 1e-3);
    const auto c = closest_of_segments<Real>(e[0], e[1], e[2], e[3]);
    INFO("n " << n << " kind " << kind << " s " << c.s << " t " << c.t);
    REQUIRE((c.s >= 0 && c.s <= 1 && c.t >= 0 && c.t <= 1));
    REQUIRE(static_cast<double>((e[0] + (e[1] - e[0]) * c.s - c.p).norm()) < tolerance);
    REQUIRE(static_cast<double>((e[2] + (e[3] - e[2]) * c.t - c.q).norm()) < tolerance);
    // Two convex sets are closest where neither has a point in front of the plane across p - q:
    // that condition is sufficient and also holds for parallel ones.
    const Vec3d away = (c.p - c.q).template cast<double>();
    const double distance = away.norm();
    if (distance < 100 * tolerance) continue;
    double worst = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      worst = std::max(worst, -away.dot((e[k] - c.p).template cast<double>()));
      worst = std::max(worst, away.dot((e[k + 2] - c.q).template cast<double>()));
    }
    REQUIRE(worst / distance < tolerance / std::min(1.0, distance));
  }
}

}  // namespace

TEST_CASE("closest point of a triangle meets the optimality condition, degenerate ones too") {
  SECTION("double, 1e-10 m") {
    check_triangles<double>(1e-10);
  }
  SECTION("float, 1e-4 m") {
    check_triangles<float>(1e-4);
  }
}

TEST_CASE("closest point of a triangle is nearer than any sampled point") {
  SeededRandom random(3);
  for (int n = 0; n < 500; ++n) {
    const Points<double> t = any_triangle<double>(random, n % 5);
    const Vec3d p = random.vector(2);
    const double found = (p - closest_on_triangle<double>(p, t[0], t[1], t[2]).point).norm();
    double sampled = 1e9;
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j)
        sampled = std::min(
            sampled, (t[0] + (t[1] - t[0]) * (i / 20.0) + (t[2] - t[0]) * (j / 20.0) - p).norm());
    INFO("n " << n);
    REQUIRE(found <= sampled + 1e-9);
    REQUIRE(found >= sampled - 0.3);  // the samples are at most that far apart
  }
}

TEST_CASE("a point over the middle of a thin triangle is closest to its inside") {
  // 1 m long, 0.5 mm wide: the point 1 mm above its middle line is 1 mm away, not more.
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0.5, 0, 5e-4), p(0.5, 1e-3, 2e-4);
  CHECK((closest_on_triangle<double>(p, a, b, c).point - p).norm() == Approx(1e-3).epsilon(1e-9));
  CHECK(closest_on_triangle<double>(p, a, b, c).feature == 0);
  const auto f = closest_on_triangle<float>(p.cast<float>(), a.cast<float>(), b.cast<float>(),
                                            c.cast<float>());
  CHECK(static_cast<double>((f.point - p.cast<float>()).norm()) == Approx(1e-3).epsilon(1e-3));
}

TEST_CASE("closest points of two segments meet the optimality condition, degenerate ones too") {
  SECTION("double, 1e-9 m") {
    check_segments<double>(1e-9);
  }
  SECTION("float, 2e-3 m") {
    check_segments<float>(2e-3);
  }
}

TEST_CASE("crossing segments touch at their crossing") {
  const auto c =
      closest_of_segments<double>(Vec3d(-1, 0, 0), Vec3d(3, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 1, 0));
  CHECK(c.s == Approx(0.25));
  CHECK(c.t == Approx(0.5));
  CHECK((c.p - c.q).norm() < 1e-15);
}
