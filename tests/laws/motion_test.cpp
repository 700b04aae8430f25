#include <catch2/catch.hpp>

#include "tests/laws/reference_5x5.h"
#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::SeededRandom;

namespace {

struct Momenta {
  Vec3d linear = Vec3d::Zero(), angular = Vec3d::Zero();
  double scale = 0, angular_scale = 0;
};

Momenta momenta(const World<double>& world) {
  Momenta sum;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const Vec3d p = world.state().v[i] * world.model().mass[i];
    const Vec3d l = world.state().x[i].cross(p);
    sum.linear += p;
    sum.angular += l;
    sum.scale += p.norm();
    sum.angular_scale += l.norm();
  }
  return sum;
}

WorldDef reference_world() {
  ClothDef cloth = test::flat_cloth(5, 5);
  cloth.mass_lumping = MassLumping::equal;
  cloth.direct_springs = DirectSprings{200, 50, 10, 0.02};
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 0.5;
  def.pins = {{0, 0}, {4, 0}};
  return def;
}

double largest_error(const World<double>& world, const test::ReferenceInstant& reference) {
  double error = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    const Vec3d expected(reference.x[i][0], reference.x[i][1], reference.x[i][2]);
    error = std::max(error, (world.state().x[i] - expected).norm());
  }
  return error;
}

}  // namespace

TEMPLATE_TEST_CASE("free fall in vacuum is g t^2 / 2", "", float, double) {
  WorldDef def = test::empty_world(test::flat_cloth(6, 7));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  World<TestType> world(def);
  const double start = test::centre_of_mass(world)[1];
  test::advance(world, 1.0);
  // Velocity and position are exact for a constant force; what is left is rounding.
  const double tolerance = sizeof(TestType) == 4 ? 1e-4 : 1e-10;
  CHECK(start - test::centre_of_mass(world)[1] == Approx(4.905).margin(tolerance));
  for (const auto& v : world.state().v)
    CHECK(static_cast<double>(v[1]) == Approx(-9.81).margin(10 * tolerance));
}

TEST_CASE(
    "under XPBD and the seed's relaxation free fall is g t^2 / 2, first order in the substep") {
  const double compliance = GENERATE(1.0, 0.0);
  const auto fallen = [&](int substeps) {
    WorldDef def = test::empty_world(test::flat_cloth(6, 7));
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.cloths[0].fabric.damping_ratio = 0;
    def.solver.kind = SolverKind::relaxation;
    def.relaxation.compliance = compliance;
    def.relaxation.substeps = substeps;
    def.relaxation.sweeps = 2;
    def.relaxation.damping = 0;
    World<double> world(def);
    const double start = test::centre_of_mass(world)[1];
    test::advance(world, 1.0);
    return start - test::centre_of_mass(world)[1];
  };
  // n steps of length h = t / n fall g t^2 / 2 (1 + 1 / n): the velocity is raised before the
  // drift.
  for (const int substeps : {1, 10})
    CHECK(fallen(substeps) == Approx(4.905 * (1 + 1 / (60.0 * substeps))).margin(1e-9));
}

TEST_CASE(
    "with linear damping c the fall is (g/c) t - (g/c^2)(1 - exp(-c t)), second order in dt") {
  // Reference: drag.linear.c2_t1 of the expected values: v = 4.241180435724415, x
  // = 2.784409782137793.
  const auto error_with = [](int substeps) {
    WorldDef def = test::empty_world(test::flat_cloth(3, 3));
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.environment.damping = 2;
    def.solver.min_substeps = substeps;
    World<double> world(def);
    const double start = test::centre_of_mass(world)[1];
    test::advance(world, 1.0);
    return std::abs(start - test::centre_of_mass(world)[1] - 2.784409782137793);
  };
  const double coarse = error_with(10), fine = error_with(20);
  CHECK(fine < 1e-6);
  CHECK(coarse / fine == Approx(4).epsilon(0.05));
}

TEST_CASE("a plate falling flat through still air reaches vt tanh(g t / vt), to 0.1 %") {
  // vt = sqrt(2 sigma g / (rho C)); sigma 0.2, rho 1.225, C 1.28: vt = 1.5819453278821503 m/s.
  ClothDef plate = test::flat_cloth(8, 8);
  plate.fabric.bending_warp = plate.fabric.bending_weft = 1;  // stiff as cardboard, it stays flat
  WorldDef def = test::empty_world(plate);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.air_density = 1.225;
  def.environment.still_air = true;
  def.solver.damping_sweeps = 2;  // the air sees the velocity of its own instant
  World<double> world(def);
  const double start = test::centre_of_mass(world)[1];
  test::advance(world, 0.5);
  // x_t0p5 = 0.614665957991099
  CHECK(start - test::centre_of_mass(world)[1] == Approx(0.614665957991099).epsilon(1e-3));
  test::advance(world, 2.5);
  double momentum = 0, mass = 0;
  for (std::size_t i = 0; i < world.state().v.size(); ++i) {
    momentum -= world.state().v[i][1] * world.model().mass[i];
    mass += world.model().mass[i];
  }
  CHECK(momentum / mass == Approx(1.5819453278821503).epsilon(1e-3));
}

TEST_CASE("without outer forces momentum and angular momentum are kept to 1e-12") {
  ClothDef cloth = test::flat_cloth(7, 6, 1, 0.8);
  const auto [bending, damping] =
      GENERATE(table<BendingModel, double>({{BendingModel::hinges, 0.01},
                                            {BendingModel::quadratic, 0.01},
                                            {BendingModel::quadratic, 10}}));
  cloth.bending_model = bending;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-3;
  cloth.fabric.bending_damping = damping;
  World<double> world(test::empty_world(cloth));
  SeededRandom random(21);
  for (Vec3d& v : world.state().v) v = random.vector(2);
  world.accept_state();
  const Momenta before = momenta(world);
  test::advance(world, 2.0);
  const Momenta after = momenta(world);
  CHECK((after.linear - before.linear).norm() < 1e-12 * before.scale);
  CHECK((after.angular - before.angular).norm() < 1e-12 * before.angular_scale);
  CHECK(world.report().energies.kinetic + world.report().energies.stretch < 100);
}

TEST_CASE("the 5 x 5 reference is met to 1e-6 m at all its times") {
  WorldDef def = reference_world();
  def.tick_rate = 20;  // all its times are multiples of 1/20 s
  def.solver.min_substeps = 1500;
  def.solver.damping_sweeps = 3;
  World<double> world(def);
  for (const test::ReferenceInstant& instant : test::kReference5x5) {
    test::advance(world, instant.time - world.report().time);
    REQUIRE(world.report().time == Approx(instant.time).epsilon(1e-12));
    CHECK(largest_error(world, instant) < 1e-6);
  }
}

TEST_CASE("halving the substep quarters the error with two damping sweeps and halves it with one") {
  const auto error_with = [](int substeps, int sweeps) {
    WorldDef def = reference_world();
    def.tick_rate = 20;
    def.solver.min_substeps = substeps;
    def.solver.damping_sweeps = sweeps;
    World<double> world(def);
    test::advance(world, 0.5);
    return largest_error(world, test::kReference5x5[2]);
  };
  CHECK(error_with(40, 2) / error_with(80, 2) == Approx(4).epsilon(0.03));
  CHECK(error_with(40, 1) / error_with(80, 1) == Approx(2).epsilon(0.05));
}

TEST_CASE("halving the tick quarters the error with two damping sweeps, at one substep a tick") {
  // Half of all kicks then open or close a tick, and see the forces of its start or end.
  const auto error_with = [](int rate) {
    WorldDef def = reference_world();
    def.tick_rate = rate;
    def.solver.min_substeps = 1;
    def.solver.damping_sweeps = 2;
    World<double> world(def);
    test::advance(world, 0.5);
    REQUIRE(world.report().substeps == 1);
    return largest_error(world, test::kReference5x5[2]);
  };
  CHECK(error_with(500) / error_with(1000) == Approx(4).epsilon(0.03));
}

TEST_CASE("without damping the energy of a swinging cloth stays within 0.1 % of its fall") {
  ClothDef cloth = test::flat_cloth(9, 9);
  cloth.fabric.damping_ratio = 0;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  for (Index i = 0; i < 9; ++i) def.pins.push_back({i, 0});
  def.solver.min_substeps = 40;
  World<double> world(def);
  world.step();
  const double start = world.report().energies.total();
  double lowest = start, highest = start;
  for (int tick = 0; tick < 120; ++tick) {
    const double energy = world.step().energies.total();
    lowest = std::min(lowest, energy);
    highest = std::max(highest, energy);
  }
  // The cloth falls by about half a metre: 0.2 kg * 9.81 * 0.5 m = 0.98 J.
  CHECK(highest - lowest < 1e-3);
}
