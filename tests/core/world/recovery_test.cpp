#include <algorithm>
#include <limits>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/support/worlds.h"

// What is left of a tick that was taken back.

using namespace weft;

namespace {

/// A cloth that lies on a ball and on itself.
WorldDef draped(SolverKind solver, int substeps) {
  ClothDef cloth = test::flat_cloth(17, 17);
  cloth.width = cloth.height = 0.6;
  cloth.origin = Vec3d(-0.3, 0.32, -0.3);
  cloth.v = Vec3d::UnitZ();
  WorldDef def = test::empty_world(cloth);
  def.contact.seed.self = SelfContact::automatic;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 2;
  def.colliders = {{"ball", SphereDef{Vec3d(0, 0.2, 0), 0.1}},
                   {"ground", PlaneDef{Vec3d::Zero(), Vec3d::UnitY()}}};
  def.solver.kind = solver;
  def.solver.min_substeps = def.relaxation.substeps = substeps;
  return def;
}

}  // namespace

TEST_CASE("a tick that is done again begins like that of a world put there, contact included") {
  const SolverKind solver = GENERATE(SolverKind::verlet, SolverKind::relaxation);
  World<float> world(draped(solver, 20));
  test::advance(world, 0.7);
  const Vec3Array<float> x = world.state().x, v = world.state().v;
  world.state().v[40][1] = std::numeric_limits<float>::quiet_NaN();
  world.step();
  REQUIRE(world.report().divergence);
  REQUIRE(world.report().divergence->cause == DivergenceCause::not_finite);
  REQUIRE(world.report().divergence->remedy == DivergenceRemedy::more_substeps);

  World<float> other(draped(solver, world.report().substeps));
  other.state().x = x;
  other.state().v = v;
  other.accept_state();
  for (int tick = 0; tick < 3; ++tick) {
    if (tick > 0) {  // the coming ticks of the first have its usual substeps again
      world.state().v[40][1] = std::numeric_limits<float>::quiet_NaN();
      world.step();
      other.accept_state();
    }
    other.step();
    REQUIRE(world.report().substeps == other.report().substeps);
    REQUIRE(world.state().x == other.state().x);
    REQUIRE(world.state().v == other.state().v);
  }
}

TEST_CASE("after a tick that was taken back the work of a moving pin is what the cloth gains") {
  // In vacuum, without damping. Another cloth flies past the farthest place in the middle of the
  // tick, so that the pin has driven its particles before the tick fails.
  WorldDef def = test::empty_world(test::flat_cloth(5, 5));
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "flying";
  for (ClothDef& cloth : def.cloths) cloth.fabric.damping_ratio = 0;
  def.pins = {{Corner::top_left, 0.3, {}}};
  def.solver.min_substeps = 160;  // the first tick jerks
  World<double> world(def);
  const Pin& pin = world.pins().list[0];
  const Vec3d here = world.state().x[static_cast<std::size_t>(pin.centre)];
  REQUIRE(world.move_pin(pin.id, {here + Vec3d(0, 10, 0), 5, 1000}));
  test::advance(world, 0.1);
  ClothState<double>& state = world.state();
  double right = 0;
  for (const Vec3d& x : state.x) right = std::max(right, x[0]);
  for (std::size_t i = state.x.size() / 2; i < state.x.size(); ++i) {
    state.x[i][0] += 999.5 - right;
    state.v[i] = Vec3d(90, 0, 0);
  }
  world.accept_state();
  world.step();
  REQUIRE(world.report().divergence);
  REQUIRE(world.report().divergence->cause == DivergenceCause::too_far);
  REQUIRE(world.report().divergence->remedy == DivergenceRemedy::stopped_cloth);
  for (int tick = 0; tick < 3; ++tick) {
    const double before = world.report().energies.total();
    world.step();
    REQUIRE(world.report().work > 0);
    CHECK(world.report().energies.total() - before == Approx(world.report().work).epsilon(0.02));
  }
}

TEST_CASE("under relaxation cloth that is drawn out a hundredfold contracts, and falls") {
  // However short a substep, its sweeps give back metres at once.
  WorldDef def = test::empty_world(test::flat_cloth(20, 20));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.sweeps = 10;
  def.relaxation.substeps = 8;
  def.relaxation.damping = 0;
  def.relaxation.compliance = GENERATE(0.0, 1.0);
  def.contact.seed.self = GENERATE(SelfContact::none, SelfContact::guard);
  CAPTURE(def.relaxation.compliance, def.contact.seed.self);
  // As pins leave cloth when they let go of it.
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -20, 0), Vec3d::UnitY()}}};
  World<float> world(def);
  world.state().x[0] += Vec3f(-4, 3, 0);
  world.accept_state();
  const Vec3d start = test::centre_of_mass(world);
  int taken_back = 0;
  constexpr int kTicks = 30;
  for (int tick = 0; tick < kTicks; ++tick) {
    const TickReport& report = world.step();
    if (!report.divergence) continue;
    ++taken_back;
    CHECK(report.divergence->remedy == DivergenceRemedy::more_substeps);
  }
  CHECK(taken_back > 0);
  CHECK(taken_back <= 5);
  CHECK(world.report().largest_strain < 1);
  const double time = kTicks * world.tick_seconds();
  const Vec3d moved = test::centre_of_mass(world) - start;
  CHECK(moved[1] == Approx(-9.81 * time * time / 2).epsilon(0.3));
  CHECK(Vec3d(moved[0], 0, moved[2]).norm() < 0.02);
}

TEST_CASE("cloth that was stopped is stepped more finely from tick to tick until it moves again") {
  // Gathered into a ball five times its size it has a million times its usual energy, and the air
  // damps it faster than any number of substeps that its shape at rest asks for.
  ClothDef cloth = test::flat_cloth(8, 8, 0.1, 0.1);
  cloth.fabric = make_fabric("silk");
  WorldDef def = test::empty_world(cloth);
  def.solver.kind = GENERATE(SolverKind::verlet, SolverKind::implicit);
  def.tick_rate = 30;
  def.environment.air_density = 1.2;
  def.environment.still_air = true;
  DisturbanceDef gathering;
  gathering.time = 2.0 / 30;
  gathering.gather = 0.5;
  def.disturbances = {gathering};
  World<float> world(def);
  world.measure_energy(true);
  int stopped = 0, failed_before = 0;
  double given = 0;
  for (int tick = 0; tick < 30; ++tick) {
    const TickReport& report = world.step();
    if (tick == 2) given = report.brought;
    const bool stops =
        report.divergence && report.divergence->remedy == DivergenceRemedy::stopped_cloth;
    if (stops) {
      CHECK(report.divergence->substeps > failed_before);
      failed_before = report.divergence->substeps;
    }
    stopped += stops ? 1 : 0;
  }
  REQUIRE(given > 1000);
  CHECK(stopped > 0);
  CHECK(stopped < 5);
  CHECK(world.report().energies.kinetic > 0);
  CHECK(world.report().energies.stretch < given / 1000);
  CHECK(world.energy_balance()->disturbances == Approx(given).epsilon(1e-6));
}
