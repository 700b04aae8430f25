#include "core/forces/hinge.h"

#include <catch2/catch.hpp>

#include "core/geometry/hinge_angle.h"
#include "tests/support/random.h"

using namespace weft;

namespace {

/// A hinge along y with wings of length `wing`, folded by theta away from the normal's side.
std::array<Vec3d, 4> folded(double theta, double wing = 0.3) {
  const double a = theta / 2;
  return {Vec3d(0, 0, 0), Vec3d(0, 0.5, 0), Vec3d(-wing * std::cos(a), 0.2, -wing * std::sin(a)),
          Vec3d(wing * std::cos(a), 0.3, -wing * std::sin(a))};
}

}  // namespace

TEMPLATE_TEST_CASE("the angle of a vector is that of the C library to 4 units in the last place",
                   "", float, double) {
  using Real = TestType;
  const Real tolerance = 4 * std::numeric_limits<Real>::epsilon() * Real(3.2);
  for (int n = -20000; n <= 20000; ++n) {
    const double phi = 3.14159265358979 * n / 20000.0, r = std::pow(10.0, n % 7);
    const auto y = static_cast<Real>(r * std::sin(phi)), x = static_cast<Real>(r * std::cos(phi));
    CHECK(std::abs(angle_of(y, x) - std::atan2(y, x)) <= tolerance);
  }
  CHECK(angle_of(Real(0), Real(0)) == 0);
  CHECK(angle_of(Real(0), Real(-1)) == Approx(3.14159265358979));
}

TEST_CASE("a hinge folded by theta measures theta, from one flat side to the other") {
  for (double theta = -3.1; theta <= 3.1; theta += 0.1) {
    const auto x = folded(theta);
    CHECK(hinge_angle(x[0], x[1], x[2], x[3]).theta == Approx(theta).margin(1e-12));
  }
}

TEST_CASE("a hinge bent by theta gives the moment k theta about its edge") {
  Hinge<double> hinge;
  hinge.stiffness = 2.5e-4;
  for (const double theta : {-2.0, -0.3, 0.01, 0.7, 2.5}) {
    const auto x = folded(theta);
    const auto angle = hinge_angle(x[0], x[1], x[2], x[3]);
    const double moment = hinge_moment(hinge, angle.theta, 0.0);
    CHECK(moment == Approx(-2.5e-4 * theta));
    // The force on each wing's tip times its distance from the edge is that moment.
    for (const std::size_t tip : {2u, 3u}) {
      const double height = std::hypot(x[tip][0], x[tip][2]);
      CHECK((angle.gradient[tip] * moment).norm() * height == Approx(std::abs(moment)));
    }
  }
}

TEST_CASE("a rest angle moves the point without moment") {
  Hinge<double> hinge;
  hinge.stiffness = 1;
  hinge.rest_angle = 0.26;
  CHECK(hinge_moment(hinge, 0.26, 0.0) == 0);
  CHECK(hinge_moment(hinge, 0.0, 0.0) == Approx(0.26));
  CHECK(hinge_energy(hinge, 0.46) == Approx(0.02));
}

TEST_CASE("the sine form is Bridson's: 2k (sin theta/2 - sin theta_0/2), worked by hand") {
  Hinge<double> hinge;
  hinge.sine_form = true;
  hinge.stiffness = 3;
  // sin 45 and sin 30 degrees.
  CHECK(hinge_moment(hinge, 1.5707963267948966, 0.0) == Approx(-6 * 0.70710678118654752));
  CHECK(hinge_energy(hinge, 1.5707963267948966) == Approx(12 * (1 - 0.70710678118654752)));
  hinge.rest_angle = 1.0471975511965976;
  CHECK(hinge_moment(hinge, 1.5707963267948966, 0.0) == Approx(-6 * 0.20710678118654752));
  CHECK(hinge_moment(hinge, hinge.rest_angle, 0.0) == 0);
  CHECK(hinge_moment(hinge, 0.0, 2.0) == Approx(6 * 0.5));
  hinge.damping = 0.25;
  CHECK(hinge_moment(hinge, hinge.rest_angle, 2.0) == Approx(-0.5));
}

TEST_CASE(
    "the sine form's moment is the slope of its energy, and small bends are as of the angle") {
  Hinge<double> sine, angle;
  sine.sine_form = true;
  sine.stiffness = angle.stiffness = 0.7;
  for (const double rest : {-0.5, 0.0, 0.26}) {
    sine.rest_angle = angle.rest_angle = rest;
    for (double theta = -3; theta <= 3; theta += 0.25) {
      const double step = 1e-5;
      const double slope =
          (hinge_energy(sine, theta + step) - hinge_energy(sine, theta - step)) / (2 * step);
      CHECK(hinge_moment(sine, theta, 0.0) == Approx(-slope).margin(1e-9));
      CHECK(hinge_energy(sine, theta) >= 0);
      // It never resists more than a hinge that answers to the angle itself.
      CHECK(std::abs(hinge_moment(sine, theta, 0.0)) <= std::abs(hinge_moment(angle, theta, 0.0)));
    }
  }
  sine.rest_angle = angle.rest_angle = 0;
  CHECK(hinge_moment(sine, 0.01, 0.0) == Approx(hinge_moment(angle, 0.01, 0.0)).epsilon(1e-5));
}

TEST_CASE("damping is the damping coefficient times the rate of the angle") {
  Hinge<double> hinge;
  hinge.damping = 0.3;
  const double step = 1e-6;
  const auto before = folded(0.5), after = folded(0.5 + step);
  const auto angle = hinge_angle(before[0], before[1], before[2], before[3]);
  double rate = 0;
  for (std::size_t a = 0; a < 4; ++a) rate += angle.gradient[a].dot(after[a] - before[a]) / step;
  CHECK(rate == Approx(1.0).epsilon(1e-5));
  CHECK(hinge_moment(hinge, 0.0, rate) == Approx(-0.3).epsilon(1e-5));
}

TEST_CASE(
    "a hinge without area or edge has no angle and no force, whatever the order of its corners") {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(2, 0, 0), d(0, 1, 0);
  const std::array<std::array<Vec3d, 4>, 4> degenerate = {
      {{a, b, c, d}, {a, a, b, d}, {a, b, d, c}, {a, a, a, a}}};
  for (const auto& x : degenerate) {
    const auto angle = hinge_angle(x[0], x[1], x[2], x[3]);
    CHECK(angle.theta == 0);
    for (const Vec3d& g : angle.gradient) CHECK(g.norm() == 0);
  }
}

TEST_CASE("a crumpled hinge keeps a bounded gradient that still adds up to nothing") {
  const double smallest = 0.01;
  for (const double height : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const Vec3d x0(0, 0, 0), x1(0, 1, 0), x2(-height, 0.4, 0), x3(0.5, 0.5, 0.1);
    const auto angle = hinge_angle(x0, x1, x2, x3, smallest);
    Vec3d sum = Vec3d::Zero(), moment = Vec3d::Zero();
    const Vec3d x[] = {x0, x1, x2, x3};
    for (std::size_t a = 0; a < 4; ++a) {
      CHECK(angle.gradient[a].norm() < 25);
      sum += angle.gradient[a];
      moment += x[a].cross(angle.gradient[a]);
    }
    CHECK(sum.norm() < 1e-12);
    CHECK(moment.norm() < 1e-12);
  }
}
