#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/attachments/gripper_load.h"
#include "core/cloth/fabric_presets.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/weight.h"
#include "tests/support/worlds.h"

// What resists a gripper as a whole: it yields to more than its force, as an object does.

using namespace weft;

namespace {

using test::kGravity;

void send(World<float>& world, std::size_t gripper, const Vec3d& position, double speed) {
  GripperCommand command;
  command.position = position;
  command.speed = speed;
  REQUIRE(world.command_gripper(gripper, command));
}

void move(World<float>& world, const Vec3d& position, double speed) {
  MoveDef command;
  command.target.position = position;
  command.speed = speed;
  REQUIRE(world.move_collider(0, command));
}

GripperDef jaws_at(const Vec3d& centre, double max_force) {
  GripperDef gripper;
  gripper.centre = centre;
  gripper.half_extents = Vec3d(0.01, 0.02, 0.02);
  gripper.max_force = max_force;
  return gripper;
}

struct Force {
  Vec3d mean = Vec3d::Zero();  ///< [N]
  double most = 0;             ///< size of a tick's [N]
  double slip = 0;             ///< greatest change from tick to tick across the mean [N]
};

/// Of the cloth on a gripper, of some seconds.
Force force_on(World<float>& world, std::size_t gripper, double seconds) {
  const int ticks = static_cast<int>(std::lround(seconds * world.def().tick_rate));
  Force force;
  std::vector<Vec3d> told;
  for (int t = 0; t < ticks; ++t) {
    world.step();
    told.push_back(
        load_of(world.grippers()[gripper], world.colliders(), world.tick_seconds()).force);
    force.mean += told.back() / ticks;
    force.most = std::max(force.most, told.back().norm());
  }
  const Vec3d way = force.mean.normalized();
  for (std::size_t t = 1; t < told.size(); ++t) {
    const Vec3d change = told[t] - told[t - 1];
    force.slip = std::max(force.slip, (change - way * way.dot(change)).norm());
  }
  return force;
}

/// Sheets of 30 cm on each other on a box of 60 cm, whose top is at y = 0, and jaws over them.
WorldDef layers_under_jaws(int layers, double thickness, double max_force) {
  WorldDef def = test::empty_world(test::flat_cloth(21, 21, 0.3, 0.3));
  ClothDef sheet = def.cloths[0];
  sheet.v = Vec3d::UnitZ();
  sheet.fabric.thickness = thickness;
  def.cloths.clear();
  for (int k = 0; k < layers; ++k) {
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin = Vec3d(-0.15, (k + 1) * (thickness + 1e-4), -0.15);
    def.cloths.push_back(sheet);
  }
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  ColliderDef table;
  table.name = "table";
  table.shape = BoxDef{Vec3d(0, -0.2, 0), Vec3d(0.3, 0.2, 0.3)};
  def.colliders = {table};
  def.grippers = {jaws_at(Vec3d(0, 0.1, 0), max_force)};
  return def;
}

/// A sheet of denim that hangs in the plane x = 0, with jaws at x = -0.1 that face it.
WorldDef sheet_before_jaws(double max_force) {
  WorldDef def = test::empty_world(test::flat_cloth(21, 21, 0.3, 0.3));
  ClothDef& sheet = def.cloths[0];
  sheet.u = Vec3d::UnitZ();
  sheet.v = -Vec3d::UnitY();
  sheet.origin = Vec3d(0, 1.15, -0.15);
  sheet.fabric.thickness = 2e-3;
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 1;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper = jaws_at(Vec3d(-0.1, 1, 0), max_force);
  gripper.orientation = Eigen::AngleAxisd(1.5707963267948966, Vec3d::UnitY());
  def.grippers = {gripper};
  return def;
}

/// The same with another gripper on the other side.
WorldDef sheet_between_grippers(double max_force, double others) {
  WorldDef def = sheet_before_jaws(max_force);
  GripperDef other = def.grippers[0];
  other.name = "other";
  other.centre[0] = 0.1;
  other.max_force = others;
  def.grippers.push_back(other);
  return def;
}

/// The same with a box there, of 10 cm.
WorldDef sheet_between_jaws_and_box(double max_force, double of_box) {
  WorldDef def = sheet_before_jaws(max_force);
  ColliderDef box;
  box.name = "box";
  box.shape = BoxDef{Vec3d(0.1, 1, 0), Vec3d(0.02, 0.05, 0.06)};
  box.max_force = of_box;
  def.colliders = {box};
  return def;
}

/// A sheet of 0.45 kg that hangs from jaws by its upper border.
WorldDef heavy_sheet_in_jaws(double max_force, int rate) {
  WorldDef def = test::empty_world(test::flat_cloth(15, 15, 0.3, 0.3));
  ClothDef& sheet = def.cloths[0];
  sheet.u = Vec3d::UnitZ();
  sheet.v = -Vec3d::UnitY();
  sheet.origin = Vec3d(0, 1, -0.15);
  sheet.fabric.areal_density = 5;
  sheet.fabric.stretch_warp = sheet.fabric.stretch_weft = 4000;
  sheet.fabric.shear = 400;
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 1;
  def.tick_rate = rate;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper = jaws_at(Vec3d(0, 0.98, 0), max_force);
  gripper.half_extents = Vec3d(0.01, 0.025, 0.16);
  gripper.opening = 0.03;
  gripper.force = 30;
  def.grippers = {gripper};
  return def;
}

}  // namespace

TEST_CASE("jaws press layers on a table with max_force, to a fifth in the mean of three seconds") {
  const auto [layers, thickness, max_force] =
      GENERATE(table<int, double, double>({{2, 2e-3, 10}, {3, 2e-3, 5}, {4, 5e-4, 5}}));
  CAPTURE(layers, thickness, max_force);
  World<float> world(layers_under_jaws(layers, thickness, max_force));
  test::advance(world, 0.5);
  send(world, 0, Vec3d(0, -0.05, 0), 0.1);
  test::advance(world, 2);
  CHECK(force_on(world, 0, 3).mean[1] == Approx(max_force).epsilon(0.2));
}

TEST_CASE("jaws of two grippers press a layer between them with the force of the weaker one") {
  const double others = GENERATE(10.0, 20.0);
  CAPTURE(others);
  World<float> world(sheet_between_grippers(10, others));
  test::advance(world, 0.3);
  send(world, 0, Vec3d(0.05, 1, 0), 0.2);
  send(world, 1, Vec3d(-0.05, 1, 0), 0.2);
  test::advance(world, 2);
  CHECK(force_on(world, 0, 1).mean[0] == Approx(-10).epsilon(0.05));
  CHECK((world.grippers()[0].pose.position[0] < -0.03) == (others > 10));  // the weaker gives way
}

TEST_CASE("jaws and a box press a layer between them with the force of the weaker one") {
  const double of_box = GENERATE(5.0, 10.0, 20.0);
  CAPTURE(of_box);
  World<float> world(sheet_between_jaws_and_box(10, of_box));
  test::advance(world, 0.3);
  send(world, 0, Vec3d(0.05, 1, 0), 0.2);
  move(world, Vec3d(-0.05, 1, 0), 0.2);
  test::advance(world, 2);
  CHECK(force_on(world, 0, 1).mean[0] == Approx(-std::min(10.0, of_box)).epsilon(0.05));
}

TEST_CASE("a table that rises against jaws presses them with its force, and no higher") {
  WorldDef def = layers_under_jaws(1, 2e-3, 30);
  def.colliders[0].max_force = 3;
  World<float> world(def);
  test::advance(world, 0.5);
  send(world, 0, Vec3d(0, 0.024, 0), 0.1);  // where it just touches
  test::advance(world, 1);
  move(world, Vec3d(0, -0.15, 0), 0.02);
  test::advance(world, 2);
  const double weight = test::weight_of(world);
  CHECK(force_on(world, 0, 1).mean[1] == Approx(3 - weight).epsilon(0.05));
  CHECK(world.colliders()[0].pose.position[1] < -0.198);
}

TEST_CASE("jaws that press a layer at rest are told no friction, on the level and aslant") {
  const bool hangs = GENERATE(false, true);
  CAPTURE(hangs);
  World<float> world(hangs ? sheet_between_jaws_and_box(10, 100) : layers_under_jaws(1, 2e-3, 10));
  test::advance(world, 0.3);
  if (hangs) move(world, Vec3d(0.02, 1, 0), 0.2);
  test::advance(world, 1);
  send(world, 0, hangs ? Vec3d(0.05, 1, 0) : Vec3d(0, -0.05, 0), 0.2);
  test::advance(world, 3);
  const Force force = force_on(world, 0, 1);
  CHECK(force.mean.norm() == Approx(10).epsilon(0.02));
  CHECK(force.slip < 0.1);
}

TEST_CASE(
    "jaws astride a rod press it with their force, to a quarter in the mean, and stay on it") {
  const double max_force = GENERATE(5.0, 20.0);
  CAPTURE(max_force);
  WorldDef def = test::empty_world(test::flat_cloth(31, 31, 0.3, 0.3));
  def.cloths[0].origin = Vec3d(-0.15, 2.5e-3, -0.15);
  def.cloths[0].fabric.thickness = 2e-3;
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 1;
  ColliderDef rod;
  rod.shape = CapsuleDef{Vec3d(0, -0.05, -0.3), Vec3d(0, -0.05, 0.3), 0.05};
  def.colliders = {rod};
  def.grippers = {jaws_at(Vec3d(0, 0.1, 0), max_force)};
  World<float> world(def);
  test::advance(world, 2);
  send(world, 0, Vec3d(0, -0.05, 0), 0.1);
  test::advance(world, 3);
  const Force force = force_on(world, 0, 2);
  CHECK((force.mean - Vec3d(0, max_force, 0)).norm() < 0.25 * max_force);
  CHECK(force.most < 2 * max_force);
  CHECK(std::abs(world.grippers()[0].pose.position[0]) < 6e-3);
}

TEST_CASE("a gripper carries what its force suffices for, and goes down with what is heavier") {
  const int rate = GENERATE(60, 240);
  const auto [max_force, way] = GENERATE(table<double, double>({{6, 0.2}, {20, 0.2}, {0.2, -0.2}}));
  CAPTURE(rate, max_force, way);
  World<float> world(heavy_sheet_in_jaws(max_force, rate));  // its weight is 4.4 N
  GripperCommand closed;
  closed.opening = 0;
  REQUIRE(world.command_gripper(0, closed));
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  while (!world.pins().list.empty()) world.unpin(world.pins().list.front().id);
  test::advance(world, 3);
  const double start = world.grippers()[0].pose.position[1];
  send(world, 0, Vec3d(0, way > 0 ? 3 : -3, 0), 0.2);
  test::advance(world, 3);
  const double gone = world.grippers()[0].pose.position[1] - start;
  CHECK(gone / (3 * way) > 0.8);
  CHECK(gone / (3 * way) < 1.001);
}

TEST_CASE("jaws that close on layers on a table do not jam them with many times their force") {
  const auto [thickness, max_force, goal] =
      GENERATE(table<double, double, double>({{5e-4, 2, 0.02}, {1e-3, 10, -0.03}}));
  CAPTURE(thickness, max_force, goal);
  WorldDef def = layers_under_jaws(2, thickness, max_force);
  def.grippers[0].opening = 0.1;
  World<float> world(def);
  send(world, 0, Vec3d(0, goal, 0), 0.3);
  test::advance(world, 0.7);
  GripperCommand closed;
  closed.opening = 0;
  REQUIRE(world.command_gripper(0, closed));
  test::advance(world, 1);
  for (int second = 0; second < 4; ++second)
    CHECK(force_on(world, 0, 1).mean.norm() < 3 * std::max(max_force, def.grippers[0].force));
}

TEST_CASE("jaws come down with a fold that they hold until it resists with their force") {
  WorldDef def = layers_under_jaws(1, 2e-3, 10);
  FabricDef& fabric = def.cloths[0].fabric;
  fabric = make_fabric("cotton");
  fabric.thickness = 2e-3;
  fabric.friction = 0.6;
  def.cloths[0].origin[1] = 2.5e-3;
  def.environment.air_density = EnvironmentDef{}.air_density;
  World<float> world(def);
  const auto close_to = [&world](double opening) {
    GripperCommand command;
    command.opening = opening;
    REQUIRE(world.command_gripper(0, command));
  };
  test::advance(world, 0.5);
  send(world, 0, Vec3d(0, 0.021, 0), 0.1);
  test::advance(world, 1);
  close_to(0);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  send(world, 0, Vec3d(0, 0.2, 0), 0.2);
  test::advance(world, 2.5);
  send(world, 0, Vec3d(0, -0.05, 0), 0.1);
  test::advance(world, 3);
  const Force force = force_on(world, 0, 2);
  CHECK(force.mean[1] > 5);
  CHECK(force.mean[1] < 20);
}
