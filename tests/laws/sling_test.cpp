#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A cloth that floats in vacuum without gravity.
WorldDef floating_cloth() {
  return test::empty_world(test::flat_cloth(9, 9));
}

GrabDef sling(const Vec3d& target) {
  GrabDef def;
  def.triangle = 60;
  def.radius = 0.2;
  def.stiffness = 5;
  def.target = target;
  def.mode = GrabMode::sling;
  return def;
}

}  // namespace

TEST_CASE("a sling that is fired gives the impulse that it states, to 1e-12, and then nothing") {
  World<double> world(floating_cloth());
  const GrabId hand = world.grab(sling(Vec3d(0.1, 0.5, -0.2)));
  const Vec3d pull = Vec3d(0.1, 0.5, -0.2) - held_point(world.grabs().list[0], world.state().x);
  const auto impulse = world.fire(hand);
  REQUIRE(impulse);
  CHECK((*impulse - pull * 5.0 * 0.1).norm() < 1e-12);
  for (int tick = 1; tick <= 6; ++tick) {
    CHECK(world.grabs().impulses.size() == 1);
    world.step();
    CHECK((test::momentum(world) - *impulse * (tick / 6.0)).norm() < 1e-12);
  }
  CHECK(idle(world.grabs()));
  test::advance(world, 0.5);
  CHECK((test::momentum(world) - *impulse).norm() < 1e-12);
}

TEST_CASE("a sling leaves the cloth alone as long as it is held, moved and let go unfired") {
  World<double> world(floating_cloth()), alone(floating_cloth());
  const GrabId hand = world.grab(sling(Vec3d(0, 2, 0)));
  test::advance(world, 0.2);
  REQUIRE(world.move_grab(hand, Vec3d(3, 0, 0)));
  test::advance(world, 0.2);
  CHECK(world.hash() != alone.hash());
  REQUIRE(world.release(hand));
  test::advance(world, 0.2);
  test::advance(alone, 0.6);
  CHECK(world.hash() == alone.hash());
}

TEST_CASE("the force of a sling has its limit") {
  World<double> world(floating_cloth());
  GrabDef def = sling(Vec3d(0, 100, 0));
  def.max_force = 3;
  const auto impulse = world.fire(world.grab(def));
  REQUIRE(impulse);
  CHECK(impulse->norm() == Approx(0.3).epsilon(1e-12));
}

TEST_CASE("a live hand cannot be fired, and fired slings count as hands until they are spent") {
  World<double> world(floating_cloth());
  GrabDef live = sling(Vec3d::Zero());
  live.mode = GrabMode::live;
  CHECK(!world.fire(world.grab(live)));
  CHECK(world.grabs().list.size() == 1);
  CHECK(!world.fire(99));
  live.mode = GrabMode::sling;
  for (std::size_t n = 1; n < kMostGrabs; ++n) REQUIRE(world.fire(world.grab(live)));
  CHECK_THROWS_AS(world.grab(live), DefinitionError);
  world.reset();
  CHECK(idle(world.grabs()));
}
