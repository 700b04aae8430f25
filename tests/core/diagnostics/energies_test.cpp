#include "core/diagnostics/energies.h"

#include <limits>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

using namespace weft;

namespace {

constexpr double kHeight = 2;  // of the cloth above the origin [m]

World<double> raised_cloth(double gravity) {
  ClothDef cloth = test::flat_cloth(7, 9);
  cloth.origin = Vec3d(0, kHeight, 0);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -gravity, 0);
  return World<double>(def);
}

double mass_of(const World<double>& world) {
  double sum = 0;
  for (const double mass : world.model().mass) sum += mass;
  return sum;
}

}  // namespace

TEST_CASE("before the first tick the energies are m g h and nothing else (1e-12)") {
  const World<double> world = raised_cloth(9.81);
  const Energies& e = world.report().energies;
  CHECK(e.gravity == Approx(mass_of(world) * 9.81 * kHeight).epsilon(1e-12));
  CHECK(e.kinetic == 0);
  CHECK(e.stretch == Approx(0).margin(1e-12));
  CHECK(e.bending == Approx(0).margin(1e-12));
  CHECK(world.report().largest_strain == Approx(0).margin(1e-12));
}

TEST_CASE("other gravity between ticks shows at once, and a reset shows the start again") {
  World<double> world = raised_cloth(9.81);
  test::advance(world, 0.2);
  const Energies falling = world.report().energies;
  CHECK(falling.kinetic > 0);
  EnvironmentDef environment = world.environment();
  environment.gravity *= 0.5;
  world.set_environment(environment);
  CHECK(world.report().energies.gravity == Approx(falling.gravity / 2).epsilon(1e-12));
  CHECK(world.report().energies.kinetic == falling.kinetic);
  world.reset();
  CHECK(world.report().energies.kinetic == 0);
  CHECK(world.report().energies.gravity ==
        Approx(mass_of(world) * 9.81 / 2 * kHeight).epsilon(1e-12));
}

TEST_CASE("kinetic energy is half m v squared (1e-12), without what a pin stops") {
  World<double> world = raised_cloth(0);
  for (Vec3d& v : world.state().v) v = Vec3d(1, 2, 2);
  world.accept_state();
  const double all = mass_of(world) * 4.5;
  CHECK(world.report().energies.kinetic == Approx(all).epsilon(1e-12));
  world.pin({10, 0});
  CHECK(world.report().energies.kinetic ==
        Approx(all - 4.5 * world.model().mass[10]).epsilon(1e-12));
}

TEST_CASE(
    "what a pin and a new gravity leave as it was keeps its energy, and is not measured anew") {
  World<double> world = raised_cloth(9.81);
  world.pin({0, 0});
  test::advance(world, 0.5);
  const Energies before = world.report().energies;
  const double strain = world.report().largest_strain;
  REQUIRE(before.stretch > 0);
  REQUIRE(before.bending > 0);
  world.pin({10, 0});
  EnvironmentDef environment = world.environment();
  environment.gravity *= 0.5;
  world.set_environment(environment);
  const Energies& after = world.report().energies;
  // Summed again in another order, neither would come out the same to the bit.
  CHECK(after.stretch == before.stretch);
  CHECK(after.bending == before.bending);
  CHECK(world.report().largest_strain == strain);
  CHECK(after.kinetic < before.kinetic);
  CHECK(after.gravity == Approx(before.gravity / 2).epsilon(1e-12));
  const EnergyReading anew =
      read_energies<double>(world.model(), world.state(), environment.gravity);
  CHECK(after.stretch == Approx(anew.energies.stretch).epsilon(1e-9));
  CHECK(after.bending == Approx(anew.energies.bending).epsilon(1e-9));
  CHECK(strain == Approx(anew.largest_strain).epsilon(1e-9));
}

TEST_CASE("a sheet strained by e along the warp stores Y e^2 / 2 a square metre (1e-3 at e 1e-4)") {
  World<double> world = raised_cloth(0);
  const double strain = 1e-4;
  for (Vec3d& x : world.state().x) x[0] *= 1 + strain;
  world.accept_state();
  const double density = 0.5 * world.model().parts[0].fabric.stretch_warp * strain * strain;
  CHECK(world.report().energies.stretch == Approx(density).epsilon(1e-3));  // 1 m x 1 m
  CHECK(world.report().largest_strain == Approx(strain).epsilon(1e-6));
}

TEST_CASE(
    "after a tick that could not be saved the energies are those of the state that came back") {
  World<double> world = raised_cloth(9.81);
  test::advance(world, 0.2);
  const double before = world.report().energies.gravity;
  world.state().inverse_mass[20] = std::numeric_limits<double>::quiet_NaN();
  const TickReport& report = world.step();
  REQUIRE(report.divergence);
  REQUIRE(report.divergence->remedy == DivergenceRemedy::stopped_cloth);
  CHECK(report.energies.kinetic == 0);
  CHECK(report.energies.gravity == Approx(before).epsilon(1e-12));
  CHECK(report.largest_strain < 1e-6);
}
