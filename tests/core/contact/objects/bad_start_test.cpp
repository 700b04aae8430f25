#include <numbers>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/world/crossing_counter.h"
#include "core/world/world.h"
#include "tests/support/cylinders.h"

// Cloth that starts inside objects: named, led out whole, and the guarantee is back.

using namespace weft;

namespace {

WorldDef sheet_through(const ShapeDef& shape, double height) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.name = "sheet";
  cloth.rows = cloth.columns = 21;
  cloth.width = cloth.height = 0.6;
  cloth.origin = Vec3d(-0.3, height, -0.3);
  cloth.v = Vec3d::UnitZ();
  def.colliders = {{"ground", PlaneDef{}}, {"thing", shape}};
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

/// A conical tube of cotton about a cylinder: its top is outside, its bottom up to 7 mm inside.
WorldDef tube_in_cylinder(const Vec3d& velocity, const Vec3d& spin) {
  constexpr double kSeconds = 1.5;
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.mesh = ClothMesh{test::tube(0.143, 0.155, 48, 9, 0.3, 0.6), {}};
  cloth.fabric = make_fabric("cotton");
  def.environment.gravity.setZero();
  def.environment.damping = 2;
  def.contact.seed.self = SelfContact::guard;
  ColliderDef cylinder{"cylinder", MeshDef{test::closed_cylinder(0.15, 0.7, 64, 2)}};
  const double turn = (spin * kSeconds).norm();
  const Vec3d axis = turn > 0 ? spin.normalized() : Vec3d(Vec3d::UnitY());
  cylinder.motion.keyframes = {
      {}, {kSeconds, velocity * kSeconds, Eigen::Quaterniond(Eigen::AngleAxisd(turn, axis))}};
  def.colliders = {cylinder};
  return def;
}

}  // namespace

TEST_CASE("a sheet that starts halfway through a solid is out of it within 2 s, little strained") {
  const ShapeDef shape =
      GENERATE(ShapeDef(SphereDef{Vec3d(0, 0.5, 0), 0.12}),
               ShapeDef(CapsuleDef{Vec3d(-0.1, 0.5, 0), Vec3d(0.1, 0.5, 0), 0.08}),
               ShapeDef(BoxDef{Vec3d(0, 0.5, 0), Vec3d(0.1, 0.08, 0.12)}));
  const bool is_box = std::holds_alternative<BoxDef>(shape);
  const double height = is_box ? 0.5 : GENERATE(0.5, 0.53, 0.47);
  CAPTURE(shape.index(), height);
  World<float> world(sheet_through(shape, height));
  world.step();
  REQUIRE(world.bad_starts().size() == 1);
  CHECK(world.bad_starts()[0] == "sheet started inside thing");
  double largest_strain = 0;
  for (int k = 1; k < 120; ++k) {
    REQUIRE_FALSE(world.step().divergence);
    largest_strain = std::max(largest_strain, world.report().largest_strain);
  }
  CHECK(world.deepest_penetration() == 0);
  CHECK(world.bad_starts().empty());
  CHECK(largest_strain < 1);
  for (int k = 0; k < 60; ++k) {
    world.step();
    CHECK(world.deepest_penetration() == 0);
  }
}

TEST_CASE(
    "a sheet that starts with its border in a narrower box is led off its edges and corners") {
  // The strip inside is 2 or 5 cm deep; cells of 4, 2 and 1 cm hang over the box's edges.
  const int particles = GENERATE(11, 21, 41);
  const double in = GENERATE(0.02, 0.05);
  CAPTURE(particles, in);
  WorldDef def = sheet_through(BoxDef{Vec3d(0.35 - in, 0.43, 0), Vec3d(0.15, 0.1, 0.1)}, 0.5);
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = particles;
  cloth.width = cloth.height = 0.4;
  cloth.origin = Vec3d(-0.2, 0.5, -0.2);
  World<float> world(def);
  world.step();
  REQUIRE(world.bad_starts().size() == 1);
  for (int k = 1; k < 60; ++k) REQUIRE_FALSE(world.step().divergence);
  CHECK(world.bad_starts().empty());
  CrossingCounter<float> counter;
  for (int k = 0; k < 60; ++k) {
    world.step();
    CHECK(counter.count(world).total() == 0);
  }
}

TEST_CASE(
    "cloth that starts less than its thickness inside facets, or cuts ridges alone, comes out") {
  constexpr double kRadius = 0.1985;
  const bool fine = GENERATE(true, false), all_inside = GENERATE(true, false);
  CAPTURE(fine, all_inside);
  const double radius = all_inside ? kRadius - 0.0015 : kRadius + 0.00005;
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.mesh =
      ClothMesh{test::rolled(radius, std::numbers::pi / 3, all_inside ? 24 : 9, 7, 0.95, 1.2), {}};
  cloth.fabric = make_fabric("cotton");
  cloth.fabric.thickness = 0.003;
  def.environment.gravity.setZero();
  def.colliders = {{"cylinder", MeshDef{fine ? test::closed_cylinder(kRadius, 2, 64, 60)
                                             : test::closed_cylinder(kRadius, 2, 128, 2)}}};
  World<float> world(def);
  REQUIRE(world.deepest_penetration() > 1e-4);
  CrossingCounter<float> counter;
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    if (tick < 6) continue;
    REQUIRE(counter.count(world).total() == 0);
    CHECK(world.deepest_penetration() <= 0);
  }
}

TEST_CASE("a tube that starts partly inside a cylinder is led out of it, moving, as at rest") {
  struct Way {
    const char* name;
    Vec3d velocity, spin;  // [m/s], [rad/s]
  };
  const Vec3d none = Vec3d::Zero();
  const double degree = std::numbers::pi / 180;
  const auto way = GENERATE_COPY(
      values<Way>({{"rests", none, none},
                   {"turns slowly", none, Vec3d(0, 2 * degree, 0)},
                   {"turns", none, Vec3d(0, 90 * degree, 0)},
                   {"tilts", none, Vec3d(0, 0, 20 * degree)},
                   {"rises", Vec3d(0, 0.001, 0), none},
                   {"goes", Vec3d(0.1, 0, 0), none},
                   {"turns and rises", Vec3d(0, 0.05, 0), Vec3d(0, 20 * degree, 0)}}));
  CAPTURE(way.name);
  World<float> world(tube_in_cylinder(way.velocity, way.spin));
  CrossingCounter<float> counter;
  world.step();
  REQUIRE(world.bad_starts().size() == 1);
  double largest_strain = 0;
  int blocked = 0;
  for (int tick = 1; tick < 80; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    largest_strain = std::max(largest_strain, world.report().largest_strain);
    blocked += world.colliders()[0].blocked ? 1 : 0;
    if (tick >= 60) CHECK(counter.count(world).total() == 0);
  }
  CHECK(world.bad_starts().empty());
  CHECK(world.deepest_penetration() == 0);
  CHECK(largest_strain < 0.1);
  CHECK(blocked < 8);  // of 79 ticks
}

TEST_CASE("a sheet that starts beside an object is not called a bad start") {
  World<float> world(sheet_through(SphereDef{Vec3d(0, 0.5, 0), 0.12}, 0.63));
  for (int k = 0; k < 60; ++k) {
    world.step();
    CHECK(world.bad_starts().empty());
  }
}

TEST_CASE(
    "a sheet pinned beside the edge of a box, nearer than its thickness, is lifted and rests") {
  const double gap = GENERATE(0.0005, 0.001, 0.002);
  const char* const fabric = GENERATE("denim", "silk");
  CAPTURE(gap, fabric);
  WorldDef def;
  set_field(def, "fabric", fabric);
  ClothDef& sheet = def.cloths[0];
  sheet.rows = sheet.columns = 15;
  sheet.width = sheet.height = 0.4;
  sheet.u = Vec3d::UnitX();
  sheet.v = Vec3d::UnitZ();
  sheet.origin = Vec3d(0.16, 0.3 + gap, -0.2);
  sheet.fabric.thickness = 0.004;
  def.environment.damping = 2;
  def.colliders = {{"table", BoxDef{Vec3d(0, 0.15, 0), Vec3d(0.5, 0.15, 0.5)}}};
  def.pins = {{Index(193), 0.05, {}}};
  World<float> world(def);
  for (int k = 0; k < 240; ++k) REQUIRE_FALSE(world.step().divergence);
  CHECK(world.report().largest_strain < 0.1);
  CHECK(world.state().x[0][1] == Approx(0.304F).margin(2e-4));
  CHECK(world.deepest_penetration() <= sheet.fabric.thickness);
}
