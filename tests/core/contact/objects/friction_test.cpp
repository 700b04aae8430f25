#include <cmath>

#include <catch2/catch.hpp>

#include "core/contact/objects/contact.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"

// Resting, sliding and stopping as Coulomb's law has it.

using namespace weft;
using test::Particles;

namespace {

constexpr double kGravity = 9.81, kThickness = 0.004;

/// A slope by the angle whose tangent is given, rising along -x, through the origin: as a plane and
/// as the upper face of a box.
struct Slope {
  Vec3d normal, down;
  explicit Slope(double tangent) {
    const double angle = std::atan(tangent);
    normal = Vec3d(std::sin(angle), std::cos(angle), 0);
    down = Vec3d(std::cos(angle), -std::sin(angle), 0);
  }
  std::vector<ShapeDef> shapes() const {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), normal);
    return {PlaneDef{Vec3d::Zero(), normal}, BoxDef{-0.1 * normal, Vec3d(20, 0.1, 20), turn}};
  }
};

/// A particle laid on a slope with a velocity.
template <class Real>
Particles<Real> on_slope(const Slope& slope, const Vec3d& velocity) {
  Particles<Real> one;
  one.substeps = 20;
  one.add(slope.normal * kThickness, velocity);
  return one;
}

template <class Real>
void advance(Particles<Real>& particles, Contact<Real>& contact, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) particles.step(contact);
}

template <class Real>
void check_sticks(double tolerance) {
  for (const double friction : {0.2, 0.4, 1.0}) {
    const Slope slope(0.9 * friction);
    for (const ShapeDef& shape : slope.shapes()) {
      Particles<Real> one = on_slope<Real>(slope, Vec3d::Zero());
      Contact<Real> contact = one.meet({kThickness, friction, 0}, {{"slope", shape}});
      advance(one, contact, 5);
      const Vec3d start = one.position(0);
      advance(one, contact, 180);
      INFO("friction " << friction << " shape " << shape.index());
      CHECK((one.position(0) - start).norm() <= tolerance);
      CHECK(one.velocity(0).norm() <= tolerance);
    }
  }
}

template <class Real>
void check_slides() {
  for (const double friction : {0.0, 0.2, 0.4}) {
    const Slope slope(1.1 * friction + 0.1);
    const double angle = std::atan(1.1 * friction + 0.1);
    const double wanted = kGravity * (std::sin(angle) - friction * std::cos(angle));
    for (const ShapeDef& shape : slope.shapes()) {
      Particles<Real> one = on_slope<Real>(slope, Vec3d::Zero());
      Contact<Real> contact = one.meet({kThickness, friction, 0}, {{"slope", shape}});
      advance(one, contact, 120);
      INFO("friction " << friction << " shape " << shape.index());
      CHECK(one.velocity(0).dot(slope.down) == Approx(2 * wanted).epsilon(0.01));
      CHECK(one.position(0).dot(slope.normal) == Approx(kThickness).margin(5e-5));
    }
  }
}

template <class Real>
void check_stops() {
  for (const double friction : {0.1, 0.4}) {
    const Slope level(0);
    for (const ShapeDef& shape : level.shapes()) {
      const double speed = 1.5;
      Particles<Real> one = on_slope<Real>(level, Vec3d(speed * 0.8, 0, speed * 0.6));
      Contact<Real> contact = one.meet({kThickness, friction, 0}, {{"floor", shape}});
      advance(one, contact, 120);
      INFO("friction " << friction << " shape " << shape.index());
      CHECK(one.velocity(0).norm() == 0);
      const Vec3d gone(one.position(0)[0], 0, one.position(0)[2]);
      CHECK(gone.norm() == Approx(speed * speed / (2 * friction * kGravity)).epsilon(0.01));
      CHECK(gone[2] / gone[0] == Approx(0.75).epsilon(1e-3));
    }
  }
}

}  // namespace

TEST_CASE("a particle sticks to a slope below the angle of friction, without any creep in 3 s") {
  SECTION("double") {
    check_sticks<double>(0);
  }
  SECTION("float") {
    check_sticks<float>(0);
  }
}

TEST_CASE("above the angle of friction it slides with g (sin - mu cos), 1 %") {
  SECTION("double") {
    check_slides<double>();
  }
  SECTION("float") {
    check_slides<float>();
  }
}

TEST_CASE("a sliding particle stops after v^2 / (2 mu g), 1 %, on a straight line") {
  SECTION("double") {
    check_stops<double>();
  }
  SECTION("float") {
    check_stops<float>();
  }
}

TEST_CASE("a particle that fell rests at the thickness, within 1 %, and is still") {
  const TriangleMesh floor = test::plate(0.5, 0.05);
  for (const ShapeDef& shape :
       std::vector<ShapeDef>{PlaneDef{}, MeshDef{floor}, SphereDef{Vec3d(0, -0.3, 0), 0.3},
                             CapsuleDef{Vec3d(-1, -0.1, 0), Vec3d(1, -0.1, 0), 0.1}}) {
    for (const double thickness : {0.002, 0.01}) {
      Particles<float> one;
      one.add(Vec3d(0, 0.1, 0));
      Contact<float> contact = one.meet({thickness, 0.4, 0}, {{"floor", shape}});
      advance(one, contact, 60);
      INFO("shape " << shape.index() << " thickness " << thickness);
      CHECK(one.position(0)[1] == Approx(thickness).epsilon(0.011));
      CHECK(one.velocity(0).norm() < 1e-5);  // rounding of the gap in float, over a substep
    }
  }
}

TEST_CASE("an impact returns the part of the normal velocity that dissipation leaves, 2 %") {
  for (const double restitution : {0.0, 0.5, 0.9}) {
    Particles<double> one;
    one.gravity.setZero();
    one.add(Vec3d(0, 0.1, 0), Vec3d(0.5, -2, 0));
    Contact<double> contact = one.meet({kThickness, 0, restitution}, {{"floor", PlaneDef{}}});
    advance(one, contact, 30);
    INFO("restitution " << restitution);
    CHECK(one.velocity(0)[1] == Approx(2 * restitution).epsilon(0.02).margin(1e-12));
    CHECK(one.velocity(0)[0] == Approx(0.5).epsilon(1e-12));
  }
}

TEST_CASE("contact adds no energy to particles, edges and triangles thrown at a solid") {
  const TriangleMesh box = box_mesh(Vec3d(0.1, 0.1, 0.1));
  for (const double restitution : {0.0, 0.6}) {
    Particles<double> cloth;
    cloth.gravity.setZero();
    cloth.substeps = 60;
    for (int k = 0; k < 6; ++k) {
      const double shift = 0.06 * k - 0.16;
      const Index a = cloth.add(Vec3d(shift, 0.15, 0.09), Vec3d(0.3, -2, 0.1)),
                  b = cloth.add(Vec3d(shift + 0.05, 0.16, 0.12), Vec3d(0, -1, -1)),
                  c = cloth.add(Vec3d(shift, 0.14, 0.15), Vec3d(0.2, -1.5, -0.5));
      // Without springs: what is left is contact alone.
      cloth.add_triangle(a, b, c, 0);
    }
    Contact<double> contact = cloth.meet({kThickness, 0.3, restitution}, {{"box", MeshDef{box}}});
    double before = cloth.kinetic_energy();
    const double start = before;
    for (int tick = 0; tick < 30; ++tick) {
      cloth.step(contact, [&](const ClothState<double>&) {
        const double now = cloth.kinetic_energy();
        CHECK(now <= before * (1 + 1e-12));
        before = now;
      });
    }
    CHECK(before < 0.9 * start);  // something was hit
  }
}

TEST_CASE("pushing out lifts without giving velocity") {
  Particles<double> one;
  one.gravity.setZero();
  one.add(Vec3d(0, 0.001, 0));
  Contact<double> contact = one.meet({kThickness, 0.4, 0}, {{"floor", PlaneDef{}}});
  double fastest = 0;
  for (int tick = 0; tick < 60; ++tick)
    one.step(contact, [&](const ClothState<double>&) {
      fastest = std::max(fastest, one.velocity(0).norm());
    });
  CHECK(fastest == 0);
  CHECK(one.position(0)[1] == Approx(kThickness).epsilon(0.011));
}
