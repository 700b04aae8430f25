#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/world/implicit_alone.h"
#include "tests/support/disturbances.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// BDF2 with Newton's method and conjugate gradients against closed forms, against verlet, and
// against itself with other substeps.

using namespace weft;
using namespace weft::test;

namespace {

WorldDef implicit_world(const ClothDef& cloth, int substeps) {
  WorldDef def = empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.kind = SolverKind::implicit;
  def.implicit.substeps = substeps;
  return def;
}

/// A level square metre that is let go, held by one edge.
WorldDef swing(int rows, int columns) {
  ClothDef cloth = flat_cloth(rows, columns);
  cloth.fabric.areal_density = 0.2;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 400;
  cloth.fabric.shear = 40;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-4;
  WorldDef def = empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}};
  return def;
}

/// A sheet of 0.5 m whose stretch is damped so strongly that verlet needs thousands of substeps.
ClothDef damped_sheet(int n, double density, double stiffness, double damping) {
  ClothDef sheet = flat_cloth(n, n, 0.5, 0.5);
  FabricDef& fabric = sheet.fabric;
  fabric.areal_density = density;
  fabric.stretch_warp = fabric.stretch_weft = stiffness;
  fabric.shear = stiffness / 10;
  fabric.stretch_damping = damping;
  return sheet;
}

template <class Real>
Vec3Array<double> places_after(const WorldDef& def, double seconds) {
  World<Real> world(def);
  advance(world, seconds);
  Vec3Array<double> x;
  for (const Vec3<Real>& at : world.state().x) x.push_back(at.template cast<double>());
  return x;
}

double mean_distance(const Vec3Array<double>& a, const Vec3Array<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

TEST_CASE("with implicit free fall is g t^2 / 2 and what the first substep adds for ever") {
  // Backward Euler falls g h^2 in the first substep, half of it too much; BDF2 is exact for a
  // parabola and carries an error e on as (4 e - e_before) / 3, to 3/2 of the first one.
  const int substeps = GENERATE(1, 4);
  World<double> world(implicit_world(flat_cloth(6, 7), substeps));
  const double start = centre_of_mass(world)[1], h = 1 / (60.0 * substeps);
  advance(world, 1.0);
  CHECK(start - centre_of_mass(world)[1] == Approx(4.905 + 0.75 * 9.81 * h * h).margin(1e-9));
  for (const Vec3d& v : world.state().v) CHECK(v[1] == Approx(-9.81).margin(1e-9));
}

TEST_CASE(
    "with implicit and damping c the fall is (g/c) t - (g/c^2)(1 - exp(-c t)), second order") {
  // Reference: drag.linear.c2_t1 of the expected values: x = 2.784409782137793.
  const auto error_with = [](int substeps) {
    WorldDef def = implicit_world(flat_cloth(3, 3), substeps);
    def.environment.damping = 2;
    World<double> world(def);
    const double start = centre_of_mass(world)[1];
    advance(world, 1.0);
    return start - centre_of_mass(world)[1] - 2.784409782137793;
  };
  CHECK(error_with(10) / error_with(20) == Approx(4).epsilon(0.05));
  CHECK(std::abs(error_with(20)) < 1e-5);
}

TEST_CASE("with implicit a falling plate in still air is within 1 % of vt tanh(g t / vt)") {
  // vt = 1.5819453278821503 m/s and x(0.5 s) = 0.614665957991099 m, as in motion_test.cpp.
  ClothDef plate = flat_cloth(8, 8);
  plate.fabric.bending_warp = plate.fabric.bending_weft = 1;
  WorldDef def = implicit_world(plate, 4);
  def.environment.air_density = 1.225;
  def.environment.still_air = true;
  World<double> world(def);
  const double start = centre_of_mass(world)[1];
  advance(world, 0.5);
  CHECK(start - centre_of_mass(world)[1] == Approx(0.614665957991099).epsilon(0.01));
  advance(world, 2.5);
  CHECK(world.state().v[20][1] == Approx(-1.5819453278821503).epsilon(0.01));
}

TEST_CASE("with implicit the error of a swing falls with the square of the substep") {
  WorldDef def = swing(10, 13);
  def.solver.min_substeps = 400;
  const Vec3Array<double> reference = places_after<double>(def, 0.8);
  def.solver.kind = SolverKind::implicit;
  def.implicit.iterations = 4;
  def.implicit.tolerance = 1e-4;
  const auto error_with = [&](int substeps) {
    def.implicit.substeps = substeps;
    return mean_distance(places_after<double>(def, 0.8), reference);
  };
  const double coarse = error_with(8), fine = error_with(16);
  CHECK(coarse / fine == Approx(4).epsilon(0.25));
  def.implicit = {};
  CHECK(error_with(1) < 0.025);  // [m], as it is set by itself, where the edge passes at 4 m/s
}

TEST_CASE("with implicit cloth rests where it rests with verlet, whatever its shape") {
  ClothDef cloth = swing(12, 9).cloths[0];
  const int kind = GENERATE(0, 1, 2);
  if (kind == 1) cloth.bending_model = BendingModel::hinges;  // spring by spring
  if (kind == 2) cloth.skip_stiffness = 5;
  cloth.membrane_model = MembraneModel::springs;  // implicit takes no misfit of cells off
  WorldDef def = empty_world(cloth);
  def.environment.gravity = Vec3d(0.5, -9.81, 0.2);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}, {77, 0, {}}};
  World<double> expected(def);
  settle(expected, 6, 6);
  def.solver.kind = SolverKind::implicit;
  World<double> world(def);
  CHECK(settle(world, 6, 6) < 1e-4);
  for (std::size_t i = 0; i < world.state().x.size(); ++i)
    CHECK((world.state().x[i] - expected.state().x[i]).norm() < 1e-4);
}

TEST_CASE("with implicit a hand of stiffness k carries a cloth of weight W by W / k below it") {
  World<double> world(implicit_world(flat_cloth(9, 9, 0.4, 0.4), 1));
  GrabDef grab;
  grab.triangle = 60;
  grab.radius = 0.1;
  grab.target = Vec3d(0, 1, 0);
  world.grab(grab);
  settle(world, 5, 6);
  double mass = 0;
  for (const double m : world.model().mass) mass += m;
  const Grab<double>& hand = world.grabs().list[0];
  CHECK(hand.force[1] == Approx(mass * 9.81).epsilon(1e-3));
  CHECK(1 - held_point(hand, world.state().x)[1] ==
        Approx(mass * 9.81 / hand.def.stiffness).epsilon(1e-3));
}

TEST_CASE("a hand's target may jump by metres: with implicit nothing gets faster than 30 m/s") {
  World<float> world(implicit_world(flat_cloth(17, 17), 1));
  world.pin({Corner::top_left, 0.1});
  GrabDef grab;
  grab.triangle = 300;
  grab.stiffness = 1e5;
  grab.max_force = 1e6;
  const GrabId id = world.grab(grab);
  for (int tick = 0; tick < 120; ++tick) {
    world.move_grab(id, Vec3d(tick % 20 < 10 ? 3 : -3, 0, 0));
    REQUIRE_FALSE(world.step().divergence);
    const Grab<float>& hand = world.grabs().list[0];
    Vec3<float> v = Vec3<float>::Zero();
    for (std::size_t n = 0; n < hand.particles.size(); ++n)
      v += world.state().v[static_cast<std::size_t>(hand.particles[n])] * hand.weights[n];
    REQUIRE(v.norm() < 45);  // BDF2's velocity at the end may be half as much again as the mean
  }
}

TEST_CASE("implicit leaves violent ticks to verlet, and no others") {
  WorldDef def = swing(17, 17);
  def.solver.kind = SolverKind::implicit;
  World<float> world(def);
  for (int tick = 0; tick < 60; ++tick) REQUIRE(world.step().implicit == ImplicitStatus::done);
  disturb(world, Disturbance::noise, 20);
  CHECK(world.step().implicit == ImplicitStatus::violent);
  int calm = 0;
  for (int tick = 0; tick < 300; ++tick)
    calm += world.step().implicit == ImplicitStatus::done ? 1 : 0;
  CHECK(calm > 150);
  CHECK(world.report().implicit == ImplicitStatus::done);
}

TEST_CASE("with implicit a pin that is sent through stiff cloth arrives, as with verlet") {
  // 30 kN/m: between two substeps the pin brings more energy than implicit explains.
  ClothDef strip = flat_cloth(2, 25, 1, 1. / 24);
  strip.fabric.stretch_warp = strip.fabric.stretch_weft = 3e4;
  WorldDef def = implicit_world(strip, 1);
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  const auto end = [&def](SolverKind solver) {
    def.solver.kind = solver;
    World<float> world(def);
    const Pin& pin = world.pins().list.back();
    const auto centre = static_cast<std::size_t>(pin.centre);
    const Vec3d target = world.state().x[centre].cast<double>() - 0.2 * Vec3d::UnitX();
    world.move_pin(pin.id, {target});
    for (int tick = 0; tick < 60; ++tick) REQUIRE_FALSE(world.step().divergence);
    return (world.state().x[centre].cast<double>() - target).norm();
  };
  CHECK(end(SolverKind::verlet) < 1e-3);
  CHECK(end(SolverKind::implicit) < 1e-3);
}

TEST_CASE("with implicit strongly damped cloth follows a moving pin without being strained") {
  WorldDef def = implicit_world(damped_sheet(7, 0.1, 1e4, 0.003), 1);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  World<float> world(def);
  REQUIRE(world.cost_of(SolverKind::verlet, def.environment).substeps > 3000);
  REQUIRE_FALSE(steps_implicit_alone(world));
  const Pin& pin = world.pins().list.back();
  const auto centre = static_cast<std::size_t>(pin.centre);
  const Vec3d target = world.state().x[centre].cast<double>() + Vec3d(0, 0, 0.1);
  world.move_pin(pin.id, {target, 0.3});
  double largest = 0;
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    largest = std::max(largest, world.report().largest_strain);
  }
  CHECK((world.state().x[centre].cast<double>() - target).norm() < 1e-3);
  CHECK(largest < 0.01);
}

TEST_CASE("with implicit strongly damped cloth that meets a ball is not strained by it") {
  WorldDef def = implicit_world(damped_sheet(9, 0.1, 1e4, 0.001), 1);
  ClothDef& cloth = def.cloths[0];
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d::UnitZ();
  cloth.origin = Vec3d(-0.25, 0.02, -0.25);
  def.colliders = {{"ball", SphereDef{Vec3d(0, -0.1, 0), 0.1}}};
  World<float> world(def);
  double largest = 0;
  for (int tick = 0; tick < 30; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    largest = std::max(largest, world.report().largest_strain);
  }
  CHECK(world.report().implicit == ImplicitStatus::touching);
  CHECK(largest < 0.05);
}

TEST_CASE("a refined run of implicit leaves the ticks to verlet that the run itself does") {
  WorldDef def = implicit_world(damped_sheet(7, 0.1, 2e4, 0.003), 1);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  World<float> world(def);
  const double substeps = world.cost_of(SolverKind::verlet, def.environment).substeps;
  REQUIRE(substeps < kMostSubsteps);
  REQUIRE(4 * substeps > kMostSubsteps);
  world.refine_substeps(4);
  const Pin& pin = world.pins().list.back();
  const auto centre = static_cast<std::size_t>(pin.centre);
  world.move_pin(pin.id, {world.state().x[centre].cast<double>() + Vec3d(0, 0, 0.1), 0.3});
  for (int tick = 0; tick < 3; ++tick) {
    const TickReport& report = world.step();
    CHECK(report.implicit == ImplicitStatus::driven);
    CHECK(report.substeps == 4 * substeps);
  }
}

TEST_CASE(
    "where verlet cannot step, implicit moves cloth with its pins, and says that it is alone") {
  WorldDef def = implicit_world(damped_sheet(7, 0.025, 3e4, 0.002), 1);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  World<float> world(def);
  REQUIRE(world.cost_of(SolverKind::verlet, def.environment).substeps > kMostSubsteps);
  CHECK(steps_implicit_alone(world));
  const Pin& pin = world.pins().list.back();
  const auto centre = static_cast<std::size_t>(pin.centre);
  const float start = world.state().x[centre].z();
  world.move_pin(pin.id, {world.state().x[centre].cast<double>() + Vec3d(0, 0, 0.3), 1});
  int stopped = 0;
  double largest = 0;
  for (int tick = 0; tick < 40; ++tick) {
    stopped += world.step().divergence ? 1 : 0;
    largest = std::max(largest, world.report().largest_strain);
  }
  CHECK(stopped <= 4);
  CHECK(world.state().x[centre].z() > start + 0.29F);
  CHECK(largest < 0.2);
}

TEST_CASE("implicit leaves ticks in which anything touches to verlet, and no others") {
  const char* contact = GENERATE("weft", "seed");
  INFO("contact " << contact);
  WorldDef def = implicit_world(flat_cloth(17, 17), 1);
  def.contact.model = contact == std::string("seed") ? ContactModel::seed : ContactModel::certified;
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -0.3, 0), Vec3d::UnitY()}}};
  World<float> world(def);
  const double ground = -0.3 + def.cloths[0].fabric.thickness;
  const auto lowest = [&world] {
    double y = 1e9;
    for (const Vec3<float>& x : world.state().x) y = std::min(y, static_cast<double>(x.y()));
    return y;
  };
  const double start = lowest();
  REQUIRE(start > ground + 0.1);
  int falling = 0;
  for (; lowest() > ground + 0.08; ++falling)
    REQUIRE(world.step().implicit != ImplicitStatus::touching);
  REQUIRE(falling > 5);
  for (int tick = 0; tick < 20; ++tick) world.step();
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE(world.step().implicit == ImplicitStatus::touching);
  }
  for (Vec3<float>& x : world.state().x) x.y() += 0.5F;
  world.accept_state();
  CHECK(world.step().implicit == ImplicitStatus::done);
}

TEST_CASE("with implicit a sheet that nothing holds keeps its momentum to 1e-4") {
  // It spins and wobbles; the linear systems are solved to the default 0.02.
  SeededRandom random(7);
  std::vector<ClothDef> sheets = {flat_cloth(12, 9, 0.5, 0.4),
                                  triangle_sheet(Cut::irregular, 0.5, 0.4, 0.04)};
  for (const ClothDef& sheet : sheets) {
    WorldDef def = implicit_world(sheet, 1);
    def.environment.gravity.setZero();
    World<float> world(def);
    const auto momentum = [&world] {
      Vec3d sum = Vec3d::Zero();
      for (std::size_t i = 0; i < world.state().v.size(); ++i)
        sum += world.state().v[i].cast<double>() * static_cast<double>(world.model().mass[i]);
      return sum;
    };
    const Vec3d middle = centre_of_mass(world), spin(0, 0, 4), drift(1, 0.5, -1);
    for (std::size_t i = 0; i < world.state().v.size(); ++i) {
      const Vec3d from_middle = world.state().x[i].cast<double>() - middle;
      world.state().v[i] = (drift + spin.cross(from_middle) + random.vector(0.3)).cast<float>();
    }
    world.accept_state();
    const Vec3d before = momentum();
    advance(world, 1);
    CHECK(world.report().implicit == ImplicitStatus::done);
    INFO("off by " << (momentum() - before).transpose());
    CHECK((momentum() - before).norm() < 1e-4 * before.norm());
  }
}

TEST_CASE("with implicit no spring bounds the substep: a cloth a thousand times stiffer hangs") {
  WorldDef def = swing(17, 17);
  FabricDef& fabric = def.cloths[0].fabric;
  fabric.stretch_warp = fabric.stretch_weft = 4e5;
  fabric.shear = 4e4;
  def.solver.kind = SolverKind::implicit;
  World<double> world(def);
  int violent = 0;
  double largest = 0;
  for (int tick = 0; tick < 240; ++tick) {
    const TickReport& report = world.step();
    REQUIRE_FALSE(report.divergence);
    REQUIRE((report.implicit == ImplicitStatus::violent || report.substeps == 1));
    violent += report.implicit == ImplicitStatus::violent ? 1 : 0;
    largest = std::max(largest, report.largest_strain);
  }
  CHECK(violent <= 6);  // where it snaps taut
  // Its weight stretches it by 5e-6; two Newton iterations leave more while it swings.
  CHECK(largest < 0.02);
  CHECK(world.report().largest_strain < 0.002);
}

TEST_CASE("with implicit the work that is told of a hand is the energy that the cloth gains") {
  // In vacuum and without dashpots: a free sheet that a hand speeds up gains what the hand gives.
  ClothDef cloth = test::flat_cloth(9, 9);
  cloth.fabric.damping_ratio = 0;
  WorldDef def = test::empty_world(cloth);
  def.solver.kind = SolverKind::implicit;
  def.implicit.substeps = 32;
  World<double> world(def);
  GrabDef hand;
  hand.triangle = 40;
  hand.radius = 0.6;
  hand.stiffness = 5;
  hand.target = test::centre_of_mass(world) + Vec3d(0.3, 0, 0);
  world.grab(hand);
  const double before = world.report().energies.total();
  double work = 0;
  int repeated = 0;
  for (int tick = 0; tick < 15; ++tick) {
    world.step();
    work += world.report().work;
    repeated += world.report().damped_substeps;
  }
  CHECK(work > 0.003);
  CHECK(world.report().energies.total() - before == Approx(work).epsilon(0.01));
  CHECK(repeated < 12);  // of 480: what a hand brings has a source
}
