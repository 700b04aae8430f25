
#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/error.h"
#include "tests/support/sleepers.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

using namespace weft;
using namespace weft::test;

TEST_CASE(
    "a cloth that has hung still for a second sleeps: no work in any stage, and the same "
    "hash at each tick") {
  World<float> world(hanging({curtain("one", 0)}));
  REQUIRE(run_to_sleep(world) > 60);
  const std::uint64_t hash = world.hash();
  const Vec3Array<float> x = world.state().x;
  const Energies energies = world.report().energies;
  CHECK(energies.kinetic == 0);
  const std::uint64_t fell_asleep = world.tick();
  for (std::uint64_t tick = fell_asleep + 1; tick < fell_asleep + 200; ++tick) {
    const TickReport& report = world.step();
    REQUIRE(report.rested);
    REQUIRE(work_of(report) == 0);
    REQUIRE(report.work == 0);
    REQUIRE(report.tick == tick);
    REQUIRE(world.hash() == hash);
    REQUIRE(report.energies.total() == energies.total());
  }
  CHECK(world.state().x == x);
  for (const Vec3f& v : world.state().v) REQUIRE(v.isZero(0));
}

TEST_CASE("a cloth moves bit for bit as one that never sleeps until it does") {
  WorldDef def = hanging({curtain("one", 0)});
  World<float> world(def);
  def.sleep.after = 0;
  World<float> other(def);
  int ticks = 0;
  for (; !world.sleep().any_asleep() && ticks < 1500; ++ticks) {
    REQUIRE(world.hash() == other.hash());
    world.step();
    other.step();
  }
  CHECK(ticks < 1500);
  CHECK_FALSE(other.sleep().any_asleep());
}

TEST_CASE("a cloth that goes on moving does not sleep, and neither does one that creeps") {
  WorldDef def = hanging({curtain("one", 0)}, 0);
  def.cloths[0].v = Vec3d::UnitX();  // it swings down, and no damping stops it
  World<float> swinging(def);
  for (int tick = 0; tick < 300; ++tick) {
    swinging.step();
    REQUIRE_FALSE(swinging.sleep().any_asleep());
  }
  WorldDef free = test::empty_world(curtain("one", 0));
  free.sleep = {1, 1e-3};
  World<float> creeping(free);
  for (Vec3f& v : creeping.state().v) v = Vec3f(0.0011F, 0, 0);
  creeping.accept_state();
  for (int tick = 0; tick < 300; ++tick) {
    creeping.step();
    REQUIRE_FALSE(creeping.sleep().any_asleep());
  }
  for (Vec3f& v : creeping.state().v) v = Vec3f(0.0009F, 0, 0);
  creeping.accept_state();
  CHECK(run_to_sleep(creeping) == 60);
}

TEST_CASE("cloth sleeps in a steady wind and in still air, and never in gusts") {
  WorldDef def = hanging({curtain("one", 0)}, 20);
  def.environment.wind = Vec3d(0.5, 0, 0);
  World<float> steady(def);
  CHECK(run_to_sleep(steady) > 0);
  CHECK(steady.state().x.back()[0] > 0.001F);
  def.environment.gust_speed = 1e-4;  // too feeble to be seen, and still not rest
  def.sleep.distance = 1e-3;
  World<float> gusty(def);
  CHECK(run_to_sleep(gusty, 600) < 0);
  EnvironmentDef gusts = steady.environment();
  gusts.gust_speed = 0.5;
  steady.set_environment(gusts);
  const Vec3f before = steady.state().x.back();
  for (int tick = 0; tick < 60; ++tick) REQUIRE_FALSE(steady.step().rested);
  CHECK((steady.state().x.back() - before).norm() > 0.001F);
}

TEST_CASE("of two cloths apart one sleeps while the other swings, as beside one that does not") {
  ClothDef still = curtain("still", 0), swinging = curtain("swinging", 1.2);
  swinging.v = Vec3d(1, -1, 0).normalized();  // so that it does not touch itself
  WorldDef def = hanging({still, swinging}, 0.5);
  def.sleep.distance = 2e-3;
  World<float> world(def);
  def.sleep.after = 0;
  World<float> other(def);
  const IndexRange own = world.model().parts[1].particles;
  int asleep = 0;
  for (int tick = 0; tick < 480; ++tick) {
    world.step();
    other.step();
    REQUIRE_FALSE(world.sleep().is_asleep(1));
    REQUIRE(world.guard()->rows().empty());
    asleep += world.sleep().is_asleep(0) ? 1 : 0;
    for (Index i = own.first; i < own.end(); ++i)
      REQUIRE(world.state().x[static_cast<std::size_t>(i)] ==
              other.state().x[static_cast<std::size_t>(i)]);
  }
  CHECK(asleep > 120);
}

namespace {

/// A curtain of a preset that sleeps while it still trembles by up to a millimetre.
ClothDef trembling(const char* fabric, double x) {
  ClothDef cloth = curtain("trembling", x);
  cloth.fabric = make_fabric(fabric);
  return cloth;
}

double weight_of(const World<float>& world, std::size_t part) {
  const IndexRange& range = world.model().parts[part].particles;
  double mass = 0;
  for (Index i = range.first; i < range.end(); ++i)
    mass += static_cast<double>(world.model().mass[static_cast<std::size_t>(i)]);
  return mass * 9.81;
}

}  // namespace

TEST_CASE("the pins of sleeping cloth carry its weight, to 1 %, for as long as it sleeps") {
  const char* fabric = GENERATE("cotton", "silk", "wool", "denim", "leather", "nylon");
  CAPTURE(fabric);
  WorldDef def = hanging({trembling(fabric, 0)}, 1);
  def.sleep = {0.5, 1e-3};
  World<float> world(def);
  world.measure_forces(true);
  REQUIRE(run_to_sleep(world) > 0);
  for (int tick = 0; tick < 3; ++tick) {
    CHECK(world.reactions()->pins[0].force[1] == Approx(weight_of(world, 0)).epsilon(0.01));
    REQUIRE(world.step().rested);
  }
}

TEST_CASE("what is told of sleeping cloth stays while another swings, and ends as it wakes") {
  ClothDef swinging = curtain("swinging", 1.2);
  swinging.v = Vec3d(1, -1, 0).normalized();
  WorldDef def = hanging({trembling("denim", 0), swinging}, 0.5);
  def.sleep = {0.5, 1e-3};
  World<float> world(def);
  world.measure_forces(true);
  for (int tick = 0; tick < 600 && !world.sleep().is_asleep(0); ++tick) world.step();
  REQUIRE(world.sleep().is_asleep(0));
  const Vec3d told = world.reactions()->pins[0].force, other = world.reactions()->pins[1].force;
  CHECK(told[1] == Approx(weight_of(world, 0)).epsilon(0.01));
  for (int tick = 0; tick < 30; ++tick) {
    world.step();
    REQUIRE_FALSE(world.sleep().is_asleep(1));
    CHECK(world.reactions()->pins[0].force == told);
  }
  CHECK(world.reactions()->pins[1].force != other);
  world.grab(touch(world, world.model().parts[0].triangles.first, 1));
  world.step();
  REQUIRE_FALSE(world.sleep().is_asleep(0));
  CHECK(world.reactions()->pins[0].force != told);
}

TEST_CASE(
    "an object carries the weight of cloth that sleeps on it, beside one that swings, to 2 %") {
  ClothDef sheet = test::flat_cloth(10, 10, 0.3, 0.3), swinging = curtain("swinging", 1.2);
  sheet.name = "sheet";
  sheet.origin = Vec3d(-0.5, 0.01, 0);
  sheet.fabric.thickness = 0.004;
  swinging.v = Vec3d(1, -1, 0).normalized();
  WorldDef def = hanging({swinging}, 0.5);
  def.cloths.push_back(sheet);
  def.colliders = {{"ground", PlaneDef{}}};
  def.sleep = {0.5, 1e-3};
  World<float> world(def);
  world.measure_forces(true);
  for (int tick = 0; tick < 600 && !world.sleep().is_asleep(1); ++tick) world.step();
  REQUIRE(world.sleep().is_asleep(1));
  for (int tick = 0; tick < 30; ++tick) {
    CHECK(world.reactions()->colliders[0][1] == Approx(-weight_of(world, 1)).epsilon(0.02));
    world.step();
  }
}

TEST_CASE("a sleeping cloth costs nothing: all work is that of those who are awake") {
  std::vector<ClothDef> sheets = {test::flat_cloth(10, 10, 0.3, 0.3),
                                  test::flat_cloth(9, 12, 0.3, 0.3)};
  sheets[1].name = "second";
  sheets[0].origin = Vec3d(-0.5, 0.004, 0);
  sheets[1].origin = Vec3d(0.5, 0.004, 0);
  sheets[1].bending_model = GENERATE(BendingModel::automatic, BendingModel::hinges);
  for (ClothDef& sheet : sheets) sheet.fabric.thickness = 0.004;
  WorldDef def;
  def.environment.damping = 5;
  def.environment.wind = Vec3d(0.01, 0, 0);
  def.contact.seed.self = SelfContact::guard;
  def.solver.min_substeps = 40;  // more than either needs alone
  def.solver.damping_sweeps = GENERATE(1, 2);
  def.colliders = {{"ground", PlaneDef{}}};
  def.cloths = sheets;
  def.sleep = {0.5, 1e-3};
  World<float> both(def);
  REQUIRE(run_to_sleep(both) > 0);
  def.cloths = {sheets[1]};
  def.sleep.after = 0;
  World<float> alone(def);
  const Index first = both.model().parts[1].triangles.first;
  alone.step();
  both.grab(touch(both, first, 0.1));
  alone.grab(touch(alone, 0, 0.1));
  std::uint64_t searched = 0, searched_alone = 0;
  for (int tick = 0; tick < 30; ++tick) {
    const TickReport& report = both.step();
    REQUIRE(both.sleep().is_asleep(0));
    REQUIRE_FALSE(both.sleep().is_asleep(1));
    const TickReport& other = alone.step();
    REQUIRE(report.substeps == other.substeps);
    for (const Stage stage : {Stage::air, Stage::stretch, Stage::bending, Stage::integration})
      REQUIRE(report.profile[stage].work == other.profile[stage].work);
    for (const Stage stage :
         {Stage::broad_phase, Stage::pairs, Stage::narrow_phase, Stage::regions}) {
      searched += report.profile[stage].work;
      searched_alone += other.profile[stage].work;
    }
    for (const ContactRow<float>& row : both.contact().rows()) REQUIRE(row.particle[0] >= 100);
    for (const GuardedPair<float>& pair : both.guard()->pairs()) REQUIRE(pair.particle[0] >= 100);
  }
  REQUIRE(!both.contact().rows().empty());
  // The two do not move alike to the bit; looking at the sleeper too would double the work.
  CHECK(static_cast<double>(searched) < 1.5 * static_cast<double>(searched_alone));
  // The energies are those of all cloths.
  const EnergyReading all = read_energies(both.model(), both.state(), Vec3f(0, -9.81F, 0));
  CHECK(both.report().energies.total() == Approx(all.energies.total()).epsilon(1e-6));
  CHECK(both.report().energies.stretch == Approx(all.energies.stretch).epsilon(1e-4));
  // The first one still lies on the ground when it is woken.
  both.grab(touch(both, 0, 0.01));
  for (int tick = 0; tick < 30; ++tick) both.step();
  CHECK(both.deepest_penetration() == 0);
}

TEST_CASE("sleep is the same for any number of threads, and a replay repeats it") {
  test::TwoThreads executor;
  WorldDef def;
  def.cloths = {test::flat_cloth(10, 10, 0.3, 0.3)};
  def.cloths[0].origin = Vec3d(-0.15, 0.15, -0.15);
  def.environment.damping = 5;
  def.colliders = {{"ball", SphereDef{Vec3d::Zero(), 0.1}},
                   {"ground", PlaneDef{Vec3d(0, -0.1, 0)}}};
  def.sleep = {0.5, 1e-3};
  World<float> one(def), two(def, {&executor, nullptr});
  int slept = 0;
  for (int tick = 0; tick < 600; ++tick) {
    for (World<float>* world : {&one, &two}) {
      if (tick == 450) world->grab(touch(*world, 5, 0.1));
      world->step();
    }
    slept += one.report().rested ? 1 : 0;
    REQUIRE(one.hash() == two.hash());
  }
  CHECK(slept > 100);
  CHECK_FALSE(one.report().rested);
}

TEST_CASE("the pins of a sleeping cloth carry its weight, when asked and as measured") {
  World<double> world(hanging({curtain("one", 0)}));
  REQUIRE(run_to_sleep(world) > 0);
  double mass = 0;
  for (const double m : world.model().mass) mass += m;
  const auto carried = [](const Reactions& reactions) {
    Vec3d sum = Vec3d::Zero();
    for (const PinReaction& pin : reactions.pins) sum += pin.force;
    return sum[1];
  };
  CHECK(carried(world.coming_reactions()) == Approx(mass * 9.81).epsilon(1e-3));
  CHECK(world.sleep().all_asleep());
  world.measure_forces(true);
  world.step();
  REQUIRE(world.report().rested);
  REQUIRE(world.reactions());
  CHECK(world.reactions()->tick == world.tick());
  CHECK(carried(*world.reactions()) == Approx(mass * 9.81).epsilon(1e-3));
}

TEST_CASE("a textile test does not sleep: its measure is of what comes to rest by itself") {
  WorldDef def = hanging({curtain("one", 0)});
  def.test = TextileTest::drape;
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
  def.test = TextileTest::none;
  def.sleep.distance = 0;
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
}
