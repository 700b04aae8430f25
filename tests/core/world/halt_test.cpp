// A tick that is ended from outside leaves what a tick that did not begin leaves.

#include <memory>
#include <string>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/stop_signal.h"
#include "core/world/world.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// Small scenes in which, together, everything takes part that a tick can change.
WorldDef scene_of(const std::string& name) {
  WorldDef def = make_scene(name);
  for (ClothDef& cloth : def.cloths) {
    if (cloth.rows > 15 && !cloth.mesh) cloth.rows = cloth.columns = 15;
  }
  return def;
}

/// A world after some ticks, with a hand and a new pin on their way.
std::unique_ptr<World<float>> world_at(const WorldDef& def, int ticks,
                                       Executor* executor = nullptr) {
  auto world = std::make_unique<World<float>>(def, Runtime{executor, nullptr});
  for (int n = 0; n < ticks; ++n) world->step();
  GrabDef hand;
  hand.triangle = 7;
  hand.target = world->state().x[3].cast<double>() + Vec3d(0.1, 0.2, 0.05);
  world->grab(hand);
  const PinId pin = world->pin({5, 0.02, {}});
  PinMove move;
  move.target = world->state().x[5].cast<double>() + Vec3d(0, 0.05, 0);
  world->move_pin(pin, move);
  return world;
}

/// Steps once and ends the tick at its stop point number `stop`; never if that is negative. The
/// hash of the state before the tick is known there, or at each stop point.
/// @returns whether it was ended before it was done
bool step_and_stop(World<float>& world, int stop) {
  StopSignal signal;
  int seen = 0;
  const std::uint64_t before = world.hash();
  signal.attend = [&] {
    const bool ends = seen++ == stop;
    if (ends || stop < 0) CHECK(world.hash_before_tick() == before);
    return ends;
  };
  signal.raise();
  const StopScope scope(&signal);
  return world.step().halted;
}

/// @param stride  between the stop points; 0: ever longer
void check_scene(const WorldDef& def, int ticks, Executor* executor, int stride = 0) {
  const auto start = world_at(def, ticks, executor);
  const auto halted = start->fork();
  const std::uint64_t before = halted->hash();
  const TickReport report = halted->halt();
  CHECK(report.halted);
  CHECK(halted->hash() == before);
  for (int n = 0; n < 3; ++n) halted->step();

  int stops = 0;
  for (int stop = 0;; stop += stride > 0 ? stride : 1 + stop / 2) {
    INFO("stop point " << stop);
    const auto stopped = start->fork();
    if (!step_and_stop(*stopped, stop)) break;
    ++stops;
    REQUIRE(stopped->hash() == before);
    CHECK(stopped->report().tick == static_cast<std::uint64_t>(ticks));
    for (int n = 0; n < 3; ++n) CHECK_FALSE(stopped->step().halted);
    REQUIRE(stopped->hash() == halted->hash());
  }
  CHECK(stops > 2);
}

}  // namespace

TEST_CASE("a tick ended at any point leaves what a tick not begun leaves, with every solver") {
  const auto [name, ticks] = GENERATE(table<std::string, int>(
      {{"drape-sphere", 25}, {"gripper", 20}, {"hard-far-teleport", 30}, {"flag", 5}}));
  const SolverKind kind =
      GENERATE(SolverKind::verlet, SolverKind::implicit, SolverKind::relaxation);
  INFO(name << " with solver " << static_cast<int>(kind));
  WorldDef def = scene_of(name);
  def.solver.kind = kind;
  if (kind == SolverKind::relaxation) def.relaxation.compliance = 1, def.relaxation.substeps = 20;
  check_scene(def, ticks, nullptr);
}

TEST_CASE("a tick of cloth that presses on cloth, ended at any point, leaves nothing behind") {
  test::TwoThreads threads;
  const bool threaded = GENERATE(false, true);
  CAPTURE(threaded);
  WorldDef def = scene_of("hard-stack");
  def.cloths.resize(2);
  for (ClothDef& cloth : def.cloths) cloth.rows = cloth.columns = 9;
  check_scene(def, 40, threaded ? &threads : nullptr, 41);
}

TEST_CASE("a tick of two threads ended at any point leaves what a tick not begun leaves") {
  test::TwoThreads threads;
  check_scene(scene_of("drape-sphere"), 25, &threads);
}

TEST_CASE("a tick of the seed's contact ended at any point leaves what a tick not begun leaves") {
  WorldDef def = scene_of("drape-sphere");
  def.model = Model::seed;
  def.contact.seed.self = SelfContact::triangles_and_edges;
  check_scene(def, 20, nullptr);
}

TEST_CASE(
    "a tick in which the scene's wind changes, ended at any point, leaves the wind before it") {
  WorldDef def = scene_of("flag");
  def.winds = {{0, Vec3d(3, 0, 1)}, {5.0 / 60, Vec3d(-7, 1, 0)}};
  check_scene(def, 5, nullptr);
  const auto world = world_at(def, 5);
  REQUIRE(step_and_stop(*world, 0));
  CHECK(world->environment().wind == def.winds[0].wind);
  CHECK_FALSE(step_and_stop(*world, -1));
  CHECK(world->environment().wind == def.winds[1].wind);
}

TEST_CASE("within a tick of changing wind and sleeping cloth the hash before it is known") {
  WorldDef def = scene_of("flag");
  def.winds = {{0, def.environment.wind}, {0.1, Vec3d(7, 1, 0)}};
  def.sleep.after = 0.05;
  def.sleep.distance = 1;
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "far";
  def.cloths[1].origin += Vec3d(50, 0, 0);
  def.environment.gust_speed = 0;
  def.environment.fans.clear();
  const auto world = world_at(def, 4);
  bool slept = false;
  for (int n = 0; n < 12; ++n) {
    CHECK_FALSE(step_and_stop(*world, -1));
    slept = slept || world->sleep().is_asleep(1);
  }
  CHECK(slept);
}

TEST_CASE("a world whose every tick is ended stays where it is") {
  const auto world = world_at(scene_of("drape-sphere"), 10);
  const std::uint64_t before = world->hash();
  for (int stop = 0; stop < 20; ++stop) {
    if (!step_and_stop(*world, stop)) break;
    CHECK(world->hash() == before);
  }
}

TEST_CASE("a look ahead that is ended throws and changes nothing") {
  const auto world = world_at(scene_of("drape-sphere"), 25);
  const std::uint64_t before = world->hash();
  StopSignal signal;
  signal.raise();
  {
    const StopScope scope(&signal);
    CHECK_THROWS_AS(world->coming_reactions(), Stopped);
    CHECK_THROWS_AS(world->coming_bad_starts(), Stopped);
  }
  CHECK(world->hash() == before);
  CHECK_NOTHROW(world->coming_reactions());
}

TEST_CASE("a signal that is lowered, or whose owner declines, ends nothing") {
  const WorldDef def = scene_of("drape-sphere");
  const auto alone = world_at(def, 20), watched = world_at(def, 20);
  alone->step();
  StopSignal signal;
  int asked = 0;
  signal.attend = [&] {
    ++asked;
    return false;
  };
  signal.raise();
  {
    const StopScope scope(&signal);
    CHECK_FALSE(watched->step().halted);
    CHECK(asked > 0);
    signal.lower();
    asked = 0;
    watched->step();
    alone->step();
    CHECK(asked == 0);
  }
  CHECK(watched->hash() == alone->hash());
}
