#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// Jaws that close where cloth bunches, lies across their rims or stops them, and what they hold.

using namespace weft;

namespace {

void command(World<float>& world, std::size_t gripper, const GripperCommand& what) {
  REQUIRE(world.command_gripper(gripper, what));
}

void close(World<float>& world, std::size_t gripper = 0) {
  GripperCommand closed;
  closed.opening = 0;
  command(world, gripper, closed);
}

/// Sends the first gripper down to a height [m], for as long, and then closes it.
void close_at(World<float>& world, double height, double seconds) {
  GripperCommand down;
  down.position = Vec3d(0, height, 0);
  down.speed = 0.1;
  command(world, 0, down);
  test::advance(world, seconds);
  close(world);
}

/// Mean force with which each jaw presses, of some ticks [N].
std::array<double, 2> mean_press(World<float>& world, int ticks = 60) {
  std::array<double, 2> mean = {0, 0};
  for (int t = 0; t < ticks; ++t) {
    world.step();
    const Gripper& gripper = world.grippers()[0];
    for (std::size_t k = 0; k < 2; ++k)
      mean[k] -= world.reactions()->colliders[gripper.jaw[k]].dot(press_of(gripper, k)) / ticks;
  }
  return mean;
}

/// The force with which the first jaw presses in half of some ticks [N]. A fold that turns between
/// jaws presses with several times as much for moments.
double median_press(World<float>& world, int ticks = 60) {
  std::vector<double> press;
  for (int t = 0; t < ticks; ++t) press.push_back(mean_press(world, 1)[0]);
  std::nth_element(press.begin(), press.begin() + ticks / 2, press.end());
  return press[static_cast<std::size_t>(ticks / 2)];
}

double highest(const World<float>& world) {
  float top = -1e9f;
  for (const auto& x : world.state().x) top = std::max(top, x[1]);
  return static_cast<double>(top);
}

/// A sheet of 30 cm and 18 g that hangs through jaws that are wider and nearly closed.
/// @param height  of the jaws' middle; the rows of particles are 2 cm apart from 1 m down [m]
WorldDef hanging_sheet(double height, double force, bool pinned) {
  WorldDef def = test::empty_world(test::flat_cloth(16, 16, 0.3, 0.3));
  ClothDef& sheet = def.cloths[0];
  sheet.fabric.thickness = 3e-3;
  sheet.fabric.friction = 0.4;
  sheet.fabric.areal_density = 0.2;
  sheet.origin = Vec3d(-0.15, 1, 0);
  sheet.v = -Vec3d::UnitY();
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  if (pinned) def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper;
  gripper.centre = Vec3d(0, height, 0);
  gripper.orientation = Eigen::AngleAxisd(-1.5707963267948966, Vec3d::UnitY());
  gripper.half_extents = Vec3d(0.005, 0.02, 0.2);
  gripper.opening = 6.2e-3;
  gripper.force = force;
  def.grippers = {gripper};
  return def;
}

/// A sheet of 50 cm on a table, and open jaws over its middle.
WorldDef sheet_on_table(double thickness, double friction, double friction_factor) {
  WorldDef def = test::empty_world(test::flat_cloth(31, 31, 0.5, 0.5));
  ClothDef& sheet = def.cloths[0];
  sheet.fabric.thickness = thickness;
  sheet.fabric.friction = friction;
  sheet.fabric.areal_density = 0.15;
  sheet.origin = Vec3d(-0.25, thickness + 1e-3, -0.25);
  sheet.v = Vec3d::UnitZ();
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  ColliderDef table;
  table.name = "table";
  table.shape = BoxDef{Vec3d(0, -0.35, 0), Vec3d(0.6, 0.35, 0.5)};
  def.colliders = {table};
  GripperDef gripper;
  gripper.centre = Vec3d(0, 0.06, 0);
  gripper.half_extents = Vec3d(0.006, 0.02, 0.012);
  gripper.opening = 0.05;
  gripper.force = 5;
  gripper.friction_factor = friction_factor;
  def.grippers = {gripper};
  return def;
}

/// A level sheet of 40 cm x 30 cm that two wider grippers hold by 2 cm at its ends.
/// @param force  of each jaw [N]
WorldDef taut_sheet(double force) {
  WorldDef def = test::empty_world(test::flat_cloth(19, 25, 0.4, 0.3));
  ClothDef& sheet = def.cloths[0];
  sheet.fabric.thickness = 1e-3;
  sheet.fabric.friction = 0.4;
  sheet.fabric.areal_density = 0.4;
  sheet.fabric.stretch_warp = sheet.fabric.stretch_weft = 4000;
  sheet.fabric.shear = 400;
  sheet.origin = Vec3d(-0.2, 1, -0.15);
  sheet.v = Vec3d::UnitZ();
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 2;
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  for (const double x : {-0.18, 0.18}) {
    GripperDef gripper;
    gripper.name = x < 0 ? "left" : "right";
    gripper.centre = Vec3d(x, 1, 0);
    gripper.orientation = Eigen::AngleAxisd(1.5707963267948966, Vec3d::UnitZ());
    gripper.half_extents = Vec3d(0.006, 0.01, 0.17);
    gripper.opening = 0.03;
    gripper.force = force;
    def.grippers.push_back(gripper);
  }
  return def;
}

}  // namespace

TEST_CASE("jaws press one layer with their force, though rows of particles lie at their rims") {
  for (const double force : {0.05, 0.5, 2.0}) {
    for (const double height : {0.84, 0.85}) {
      World<float> world(hanging_sheet(height, force, true));
      world.measure_forces(true);
      close(world);
      test::advance(world, 2);
      INFO(force << " N at " << height << " m");
      for (const double press : mean_press(world)) CHECK(press == Approx(force).epsilon(0.02));
    }
  }
}

TEST_CASE("what friction does not hold slips out of jaws past their rims, too") {
  World<float> world(hanging_sheet(0.97, 0.0441, false));  // a fifth of what would hold it
  close(world);
  test::advance(world, 2);
  CHECK(highest(world) < 0);
}

TEST_CASE("jaws that were sent into a sheet on a table close all the same, and lift it") {
  for (const auto& [height, thickness] : {std::pair(0.0212, 2e-3), std::pair(0.0205, 2e-3),
                                          std::pair(0.018, 2e-3), std::pair(0.018, 5e-4)}) {
    World<float> world(sheet_on_table(thickness, 0.4, 1));
    world.measure_forces(true);
    close_at(world, height, 1.5);
    test::advance(world, 3);
    INFO("sent to " << height << " m, " << thickness << " m thick");
    CHECK(world.grippers()[0].opening < 6 * thickness);
    GripperCommand up;
    up.position = Vec3d(0, 0.4, 0);
    command(world, 0, up);
    test::advance(world, 4.5);  // it is there after 4, and layers have settled between the jaws
    CHECK(median_press(world) == Approx(5).epsilon(0.1));
    CHECK(highest(world) > 0.25);
  }
}

TEST_CASE("jaws that bunch cloth yield to it") {
  World<float> world(sheet_on_table(1e-3, 0.6, 3));
  world.measure_forces(true);
  test::advance(world, 0.25);
  close_at(world, 0.021, 1);
  test::advance(world, 1);
  double mean = 0;
  for (const double press : mean_press(world, 240)) mean += press / 2;
  CHECK(mean > 3);
  CHECK(mean < 10);
}

TEST_CASE("a sheet that sags between jaws is held by what friction allows, and does not creep") {
  constexpr double kForce = 10, kAllowed = 2 * 0.4 * kForce;
  World<float> world(taut_sheet(kForce));
  world.measure_forces(true);
  for (std::size_t k = 0; k < 2; ++k) close(world, k);
  test::advance(world, 1);
  while (!world.pins().list.empty()) REQUIRE(world.unpin(world.pins().list[0].id));
  test::advance(world, 1);
  GripperCommand pull;
  pull.position = Vec3d(0.1855, 1, 0);
  pull.speed = 0.005;
  command(world, 1, pull);
  test::advance(world, 2.1);
  const auto end_of_sheet = [&world] {
    double mean = 0;
    for (std::size_t row = 0; row < 19; ++row)
      mean += static_cast<double>(world.state().x[row * 25 + 24][0]) / 19;
    return mean;
  };
  const double before = end_of_sheet();
  double load = 0;
  for (int t = 0; t < 120; ++t) {
    world.step();
    for (const std::size_t jaw : world.grippers()[1].jaw)
      load -= world.reactions()->colliders[jaw][0] / 120;
  }
  CHECK(load > 0.9 * kAllowed);
  CHECK(std::abs(end_of_sheet() - before) < 1e-5);
}
