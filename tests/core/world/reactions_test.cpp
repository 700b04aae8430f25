#include "core/world/reactions.h"

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// What holds a cloth gets the opposite of what it gives.

using namespace weft;

namespace {

const Vec3d kGravity(0, -9.81, 0);

double mass_of(const World<double>& world) {
  double sum = 0;
  for (const double m : world.model().mass) sum += m;
  return sum;
}

/// Forces of pins on a cloth that falls around them, after some ticks.
std::vector<Vec3d> forces_of(const std::vector<PinDef>& pins) {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.environment.gravity = kGravity;
  def.pins = pins;
  World<double> world(def);
  world.measure_forces(true);
  test::advance(world, 0.2);
  std::vector<Vec3d> forces;
  for (const PinReaction& pin : world.reactions()->pins) forces.push_back(pin.force);
  REQUIRE(forces.size() == pins.size());
  return forces;
}

}  // namespace

TEST_CASE("in each tick objects get the momentum that gravity gave and the cloth has not") {
  // At few substeps the certificate holds particles that would leave their reach, and stops others.
  const auto [shape, substeps] = GENERATE(table<ShapeDef, int>({
      {BoxDef{Vec3d(0, -0.1, 0), Vec3d(0.1, 0.1, 0.1)}, 80},
      {BoxDef{Vec3d(0, -0.1, 0), Vec3d(0.1, 0.1, 0.1)}, 1},
      {SphereDef{Vec3d(0, -0.1, 0), 0.1}, 1},
      {CapsuleDef{Vec3d(-0.1, -0.1, 0), Vec3d(0.1, -0.1, 0.05), 0.1}, 1},
  }));
  ClothDef cloth = test::flat_cloth(9, 9, 0.4, 0.4);
  cloth.origin = Vec3d(-0.15, 0.01, -0.2);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = kGravity;
  def.colliders = {{"object", shape}, {"ground", PlaneDef{Vec3d(0, -0.1, 0), Vec3d::UnitY()}}};
  def.solver.min_substeps = substeps;
  World<double> world(def);
  world.measure_forces(true);
  Vec3d most = Vec3d::Zero();
  for (int tick = 0; tick < 40; ++tick) {
    const Vec3d before = test::momentum(world);
    REQUIRE_FALSE(world.step().divergence);
    const std::vector<Vec3d>& on = world.reactions()->colliders;
    const Vec3d left =
        before + kGravity * mass_of(world) * world.tick_seconds() - test::momentum(world);
    REQUIRE((on[0] + on[1] - left / world.tick_seconds()).norm() < 1e-12);
    for (int k = 0; k < 2; ++k) most[k] = std::max(most[k], -on[static_cast<std::size_t>(k)][1]);
  }
  CHECK(most[0] > 0.1);
  CHECK(most[1] > 0.1);
}

TEST_CASE("in each tick pins and hands give what momentum the cloth gains beside gravity") {
  const auto solver = GENERATE(as<std::string>(), "grid", "hinges", "swept", "guarded", "mesh",
                               "damped", "damped several times a tick");
  CAPTURE(solver);
  ClothDef cloth = test::flat_cloth(9, 9, 0.4, 0.4);
  if (solver == "mesh") cloth = test::triangle_sheet(test::Cut::irregular, 0.4, 0.4, 0.05, 0.5);
  if (solver == "hinges") cloth.bending_model = BendingModel::hinges;
  cloth.fabric.bending_damping = solver == "damped" ? 10 : 1e-4;
  if (solver == "damped several times a tick") {
    cloth = test::flat_cloth(13, 13, 0.3, 0.3);
    cloth.fabric.bending_damping = 1e-2;
    cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-4;
  }
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = kGravity;
  def.pins = {{Corner::top_left, 0.11, {}}, {Corner::bottom_right, 0.2, {}}};
  if (solver == "swept") def.solver.damping_sweeps = 2;
  if (solver == "guarded") def.contact.seed.self = SelfContact::guard;
  World<double> world(def);
  world.measure_forces(true);
  // A hand whose disc reaches onto pinned particles; it pulls cloth into a fold that touches, and
  // forces between cloths are not means over the tick.
  if (GENERATE(false, true) && solver != "guarded")
    world.grab({3, {0.2, 0.3, 0.5}, 0.12, 100, 50, Vec3d(0, 0.3, 0)});
  // Dashpots of a mesh see how far its strains have changed, which is a velocity but for the step.
  const double accuracy = solver == "mesh" ? 1e-3 : 1e-9;
  for (int tick = 0; tick < (solver == "guarded" ? 10 : 30); ++tick) {
    const Vec3d before = test::momentum(world);
    REQUIRE_FALSE(world.step().divergence);
    const Vec3d gained = (test::momentum(world) - before) / world.tick_seconds();
    Vec3d given = kGravity * mass_of(world);
    for (const PinReaction& pin : world.reactions()->pins) given += pin.force;
    for (const Grab<double>& grab : world.grabs().list) given += grab.told;
    REQUIRE((given - gained).norm() < accuracy * mass_of(world) * kGravity.norm());
  }
}

TEST_CASE("what implicit tells of pins carries a swinging cloth, to 2 % over a second") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.environment.gravity = kGravity;
  def.pins = {{Corner::top_left, 0.1, {}}};
  def.solver.kind = SolverKind::implicit;
  World<double> world(def);
  world.measure_forces(true);
  Vec3d given = Vec3d::Zero();
  constexpr int kTicks = 60;
  for (int tick = 0; tick < kTicks; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    given += world.reactions()->pins[0].force * world.tick_seconds();
  }
  const double weight = mass_of(world) * kGravity.norm(), seconds = kTicks * world.tick_seconds();
  const Vec3d gained = test::momentum(world) - kGravity * mass_of(world) * seconds;
  CHECK((given - gained).norm() < 0.02 * weight * seconds);
}

TEST_CASE("the pins of a stiff cable at rest tell its weight in each tick, to 1 %") {
  ClothDef cloth = test::flat_cloth(2, 41, 1, 0.02);
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 3e5;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = kGravity;
  def.environment.damping = 5;
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  World<float> world(def);
  test::advance(world, 4);
  world.measure_forces(true);
  double weight = 0;
  for (const float m : world.model().mass) weight += m * kGravity.norm();
  for (int tick = 0; tick < 30; ++tick) {
    world.step();
    const std::vector<PinReaction>& pins = world.reactions()->pins;
    REQUIRE(pins[0].force[1] + pins[1].force[1] == Approx(weight).epsilon(0.01));
  }
}

TEST_CASE(
    "mean velocities are displacements over a tick, and of a stiff strip at rest below 1 mm/s") {
  ClothDef cloth = test::flat_cloth(9, 41, 0.12, 0.02);
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 3e5;
  cloth.fabric.shear = 3e4;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 3.6e-4;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = kGravity;
  def.environment.damping = 5;
  def.pins = {{EdgeStrip{Side::left, 0.01}, 0, {}}};
  World<float> world(def);
  CHECK(world.mean_velocities() == world.state().v);  // no tick has passed
  test::advance(world, 4);
  for (int tick = 0; tick < 10; ++tick) {
    const Vec3Array<float> before = world.state().x;
    world.step();
    const Vec3Array<float> mean = world.mean_velocities();
    for (std::size_t i = 0; i < before.size(); ++i) {
      REQUIRE(mean[i] == (world.state().x[i] - before[i]) * 60.0F);
      REQUIRE(mean[i].norm() < 1e-3F);
    }
  }
  world.halt();
  CHECK(world.mean_velocities() == world.state().v);  // of its tick nothing is left
}

TEST_CASE("pins that hold the same particles share their force evenly, as if one held them") {
  const PinDef wide{Corner::top_left, 0.3, {}}, narrow{Corner::top_left, 0.13, {}};
  const Vec3d alone = forces_of({wide})[0];
  CHECK(alone.norm() > 0.1);
  for (const Vec3d& shared : forces_of({wide, wide})) CHECK(2 * shared == alone);
  const std::vector<Vec3d> unlike = forces_of({wide, narrow, narrow});
  CHECK(unlike[1] == unlike[2]);
  CHECK(unlike[1].norm() > 0.01);
  CHECK((unlike[0] + unlike[1] + unlike[2] - alone).norm() < 1e-12 * alone.norm());
}

TEST_CASE("what a tick measured is told until the next tick, though no more is wanted") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.environment.gravity = kGravity;
  def.pins = {{0, 0}};
  World<double> world(def);
  world.measure_forces(true);
  test::advance(world, 0.2);
  const Vec3d force = world.reactions()->pins[0].force;
  world.measure_forces(false);
  REQUIRE(world.reactions());
  world.measure_forces(true);
  world.measure_present_forces();
  CHECK(world.reactions()->pins[0].force == force);
  world.measure_forces(false);
  world.step();
  CHECK_FALSE(world.reactions());
  world.measure_forces(true);
  world.measure_present_forces();  // of the coming tick: the cloth swings
  CHECK((world.reactions()->pins[0].force - force).norm() > 1e-6 * force.norm());
}
