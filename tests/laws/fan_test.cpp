#include "core/forces/air/fan.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A stiff flat cloth of 0.2 m in the plane z = 0 around the origin, with nothing but air around
/// it.
WorldDef patch() {
  ClothDef cloth = test::flat_cloth(5, 5, 0.2, 0.2);
  cloth.origin = Vec3d(-0.1, -0.1, 0);
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.air_density = 1.225;
  return def;
}

Vec3d momentum_after_a_tick(const WorldDef& def) {
  World<double> world(def);
  world.step();
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < world.state().v.size(); ++i)
    sum += world.state().v[i] * world.model().mass[i];
  return sum;
}

FanDef fan_before_patch() {
  FanDef fan;
  fan.position = Vec3d(0, 0, 1);
  fan.direction = Vec3d(0, 0, -2);
  fan.speed = 4;
  fan.radius = 0.3;
  return fan;
}

}  // namespace

TEST_CASE("in the core of a fan the air pushes a patch as uniform wind does, to 1e-12") {
  WorldDef uniform = patch(), blown = patch();
  uniform.environment.wind = Vec3d(0, 0, -4);
  blown.environment.fans = {fan_before_patch()};
  const Vec3d expected = momentum_after_a_tick(uniform);
  CHECK(expected.norm() > 1e-3);
  CHECK((momentum_after_a_tick(blown) - expected).norm() < 1e-12);
}

TEST_CASE(
    "a panel that hangs in the core of a fan tilts as in uniform wind of that speed, to 1e-9 m") {
  const auto tilted = [](bool by_fan) {
    ClothDef cloth = test::flat_cloth(7, 7, 0.3, 0.3);
    cloth.origin = Vec3d(-0.15, 0.15, 0);
    cloth.u = Vec3d::UnitX();
    cloth.v = -Vec3d::UnitY();
    WorldDef def = test::empty_world(cloth);
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.environment.air_density = 1.225;
    def.environment.damping = 4;
    if (by_fan) {
      FanDef fan = fan_before_patch();
      fan.radius = 1;
      fan.reach = 5;
      def.environment.fans = {fan};
    } else {
      def.environment.wind = Vec3d(0, 0, -4);
    }
    World<double> world(def);
    for (Index i = 0; i < 7; ++i) world.pin({i, 0});
    for (int tick = 0; tick < 240; ++tick) world.step();
    return world.state().x;
  };
  const Vec3Array<double> uniform = tilted(false), blown = tilted(true);
  CHECK(uniform.back()[2] < -0.03);  // it does tilt
  for (std::size_t i = 0; i < uniform.size(); ++i) CHECK((uniform[i] - blown[i]).norm() < 1e-9);
}

TEST_CASE("winds of several fans add up") {
  WorldDef uniform = patch(), blown = patch();
  uniform.environment.wind = Vec3d(0, 0, -5);
  blown.environment.wind = Vec3d(0, 0, -1);
  blown.environment.fans = {fan_before_patch(), fan_before_patch()};
  for (FanDef& fan : blown.environment.fans) fan.speed = 2;
  CHECK((momentum_after_a_tick(blown) - momentum_after_a_tick(uniform)).norm() < 1e-12);
}

TEST_CASE("outside of its jet and behind its disc a fan changes no bit of the cloth") {
  const auto hash_after_a_tick = [](const WorldDef& def) {
    World<double> world(def);
    world.step();
    return world.hash();
  };
  WorldDef calm = patch();
  calm.environment.still_air = true;
  for (const Vec3d& position : {Vec3d(0.85, 0, 1), Vec3d(0, -0.85, 1), Vec3d(0, 0, -0.01)}) {
    WorldDef def = patch();
    FanDef fan = fan_before_patch();
    fan.position = position;  // at a distance of 1 m the jet is 0.5 m wide
    def.environment.fans = {fan};
    CHECK(hash_after_a_tick(def) == hash_after_a_tick(calm));
    def.environment.fans[0].position = Vec3d(0, 0, 1);
    CHECK(hash_after_a_tick(def) != hash_after_a_tick(calm));
  }
}

TEST_CASE("the air of a fan is continuous and slows down by 1 / distance beyond its reach") {
  const FanDef def = fan_before_patch();
  const FanJet<double> jet(def);
  const auto on_axis = [&](double s) { return -jet(Vec3d(0, 0, 1 - s))[2]; };
  CHECK(on_axis(def.reach) == Approx(4).epsilon(1e-12));
  CHECK(on_axis(2 * def.reach) == Approx(2).epsilon(1e-12));
  CHECK(on_axis(5 * def.reach) == Approx(0.8).epsilon(1e-12));
  for (double t = 0; t < 1; t += 1e-4) {
    const Vec3d across(2 * t, 0, 0.3), along(0.1, 0, 1 - 2 * t);
    const Vec3d step(1e-4, 0, 0), back(0, 0, 1e-4);
    CHECK((jet(across + step) - jet(across)).norm() < 0.03);
    CHECK((jet(along + back) - jet(along)).norm() < 0.03);
  }
}

TEST_CASE("a fan that is off costs nothing and changes no bit") {
  WorldDef calm = patch(), off = patch();
  off.environment.fans = {fan_before_patch()};
  off.environment.fans[0].speed = 0;
  calm.environment.wind = off.environment.wind = Vec3d(0, 1, 0);
  World<float> a(calm), b(off);
  for (int tick = 0; tick < 30; ++tick) {
    CHECK(a.step().profile[Stage::fans].work == 0);
    CHECK(b.step().profile[Stage::fans].work == 0);
  }
  CHECK(a.hash() == b.hash());
  off.environment.fans[0].speed = 3;
  World<float> on(off);
  CHECK(on.step().profile[Stage::fans].work == 25);
}

TEST_CASE("wrong fans are refused by the name of their field") {
  WorldDef def = patch();
  const auto refused = [&def] {
    try {
      World<float> world(def);
    } catch (const DefinitionError& error) {
      return error.field;
    }
    return std::string();
  };
  def.environment.fans.assign(5, fan_before_patch());
  CHECK(refused() == "environment.fans");
  def.environment.fans.resize(2);
  CHECK(refused().empty());
  def.environment.fans[1].speed = 51;
  CHECK(refused() == "environment.fans[1].speed");
  def.environment.fans[1] = fan_before_patch();
  def.environment.fans[0].direction = Vec3d::Zero();
  CHECK(refused() == "environment.fans[0].direction");
}
