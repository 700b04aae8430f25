#include <catch2/catch.hpp>

#include "core/attachments/gripper_load.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/weight.h"
#include "tests/support/worlds.h"

// Jaws that press cloth on other objects, that cloth resists, and what is told of their forces.

using namespace weft;

namespace {

using test::kGravity, test::weight_of;

void send(World<float>& world, const Vec3d& position, double speed) {
  GripperCommand command;
  command.position = position;
  command.speed = speed;
  REQUIRE(world.command_gripper(0, command));
}

void close(World<float>& world) {
  GripperCommand command;
  command.opening = 0;
  REQUIRE(world.command_gripper(0, command));
}

/// What cloth does to the jaws by their contacts [N].
Vec3d reaction_of_jaws(const World<float>& world) {
  Vec3d sum = Vec3d::Zero();
  for (const std::size_t jaw : world.grippers()[0].jaw) sum += world.reactions()->colliders[jaw];
  return sum;
}

/// Lets the cloth go, but for the jaws.
void free_pins(World<float>& world) {
  while (!world.pins().list.empty()) world.unpin(world.pins().list.front().id);
}

GripperLoad load(const World<float>& world) {
  return load_of(world.grippers()[0], world.colliders(), world.tick_seconds());
}

/// A sheet on a table whose top is at y = 0.4, and jaws above it.
WorldDef sheet_under_jaws(bool plane, double opening, double max_force) {
  ClothDef cloth = test::flat_cloth(21, 21, 0.3, 0.3);
  cloth.origin = Vec3d(-0.15, 0.405, -0.15);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 1;
  ColliderDef table;
  table.name = "table";
  if (plane)
    table.shape = PlaneDef{Vec3d(0, 0.4, 0), Vec3d::UnitY()};
  else
    table.shape = BoxDef{Vec3d(0, 0.2, 0), Vec3d(0.3, 0.2, 0.3), Eigen::Quaterniond::Identity()};
  def.colliders = {table};
  GripperDef gripper;
  gripper.centre = Vec3d(0, 0.45, 0);
  gripper.half_extents = Vec3d(0.02, 0.02, 0.02);
  gripper.opening = opening;
  gripper.max_force = max_force;
  def.grippers = {gripper};
  return def;
}

/// A sheet that hangs by its upper border, with jaws about its lower one.
WorldDef hung_over_jaws(double force, double max_force) {
  ClothDef cloth = test::flat_cloth(21, 21, 0.3, 0.3);
  cloth.origin = Vec3d(0, 1.3, -0.15);
  cloth.u = Vec3d::UnitZ();
  cloth.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.damping = 1;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper;
  gripper.centre = Vec3d(0, 1.02, 0);
  gripper.half_extents = Vec3d(0.01, 0.025, 0.16);
  gripper.opening = 0.03;
  gripper.force = force;
  gripper.max_force = max_force;
  def.grippers = {gripper};
  return def;
}

/// A square that hangs by a corner, and jaws over so much of it below the corner.
WorldDef hung_by_corner(int particles, double held, double force) {
  ClothDef cloth = test::flat_cloth(particles, particles, 0.3, 0.3);
  cloth.origin = Vec3d(0, 1, 0);
  cloth.u = Vec3d(0, -1, 1).normalized();
  cloth.v = Vec3d(0, -1, -1).normalized();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 2;
  def.pins = {{Corner::top_left, 0, {}}};
  GripperDef gripper;
  gripper.half_extents = Vec3d(0.01, 0.02, 0.02);
  gripper.centre = Vec3d(0, 1.02 - held, 0);
  gripper.force = force;
  def.grippers = {gripper};
  return def;
}

}  // namespace

TEST_CASE(
    "jaws sent into a layer on a table stand on it, press it with their force, and go along") {
  const bool plane = GENERATE(false, true);
  const double opening = GENERATE(0.0, 0.02), max_force = GENERATE(2.0, 40.0);
  CAPTURE(plane, opening, max_force);
  World<float> world(sheet_under_jaws(plane, opening, max_force));
  world.measure_forces(true);
  const double thickness = world.def().cloths[0].fabric.thickness;
  const double level = 0.4 + thickness + 0.02;
  test::advance(world, 0.5);
  send(world, Vec3d(0, 0.41, 0), 0.1);  // deeper than the jaws can go
  test::advance(world, 3);
  CHECK(world.grippers()[0].pose.position[1] == Approx(level + thickness).margin(0.1 * thickness));
  const double on_table = -world.reactions()->colliders[0][1];
  CHECK(on_table - weight_of(world) == Approx(max_force).epsilon(0.01));
  CHECK(load(world).force[1] == Approx(max_force).epsilon(0.01));
  double lowest = 1;
  for (const auto& x : world.state().x) lowest = std::min(lowest, static_cast<double>(x[1]));
  CHECK(lowest > 0.4 + 0.98 * thickness);
  send(world, Vec3d(0.05, 0.41, 0), 0.1);
  test::advance(world, 2);
  CHECK(world.grippers()[0].pose.position[0] == Approx(0.05).margin(1e-3));
}

TEST_CASE("a gripper tells the sum of what cloth does to its jaws, standing, carrying or fast") {
  WorldDef def = hung_over_jaws(5, 100);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  World<float> world(def);
  world.measure_forces(true);
  const auto differ = [&world](double seconds) {
    double most = 0;
    for (int t = 0; t < seconds * world.def().tick_rate; ++t) {
      world.step();
      most = std::max(most, (reaction_of_jaws(world) - load(world).force).norm());
    }
    return most;
  };
  close(world);
  differ(1);
  free_pins(world);
  CHECK(differ(2) < 1e-4);
  for (const double speed : {0.5, 3.0}) {
    send(world, Vec3d(0.2, 1.02 + speed / 10, 0), speed);
    CHECK(differ(1) < 1e-4);
  }
}

TEST_CASE("a gripper that carries cloth without gripping it tells its weight") {
  ClothDef cloth = test::flat_cloth(21, 21, 0.3, 0.3);
  cloth.origin = Vec3d(-0.15, 1.03, -0.15);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 3;
  GripperDef gripper;
  gripper.half_extents = Vec3d(0.02, 0.02, 0.1);
  gripper.opening = GENERATE(0.02, 0.06);
  def.grippers = {gripper};
  World<float> world(def);
  test::advance(world, 5);
  constexpr int kTicks = 60;
  Vec3d told = Vec3d::Zero();
  for (int t = 0; t < kTicks; ++t) {
    world.step();
    told += load(world).force / kTicks;
  }
  CHECK((told - Vec3d(0, -weight_of(world), 0)).norm() < 0.02 * weight_of(world));
}

TEST_CASE("what resists both jaws together stops them at the force of one gripper") {
  // Cloth that is pinned stops them; and so does cloth that would slip at more.
  const auto [max_force, grip] = GENERATE(table<double, double>({{2, 20}, {1, 2}, {10, 20}}));
  CAPTURE(max_force, grip);
  World<float> world(hung_over_jaws(grip, max_force));
  close(world);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  send(world, Vec3d(0, 0.9, 0), 0.02);
  test::advance(world, 3);
  double told = 0;
  for (int t = 0; t < 60; ++t) {
    world.step();
    told += load(world).force[1] / 60;
  }
  CHECK(told == Approx(max_force).epsilon(0.08));
  CHECK(world.grippers()[0].pose.position[1] > 0.95);
}

TEST_CASE("a corner of cloth between jaws stays there, at few hundredths of what friction holds") {
  const auto [particles, held, force] =
      GENERATE(table<int, double, double>({{15, 0.012, 4}, {16, 0.008, 8}, {29, 0.006, 10}}));
  CAPTURE(particles, held, force);
  World<float> world(hung_by_corner(particles, held, force));
  close(world);
  test::advance(world, 1.5);
  REQUIRE(world.grippers()[0].gripping);
  REQUIRE(weight_of(world) < 0.1 * 2 * world.def().cloths[0].fabric.friction * force);
  free_pins(world);
  test::advance(world, 5);
  CHECK(std::abs(world.state().x[0][1] - 1) < 3e-4);
}

TEST_CASE("contacts of jaws have the torque that the gripper tells, with particles at their rims") {
  const double half = GENERATE(0.02, 0.0208, 0.025);  // with rows 15 mm apart
  CAPTURE(half);
  ClothDef cloth = test::flat_cloth(21, 21, 0.3, 0.3);
  cloth.origin = Vec3d(0, 1.01, -0.15);
  cloth.u = Vec3d::UnitZ();
  cloth.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 3;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper;
  gripper.half_extents = Vec3d(0.02, half, 0.17);
  gripper.opening = 0.03;
  def.grippers = {gripper};
  World<float> world(def);
  world.measure_forces(true);
  close(world);
  test::advance(world, 1);
  free_pins(world);
  GripperCommand turn;
  turn.rotation = Eigen::AngleAxisd(1.5707963267948966, Vec3d::UnitZ());
  REQUIRE(world.command_gripper(0, turn));
  test::advance(world, 8);
  constexpr int kTicks = 40;
  Vec3d by_contacts = Vec3d::Zero(), told = Vec3d::Zero();
  for (int t = 0; t < kTicks; ++t) {
    world.step();
    told += load(world).torque / kTicks;
    for (const ContactPoint& contact : world.reactions()->contacts) {
      const Vec3d lever = contact.point - world.grippers()[0].pose.position;
      by_contacts -= lever.cross(contact.force()) / kTicks;
    }
  }
  // The weight at half of the cloth's length is the measure.
  CHECK((by_contacts - told).norm() < 0.1 * weight_of(world) * 0.15);
}
