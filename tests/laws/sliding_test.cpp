#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// A whole cloth on a slope, by Coulomb's law: it sticks below the threshold tan = mu and slides
// above.

using namespace weft;

namespace {

constexpr double kGravity = 9.81, kFriction = 0.4;

/// A cloth that lies on a slope of the given tangent. The ground is level and gravity leans
/// instead, so that downhill is +x.
WorldDef cloth_on_ground(double tangent, double friction) {
  ClothDef cloth = test::flat_cloth(8, 10, 0.9, 0.7);
  cloth.fabric.friction = friction;
  cloth.origin = Vec3d(0, cloth.fabric.thickness, 0);
  WorldDef def = test::empty_world(cloth);
  const double angle = std::atan(tangent);
  def.environment.gravity = kGravity * Vec3d(std::sin(angle), -std::cos(angle), 0);
  def.colliders = {{"ground", PlaneDef{}}};
  return def;
}

template <class Real>
World<Real> cloth_on_slope(double tangent, double friction = kFriction) {
  return World<Real>(cloth_on_ground(tangent, friction));
}

/// A flat piece of ground of triangles smaller than the cloth's.
TriangleMesh level_mesh() {
  constexpr int kCells = 60;
  constexpr double kCell = 0.03;
  TriangleMesh mesh;
  for (int r = 0; r <= kCells; ++r) {
    for (int c = 0; c <= kCells; ++c)
      mesh.positions.push_back(Vec3d(c * kCell - 0.3, 0, r * kCell - 0.5));
  }
  for (int r = 0; r < kCells; ++r) {
    for (int c = 0; c < kCells; ++c) {
      const Index a = r * (kCells + 1) + c, b = a + kCells + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

template <class Real>
double largest_move(const World<Real>& world, const Vec3Array<Real>& from) {
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    largest = std::max(largest, static_cast<double>((world.state().x[i] - from[i]).norm()));
  return largest;
}

}  // namespace

TEMPLATE_TEST_CASE("a cloth on a slope 3 % below the friction threshold moves by less than 1e-5 m",
                   "", float, double) {
  World<TestType> world = cloth_on_slope<TestType>(0.97 * kFriction);
  const Vec3Array<TestType> start = world.state().x;
  test::advance(world, 2.0);
  CHECK(largest_move(world, start) < 1e-5);
  CHECK(world.deepest_penetration() <= FabricDef{}.thickness);
}

TEST_CASE("stiff cloth of small cells 3 % below the threshold creeps by less than 0.02 mm/s") {
  // A last bit of a place changes its bending force by as much as its weight.
  const double bending = GENERATE(0.1, 1.0);
  CAPTURE(bending);
  WorldDef def = cloth_on_ground(0.97 * kFriction, kFriction);
  ClothDef& cloth = def.cloths[0];
  cloth.rows = 13;
  cloth.columns = 21;
  cloth.width = 0.4;
  cloth.height = 0.25;
  cloth.origin = Vec3d(-0.2, cloth.fabric.thickness, -0.125);
  cloth.u = Vec3d(0.8, 0, 0.6);
  cloth.v = Vec3d(-0.6, 0, 0.8);
  cloth.fabric.areal_density = 0.2;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 4000;
  cloth.fabric.shear = 400;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = bending;
  World<float> world(def);
  test::advance(world, 0.2);
  const Vec3d start = test::centre_of_mass(world);
  test::advance(world, 0.5);
  CHECK((test::centre_of_mass(world) - start).norm() < 0.5 * 2e-5);
}

TEMPLATE_TEST_CASE("a cloth on a slope above the threshold slides with g (sin - mu cos), to 1 %",
                   "", float, double) {
  const double tangent = GENERATE(1.1 * kFriction, 2 * kFriction);
  World<TestType> world = cloth_on_slope<TestType>(tangent);
  const Vec3d start = test::centre_of_mass(world);
  test::advance(world, 1.0);
  const Vec3d moved = test::centre_of_mass(world) - start;
  const double angle = std::atan(tangent);
  const double acceleration = kGravity * (std::sin(angle) - kFriction * std::cos(angle));
  CHECK(moved[0] == Approx(acceleration / 2).epsilon(0.01));
  CHECK(std::abs(moved[1]) < 1e-4);
  CHECK(std::abs(moved[2]) < 1e-4);
}

TEMPLATE_TEST_CASE("at mu = 0.2 and 0.5 a cloth sticks 1 degree below atan(mu), slides 1 above", "",
                   float, double) {
  const double friction = GENERATE(0.2, 0.5);
  const double threshold = std::atan(friction), degree = std::atan(1.0) / 45;
  World<TestType> below = cloth_on_slope<TestType>(std::tan(threshold - degree), friction);
  const Vec3Array<TestType> start = below.state().x;
  test::advance(below, 2.0);
  CHECK(largest_move(below, start) < 1e-5);

  const double angle = threshold + degree;
  World<TestType> above = cloth_on_slope<TestType>(std::tan(angle), friction);
  const Vec3d before = test::centre_of_mass(above);
  test::advance(above, 2.0);
  const double acceleration = kGravity * (std::sin(angle) - friction * std::cos(angle));
  CHECK((test::centre_of_mass(above) - before)[0] == Approx(2 * acceleration).epsilon(0.01));
}

TEST_CASE("stiff cloth far from the origin sticks at 0.8 of the threshold, to 0.1 mm in 2 s") {
  const double far = GENERATE(0.9, 2.9, 5.9);
  CAPTURE(far);
  WorldDef def = cloth_on_ground(0.8 * kFriction, kFriction);
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 25;
  cloth.width = cloth.height = 0.2;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 1500;
  cloth.fabric.areal_density = 0.324;
  cloth.origin[0] = far;
  World<float> world(def);
  test::advance(world, 0.5);
  const Vec3Array<float> start = world.state().x;
  test::advance(world, 2);
  CHECK(largest_move(world, start) < 1e-4);
}

TEST_CASE("over a flat mesh a cloth slides 1 degree above atan(mu) as on a plane, to 10 %") {
  const double friction = GENERATE(0.0, 0.2, 0.5), side = GENERATE(-1.0, 1.0);
  const double angle = std::atan(friction) + side * std::atan(1.0) / 45;
  if (friction == 0 && side < 0) return;
  WorldDef def = cloth_on_ground(std::tan(angle), friction);
  def.colliders = {{"ground", MeshDef{level_mesh()}}};
  World<float> world(def);
  const Vec3d before = test::centre_of_mass(world);
  test::advance(world, 1);
  const double moved = (test::centre_of_mass(world) - before)[0];
  const double acceleration = kGravity * (std::sin(angle) - friction * std::cos(angle));
  if (side < 0)
    CHECK(std::abs(moved) < 1e-5);
  else
    CHECK(moved == Approx(acceleration / 2).epsilon(0.1));
}

namespace {

/// A cloth on another one of other cells, which is pinned as a whole.
WorldDef cloth_on_cloth(double angle, double friction) {
  WorldDef def = test::empty_world(test::flat_cloth(8, 10, 0.5, 0.4));
  def.cloths.push_back(test::flat_cloth(14, 25, 1.2, 0.7));
  for (ClothDef& cloth : def.cloths) {
    cloth.fabric.friction = friction;
    cloth.fabric.thickness = 0.004;
  }
  def.cloths[0].name = "upper";
  def.cloths[1].name = "lower";
  def.cloths[0].origin = Vec3d(0, 0.004, 0);
  def.cloths[1].origin = Vec3d(-0.11, 0, -0.13);
  def.pins = {{MaterialPoint{0.5, 0.5}, 10, "lower"}};
  def.contact.seed.self = SelfContact::guard;
  def.environment.gravity = kGravity * Vec3d(std::sin(angle), -std::cos(angle), 0);
  return def;
}

/// Mean place of the first cloth downhill [m].
double upper_cloth(const World<float>& world) {
  const IndexRange& range = world.model().parts[0].particles;
  double sum = 0;
  for (Index i = range.first; i < range.end(); ++i)
    sum += static_cast<double>(world.state().x[static_cast<std::size_t>(i)][0]);
  return sum / range.count;
}

}  // namespace

TEST_CASE("over another cloth a cloth slides 1 degree above atan(mu) as on a plane, to 10 %") {
  const double friction = GENERATE(0.0, 0.2, 0.5);
  const double angle = std::atan(friction) + std::atan(1.0) / 45;
  World<float> world(cloth_on_cloth(angle, friction));
  const double before = upper_cloth(world);
  test::advance(world, 1.5);
  const double acceleration = kGravity * (std::sin(angle) - friction * std::cos(angle));
  CHECK(upper_cloth(world) - before == Approx(acceleration * 1.5 * 1.5 / 2).epsilon(0.1));
}

TEST_CASE("over another cloth a cloth creeps 1 degree below atan(mu) by less than 0.6 mm in 3 s") {
  const double friction = GENERATE(0.2, 0.5);
  World<float> world(cloth_on_cloth(std::atan(friction) - std::atan(1.0) / 45, friction));
  const double before = upper_cloth(world);
  test::advance(world, 3);
  CHECK(std::abs(upper_cloth(world) - before) < 6e-4);
}

TEST_CASE(
    "over another cloth a cloth slides down 30 degrees as on a plane, to 0.5 %, and stays low") {
  const double friction = GENERATE(0.0, 0.2), turn = GENERATE(0.0, 0.4);
  const double angle = std::acos(-1.0) / 6, seconds = 0.4;
  WorldDef def = cloth_on_cloth(angle, friction);
  def.cloths[0].u = Vec3d(std::cos(turn), 0, std::sin(turn));
  def.cloths[0].v = Vec3d(-std::sin(turn), 0, std::cos(turn));
  World<float> world(def);
  const double before = upper_cloth(world);
  test::advance(world, seconds);
  const double acceleration = kGravity * (std::sin(angle) - friction * std::cos(angle));
  CHECK(upper_cloth(world) - before == Approx(acceleration * seconds * seconds / 2).epsilon(0.005));
  for (Index i = 0; i < world.model().parts[0].particles.end(); ++i)
    REQUIRE(world.state().x[static_cast<std::size_t>(i)][1] == Approx(0.004).epsilon(0.1));
}

TEST_CASE("layers on a pinned cloth hold at 0.8 mu, however dense the upper one is") {
  const double density = GENERATE(0.2, 1.0, 5.0), friction = 0.4;
  WorldDef def = cloth_on_cloth(std::atan(0.8 * friction), friction);
  def.cloths.push_back(def.cloths[0]);
  ClothDef& top = def.cloths[2];
  top.name = "top";
  top.width = top.height = 0.35;
  top.origin += Vec3d(0.02, 0.004, 0.02);
  top.fabric.areal_density = density;
  World<float> world(def);
  const IndexRange& range = world.model().parts[2].particles;
  const auto place = [&] {
    double sum = 0;
    for (Index i = range.first; i < range.end(); ++i)
      sum += static_cast<double>(world.state().x[static_cast<std::size_t>(i)][0]);
    return sum / range.count;
  };
  const double before = place();
  test::advance(world, 2);
  CHECK(std::abs(place() - before) < 1e-3);
}
