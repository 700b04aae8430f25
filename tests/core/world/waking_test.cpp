#include <catch2/catch.hpp>

#include "core/diagnostics/crossings.h"
#include "core/error.h"
#include "tests/support/sleepers.h"
#include "tests/support/worlds.h"

using namespace weft;
using namespace weft::test;

TEST_CASE("a touch of 0.1 N wakes a cloth, and it moves as one that never slept, to 1 um") {
  WorldDef def = hanging({curtain("one", 0)});
  def.sleep.distance = 1e-7;
  World<double> slept(def);
  def.sleep.after = 0;
  World<double> awake(def);
  for (int tick = run_to_sleep(slept) + 60; tick > 0; --tick) awake.step();
  for (int tick = 0; tick < 60; ++tick) slept.step();
  REQUIRE(slept.tick() == awake.tick());
  REQUIRE(farthest_apart(slept, awake) < 1e-6);
  const Vec3Array<double> before = slept.state().x;
  const GrabDef grab = touch(slept, 150, 0.1);
  slept.grab(grab);
  awake.grab(grab);
  CHECK_FALSE(slept.sleep().any_asleep());
  for (int tick = 0; tick < 30; ++tick) {
    slept.step();
    awake.step();
    REQUIRE_FALSE(slept.report().rested);
    REQUIRE(farthest_apart(slept, awake) < 1e-6);
  }
  CHECK((slept.state().x[static_cast<std::size_t>(slept.model().triangles[150][0])] -
         before[static_cast<std::size_t>(slept.model().triangles[150][0])])
            .norm() > 0.01);
}

TEST_CASE("each command that acts on a cloth wakes it, and a refused one does not") {
  World<float> world(hanging({curtain("one", 0)}));
  const auto wakes = [&world](auto&& command) {
    if (run_to_sleep(world) < 0) return false;
    command();
    return !world.sleep().any_asleep() && !world.step().rested;
  };
  PinId pin = 0;
  CHECK(wakes([&] { world.release(world.grab(touch(world, 3, 0.1))); }));
  CHECK(wakes([&] { pin = world.pin({Index(140), 0.0, {}}); }));
  CHECK(wakes([&] {
    PinMove move;
    move.target = Vec3d(0.1, 0.9, 0.1);
    world.move_pin(pin, move);
  }));
  CHECK(wakes([&] { world.unpin(pin); }));
  CHECK(wakes([&] {
    EnvironmentDef environment = world.environment();
    environment.gravity *= 1.01;
    world.set_environment(environment);
  }));
  CHECK(wakes([&] { world.set_softness(0.9); }));
  CHECK(wakes([&] { world.reset(); }));
  CHECK_FALSE(wakes([&] {
    GrabDef grab;
    grab.triangle = -1;
    CHECK_THROWS_AS(world.grab(grab), DefinitionError);
    CHECK_FALSE(world.unpin(999));
    CHECK_FALSE(world.stop_pin(999));
    const PinId first = world.pins().list.front().id;
    CHECK_THROWS_AS(world.move_pin(first, {Vec3d(0, 2e4, 0)}), DefinitionError);
  }));
  // What is pinned stays so in sleep and beyond.
  GrabId hand = 0;
  CHECK(wakes([&] { hand = world.grab(touch(world, 3, 0.1)); }));
  const Vec3f held = world.state().x[0];
  for (int tick = 0; tick < 60; ++tick) world.step();
  CHECK(world.state().x[0] == held);
  world.release(hand);
  CHECK(wakes([&] { CHECK(world.unpin(world.pins().list.front().id)); }));
}

TEST_CASE("a ball that comes wakes what it will meet before it touches, and another does not") {
  WorldDef def = hanging({curtain("one", 0)});
  def.sleep.distance = 1e-4;
  ColliderDef ball{"ball", SphereDef{Vec3d(-1.5, 0.7, 0.25), 0.1}};
  ball.motion.keyframes = {{4, Vec3d::Zero()}, {5, Vec3d(1.5, 0, 0)}};
  ColliderDef other{"other", SphereDef{Vec3d(-1.5, 0.7, 2), 0.1}};
  other.motion.keyframes = {{2.5, Vec3d::Zero()}, {3.5, Vec3d(3, 0, 0)}};
  def.colliders = {ball, other};
  World<float> world(def);
  REQUIRE(run_to_sleep(world, 140) > 0);
  const auto gap = [&world] {
    double least = 1e9;
    const Vec3f centre = world.colliders()[0].pose.position.cast<float>();
    for (const Vec3f& p : world.state().x)
      least = std::min(least, static_cast<double>((p - centre).norm()) - 0.1);
    return least;
  };
  // The other one moves past, which is seen, while nothing of the cloth is computed.
  bool moved = false;
  while (world.report().time < 3.9) {
    const Vec3d before = world.colliders()[1].pose.position;
    world.step();
    const bool moves = world.colliders()[1].pose.position != before;
    moved |= moves;
    REQUIRE(world.report().rested != moves);
    REQUIRE(world.sleep().all_asleep());
  }
  CHECK(moved);
  CHECK(world.colliders()[1].pose.position.isApprox(Vec3d(1.5, 0.7, 2)));
  while (world.sleep().all_asleep() && world.report().time < 6) {
    REQUIRE(gap() > 0.02);
    world.step();
  }
  CHECK(gap() > 0.02);
  CHECK(gap() < 0.2);
  while (world.report().time < 5) {
    world.step();
    REQUIRE(world.deepest_penetration() == 0);
  }
  CHECK(gap() < 0.004 + 0.005);  // its thickness, and what a cell bridges of the ball
}

TEST_CASE("cloth whose support leaves wakes and follows it") {
  WorldDef def;
  def.cloths = {test::flat_cloth(10, 10, 0.3, 0.3)};
  def.cloths[0].origin = Vec3d(-0.15, 0.01, -0.15);
  def.environment.damping = 5;
  def.sleep = {1, 1e-4};
  ColliderDef table{"table", BoxDef{Vec3d(0, -0.1, 0), Vec3d(0.3, 0.1, 0.3)}};
  table.motion.keyframes = {{5, Vec3d::Zero()}, {6, Vec3d(0, -0.5, 0)}};
  def.colliders = {table};
  World<float> world(def);
  REQUIRE(run_to_sleep(world, 290) > 0);
  test::advance(world, 7 - world.report().time);
  CHECK(test::centre_of_mass(world)[1] < -0.45);
  CHECK(run_to_sleep(world) > 0);
}

TEST_CASE("a cloth that comes wakes its neighbour before they touch; they rest as one island") {
  ClothDef bed = test::flat_cloth(12, 12, 0.5, 0.5), sheet = test::flat_cloth(9, 9, 0.3, 0.3);
  bed.name = "bed";
  bed.origin = Vec3d(-0.25, 0, -0.25);
  sheet.name = "sheet";
  sheet.origin = Vec3d(-0.15, 0.6, -0.15);
  bed.fabric.thickness = sheet.fabric.thickness = 0.006;
  WorldDef def;
  def.cloths = {bed, sheet};
  for (const Side side : {Side::left, Side::right}) {
    PinDef pin;
    pin.place = EdgeStrip{side, 0.0};
    pin.cloth = "bed";
    def.pins.push_back(pin);
  }
  PinDef held;
  held.place = MaterialPoint{0.5, 0.5};
  held.radius = 1;
  held.cloth = "sheet";
  def.pins.push_back(held);
  def.environment.damping = 4;
  def.contact.seed.self = SelfContact::guard;
  def.sleep = {0.5, 1e-3};
  World<float> world(def);
  REQUIRE(run_to_sleep(world) > 0);
  CHECK(world.sleep().island_of(0) != world.sleep().island_of(1));
  world.unpin(world.pins().list.back().id);
  CHECK(world.sleep().is_asleep(0));
  const IndexRange own = world.model().parts[1].particles;
  const auto height = [&world, &own] {
    float lowest = 1e9F;
    for (Index i = own.first; i < own.end(); ++i)
      lowest = std::min(lowest, world.state().x[static_cast<std::size_t>(i)][1]);
    float highest = -1e9F;
    for (Index i = 0; i < own.first; ++i)
      highest = std::max(highest, world.state().x[static_cast<std::size_t>(i)][1]);
    return lowest - highest;
  };
  int alone = 0;
  for (; world.sleep().is_asleep(0) && alone < 100; ++alone) world.step();
  CHECK(alone > 10);
  CHECK(height() > 0.006F);
  Bvh<double> tree;
  while (!world.sleep().any_asleep() && world.report().time < 20) {
    world.step();
    const Crossings found =
        count_self_crossings(world.state().x, world.model().edges, world.model().triangles, tree);
    REQUIRE(found.proper + found.touching == 0);
  }
  REQUIRE(world.sleep().all_asleep());
  CHECK(world.sleep().island_of(1) == world.sleep().island_of(0));
  world.grab(touch(world, world.model().parts[1].triangles.first, 0.1));
  CHECK_FALSE(world.sleep().any_asleep());
}

TEST_CASE("a sleeper is awake before what comes is nearer than its thickness, at any speed") {
  const double speed = GENERATE(0.01, 0.1, 1.0);
  ClothDef sheet = curtain("one", 0);
  sheet.fabric.thickness = 0.02;
  WorldDef def = hanging({sheet});
  const double radius = 0.1;
  def.colliders = {{"ball", SphereDef{Vec3d(-0.5, 0.75, 0.25), radius}}};
  World<double> world(def);
  REQUIRE(run_to_sleep(world) > 0);
  MoveDef move;
  move.target.position = Vec3d(0.5, 0.75, 0.25);
  move.speed = speed;
  world.move_collider(0, move);
  double gap = 1;
  while (world.sleep().all_asleep() && gap > 0) {
    gap = 1;
    for (const Vec3d& x : world.state().x)
      gap = std::min(gap, (x - world.colliders()[0].pose.position).norm() - radius);
    world.step();
  }
  // As it was at the start of the tick in which it woke.
  CHECK(gap >= sheet.fabric.thickness);
}
