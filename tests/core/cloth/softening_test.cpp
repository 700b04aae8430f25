#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/scenes/scenes.h"
#include "tests/support/worlds.h"

// Cloth that is made softer while it moves, openly, for fewer substeps.

using namespace weft;

namespace {

WorldDef hanging(double stiffness) {
  WorldDef def = test::empty_world(test::flat_cloth(12, 15, 1.2, 0.9));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  FabricDef& fabric = def.cloths[0].fabric;
  fabric.stretch_warp = fabric.stretch_weft = 300 * stiffness;
  fabric.shear = 40 * stiffness;
  def.cloths[0].rest_angle = GENERATE(0.0, 0.1);
  def.pins = {{Corner::top_left, 0.1, {}}, {Corner::top_right, 0.1, {}}};
  return def;
}

}  // namespace

TEST_CASE("a cloth softened to a quarter moves bit for bit as one woven so, in half the substeps") {
  World<float> softened(hanging(1)), woven(hanging(0.25));
  const int full = softened.step().substeps;
  softened.reset();
  softened.set_softness(0.25);
  for (int tick = 0; tick < 60; ++tick) {
    softened.step();
    woven.step();
  }
  CHECK(softened.report().substeps == woven.report().substeps);
  CHECK(softened.report().substeps == Approx(0.5 * full).margin(1));
  CHECK(softened.state().x == woven.state().x);
  CHECK(softened.state().v == woven.state().v);
  CHECK(softened.report().energies.stretch == woven.report().energies.stretch);
}

TEST_CASE("softness 1 gives back the springs to the bit, and a reset does not") {
  World<float> world(hanging(1)), untouched(hanging(1));
  world.set_softness(0.07);
  world.reset();
  CHECK(world.softness() == 0.07);
  world.set_softness(1);
  for (int tick = 0; tick < 20; ++tick) {
    world.step();
    untouched.step();
  }
  CHECK(world.hash() == untouched.hash());
}

TEST_CASE("a cloth that hangs and is softened stretches in proportion, and nothing blows up") {
  WorldDef def = hanging(1);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.environment.damping = 5;
  World<double> world(def);
  const auto lowest = [&] {
    double y = 0;
    for (const Vec3d& x : world.state().x) y = std::min(y, x[1]);
    return y;
  };
  const double top = world.state().x[0][1];
  test::advance(world, 6);
  const double stretched = top - lowest() - 0.9;
  world.set_softness(0.5);
  test::advance(world, 6);
  CHECK(top - lowest() - 0.9 == Approx(2 * stretched).epsilon(0.02));
}

TEST_CASE("a softness outside 0.01 to 1 is refused by name and changes nothing") {
  World<float> world(make_scene("curtain"));
  for (const double wrong : {0.0, 0.009, 1.01, -1.0, std::nan("")}) {
    CHECK_THROWS_AS(world.set_softness(wrong), DefinitionError);
    CHECK(world.softness() == 1);
  }
}

TEST_CASE("a softness that would throw stretched cloth is refused, and smaller steps are not") {
  WorldDef def = hanging(1);
  def.environment.gravity = Vec3d(0, -50, 0);
  World<float> world(def);
  world.set_softness(0.01);
  for (int tick = 0; tick < 60; ++tick) world.step();
  // What is stretched alike has a hundred times the energy.
  REQUIRE(world.report().energies.stretch * 99 > 450 * 1.2 * 0.9 * FabricDef().areal_density);
  const std::uint64_t hash = world.hash();
  CHECK_THROWS_AS(world.set_softness(1), DefinitionError);
  CHECK(world.hash() == hash);
  for (double softness = 0.01; softness < 1; softness = std::min(softness * 1.2, 1.0)) {
    CHECK_NOTHROW(world.set_softness(softness));
    for (int tick = 0; tick < 10; ++tick) world.step();
  }
}
