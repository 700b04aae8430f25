#include "core/world/script.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A cloth that hangs by its upper edge.
WorldDef hanging() {
  WorldDef def;
  def.cloths[0] = test::flat_cloth(6, 6);
  def.cloths[0].v = -Vec3d::UnitY();
  def.pins = {{EdgeStrip{Side::top, 0.0}, 0.0, {}}};
  return def;
}

std::string refused(const WorldDef& def) {
  try {
    validate(def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "nothing";
}

}  // namespace

TEST_CASE(
    "the winds of a scene blow one after the other from their ticks on, again after a reset") {
  WorldDef def = hanging();
  def.winds = {{0.1, Vec3d(0, 0, 60)}, {0.2, Vec3d(0, 0, -60)}, {0.3, Vec3d::Zero()}};
  World<float> world(def);
  for (int run = 0; run < 2; ++run) {
    CHECK(world.environment().wind.isZero(0));
    for (int tick = 1; tick <= 24; ++tick) {
      REQUIRE_FALSE(world.step().divergence);
      const double expected = tick <= 6 ? 0 : tick <= 12 ? 60 : tick <= 18 ? -60 : 0;
      CHECK(world.environment().wind[2] == expected);
      CHECK((world.report().profile[Stage::air].work > 0) == (expected != 0));
    }
    world.reset();
  }
}

TEST_CASE(
    "a disturbance gathers all that is free in a ball of its radius, and pins go as it says") {
  WorldDef def = hanging();
  DisturbanceDef disturbance;
  disturbance.gather = 1e-3;
  disturbance.pinned = Vec3d(0, 0, 10);
  disturbance.pin_speed = 15;
  def.disturbances = {disturbance};
  def.environment.gravity.setZero();
  def.cloths[0].fabric.stretch_warp = def.cloths[0].fabric.stretch_weft = 1e-3;
  def.cloths[0].fabric.shear = 1e-4;
  def.contact.seed.self = SelfContact::none;  // there is no room in a ball
  World<float> world(def);
  world.step();
  Vec3f low = Vec3f::Constant(9), high = Vec3f::Constant(-9);
  for (std::size_t i = 6; i < 36; ++i) {
    low = low.cwiseMin(world.state().x[i]);
    high = high.cwiseMax(world.state().x[i]);
  }
  CHECK((high - low).norm() < 4e-3f);
  for (int tick = 1; tick < 60; ++tick) world.step();
  CHECK(world.state().x[0][2] > 3);  // at 2 m/s it would be less than 2
}

TEST_CASE("winds and disturbances out of range are refused by name, and winds out of order") {
  WorldDef def = hanging();
  def.winds = {{1, Vec3d(0, 0, 101)}};
  CHECK(refused(def).starts_with("winds[0].wind"));
  def.winds = {{1, Vec3d::Zero()}, {1, Vec3d::Zero()}};
  CHECK(refused(def) == "winds[1].time");
  def.winds.assign(kMostWinds + 1, {});
  CHECK(refused(def) == "winds");
  def.winds.clear();
  def.disturbances.resize(1);
  def.disturbances[0].gather = 11;
  CHECK(refused(def) == "insults[0].gather");
  def.disturbances[0].gather = 0;
  def.disturbances[0].pin_speed = 21;
  CHECK(refused(def) == "insults[0].pin_speed");
}

TEST_CASE("pins that a scene leads on and on stop where commands may send them") {
  WorldDef def = hanging();
  def.cloths[0].origin = Vec3d(10, 0, 0);
  DisturbanceDef disturbance;
  disturbance.pinned = Vec3d(100, -100, 100);
  def.disturbances.assign(kMostDisturbances, disturbance);
  World<float> world(def);
  REQUIRE_NOTHROW(world.step());
  for (const Pin& pin : world.pins().list) {
    REQUIRE(pin.path);
    CHECK(pin.path->move.target.cwiseAbs().maxCoeff() <= kFarthestPinTarget);
    CHECK(pin.path->move.target.x() > 9900);
  }
}

TEST_CASE("a hand of the scene takes hold if it fits beside all others and sling impulses") {
  const std::size_t free = GENERATE(0u, 1u, 2u);
  WorldDef def = hanging();
  HandDef hand;
  hand.path = {{0.05, Vec3d::Zero()}, {1, Vec3d(0, 0, 0.1)}};
  def.hands = {hand, hand};
  World<float> world(def);
  GrabDef sling;
  sling.mode = GrabMode::sling;
  sling.target = Vec3d(0, 0, 0.1);
  REQUIRE(world.fire(world.grab(sling)));
  for (std::size_t k = 0; k + 1 + free < kMostGrabs; ++k) world.grab(GrabDef{});
  while (world.report().time < 0.06) REQUIRE_NOTHROW(world.step());
  REQUIRE(world.grabs().impulses.size() == 1);
  CHECK(world.grabs().list.size() == kMostGrabs - 1);
}

TEST_CASE("at the end of each tick a hand of the scene is where its path is then") {
  WorldDef def = hanging();
  HandDef hand;
  hand.path = {{0.05, Vec3d::Zero()}, {0.25, Vec3d(0, 0.1, 0.2)}, {0.3, Vec3d(0, 0.1, 0.2)}};
  def.hands = {hand};
  World<double> world(def);
  Vec3d start = Vec3d::Zero();
  int holding = 0;
  for (int tick = 0; tick < 25; ++tick) {
    const Vec3Array<double> before = world.state().x;
    world.step();
    if (world.grabs().list.empty()) continue;
    const Grab<double>& grab = world.grabs().list[0];
    if (holding++ == 0) start = held_point(grab, before);
    const double gone = std::min(world.report().time - 0.05, 0.2);  // at 1 m/s along z
    CHECK((grab.target - start - Vec3d(0, gone / 2, gone)).norm() < 1e-12);
  }
  CHECK(holding == 16);  // from 0.05 s on, until the tick after 0.3 s
}

TEST_CASE("what a disturbance gives the cloth stands in the balance, and nothing else is missing") {
  WorldDef def = test::empty_world(test::flat_cloth(6, 6));
  def.cloths[0].v = -Vec3d::UnitY();
  def.cloths[0].fabric.damping_ratio = 0;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.min_substeps = 40;
  DisturbanceDef disturbance;
  disturbance.time = 0.1;
  disturbance.noise = 2;
  def.disturbances = {DisturbanceDef{}, disturbance};
  World<double> world(def);
  world.measure_energy(true);
  test::advance(world, 0.1);
  CHECK(world.energy_balance()->disturbances == 0);
  double given = 0;
  for (std::size_t i = 0; i < world.state().v.size(); ++i) {
    const Vec3d v = world.state().v[i];
    const Vec3d more = 2 * Vec3d(noise_at(1, i, 0), noise_at(1, i, 1), noise_at(1, i, 2));
    given += world.model().mass[i] * ((v + more).squaredNorm() - v.squaredNorm()) / 2;
  }
  test::advance(world, 0.1);
  CHECK(given > 0.1);
  CHECK(world.energy_balance()->disturbances == Approx(given).epsilon(1e-9));
  CHECK(std::abs(world.energy_balance()->lost()) < 0.01 * given);
}
