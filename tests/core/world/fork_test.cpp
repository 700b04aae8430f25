#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/sleepers.h"
#include "tests/support/worlds.h"

// Forks of a world in motion.

using namespace weft;

namespace {

void step(World<float>& world, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) world.step();
}

/// What a viewer does to a cloth: pulls, changes the wind, pins, lets go.
void command(World<float>& world, int tick) {
  const auto middle = static_cast<Index>(world.model().triangles.size() / 2);
  if (tick == 5) {
    GrabDef def;
    def.triangle = middle;
    def.barycentric = {0.2, 0.3, 0.5};
    def.target = world.state().x[0].cast<double>() + Vec3d(0.05, 0.1, 0.05);
    world.grab(def);
  }
  if (tick == 15 && !world.grabs().list.empty())
    world.move_grab(world.grabs().list.back().id, Vec3d(0.1, 1.2, 0.1));
  if (tick == 20) {
    EnvironmentDef environment = world.environment();
    environment.wind = Vec3d(1, 0, 2);
    environment.gust_speed = 0.5;
    environment.air_density = 1.2;
    world.set_environment(environment);
  }
  if (tick == 25)
    world.pin({world.model().triangles[static_cast<std::size_t>(middle)][0], 0.02, {}});
  if (tick == 30 && !world.grabs().list.empty()) world.release(world.grabs().list.back().id);
}

void require_same(const World<float>& a, const World<float>& b) {
  REQUIRE(a.tick() == b.tick());
  REQUIRE(a.state().x == b.state().x);
  REQUIRE(a.state().v == b.state().v);
  REQUIRE(a.hash() == b.hash());
}

/// Steps a world, its fork, and a world that was never forked, with the same commands.
void compare(const WorldDef& def, int before, int after) {
  World<float> world(def), untouched(def);
  step(world, before);
  step(untouched, before);
  const auto fork = world.fork();
  require_same(*fork, world);
  for (int tick = 0; tick < after; ++tick) {
    for (World<float>* each : {&world, fork.get(), &untouched}) {
      command(*each, tick);
      each->step();
    }
    CAPTURE(tick);
    require_same(*fork, world);
    require_same(world, untouched);
  }
  CHECK(fork->report().energies.total() == world.report().energies.total());
  CHECK(fork->report().substeps == world.report().substeps);
}

/// A cloth that swings from its upper border against a ball, and onto itself.
WorldDef swinging(SolverKind solver, bool seed = false) {
  WorldDef def;
  def.cloths = {test::flat_cloth(11, 11, 0.5, 0.5)};
  def.cloths[0].origin = Vec3d(0, 1, 0);
  def.cloths[0].bending_model = BendingModel::hinges;
  def.solver.kind = solver;
  def.pins = {{EdgeStrip{Side::top, 0.06}, 0, "cloth"}};
  def.colliders = {{"ball", SphereDef{Vec3d(0.25, 0.75, 0.3), 0.15}}};
  if (seed) def.contact.model = ContactModel::seed;
  return def;
}

}  // namespace

TEST_CASE(
    "a fork has the future of its world bit for bit, with the same commands, in every solver") {
  const auto solver = GENERATE(SolverKind::verlet, SolverKind::implicit, SolverKind::relaxation);
  const bool seed = GENERATE(false, true);
  CAPTURE(static_cast<int>(solver), seed);
  compare(swinging(solver, seed), 40, 60);
}

TEST_CASE("a fork of a moment in contact, of moving objects and of a grip has its world's future") {
  const char* const scene = GENERATE("table", "gripper");
  CAPTURE(scene);
  compare(make_scene(scene), 20, 35);
}

TEST_CASE("300 ticks of a fork and its world are the same in curtain, table, gripper, hard-stack",
          "[.long]") {
  const char* const scene = GENERATE("curtain", "table", "gripper", "hard-stack");
  CAPTURE(scene);
  compare(make_scene(scene), 60, 300);
}

TEST_CASE("a fork lives on when its world is gone, and neither moves the other") {
  auto world = std::make_unique<World<float>>(make_scene("gripper"));
  step(*world, 20);
  auto fork = world->fork();
  const std::uint64_t hash = world->hash();
  step(*fork, 10);
  CHECK(world->hash() == hash);
  World<float> untouched(make_scene("gripper"));
  step(untouched, 30);
  CHECK(fork->hash() == untouched.hash());
  world.reset();
  step(*fork, 10);
  step(untouched, 10);
  CHECK(fork->hash() == untouched.hash());
}

TEST_CASE("a fork sleeps as its world does, and wakes alone") {
  World<float> world(test::hanging({test::curtain("one", 0)}));
  REQUIRE(test::run_to_sleep(world) > 0);
  REQUIRE(world.sleep().all_asleep());
  const auto fork = world.fork();
  CHECK(fork->step().rested);
  EnvironmentDef windy = fork->environment();
  windy.wind = Vec3d(0, 0, 3);
  fork->set_environment(windy);
  CHECK_FALSE(fork->step().rested);
  CHECK(world.step().rested);
}

TEST_CASE("a fork goes on balancing energy, and a reset takes it to its world's start") {
  World<float> world(swinging(SolverKind::verlet));
  world.measure_energy(true);
  step(world, 30);
  const auto fork = world.fork();
  REQUIRE(fork->energy_balance() != nullptr);
  step(world, 20);
  step(*fork, 20);
  CHECK(fork->energy_balance()->lost() == world.energy_balance()->lost());
  world.reset();
  fork->reset();
  CHECK(fork->hash() == world.hash());
}
