#include "core/contact/objects/contact_log.h"

#include <array>
#include <map>
#include <tuple>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// Mean forces of contacts, added up while a tick runs, against all its impulses one by one.

using namespace weft;

namespace {

using Key = std::tuple<Index, int, std::array<Index, 4>>;

struct Sum {
  Vec3d impulse = Vec3d::Zero(), along = Vec3d::Zero();  // [N s]
};

Key key_of(const ContactPoint& c) {
  return {c.collider, c.count, c.particle};
}

/// All impulses of the last tick with objects, one by one.
std::map<Key, Sum> sums_of(const World<float>& world) {
  std::map<Key, Sum> sums;
  std::size_t first = 0;
  world.contact().log().visit_from(first, [&sums](const ContactPoint& c, const Vec3d& impulse) {
    Sum& sum = sums[key_of(c)];
    sum.impulse += impulse;
    sum.along += c.normal * c.normal.dot(impulse);
  });
  return sums;
}

/// A sheet that falls on a box, a ball and the ground.
WorldDef on_objects() {
  ClothDef cloth = test::flat_cloth(11, 11, 0.3, 0.3);
  cloth.origin = Vec3d(-0.15, 0.11, -0.15);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.contact.seed.self = SelfContact::guard;
  def.colliders = {{"box", BoxDef{Vec3d(-0.06, 0.05, 0), Vec3d(0.04, 0.05, 0.06)}},
                   {"ball", SphereDef{Vec3d(0.09, 0.05, 0), 0.05}},
                   {"ground", PlaneDef{Vec3d::Zero(), Vec3d::UnitY()}}};
  return def;
}

/// A sheet that hangs by its upper edge between the open jaws of a gripper.
WorldDef in_jaws() {
  ClothDef cloth = test::flat_cloth(9, 9, 0.2, 0.2);
  cloth.origin = Vec3d(-0.1, 1.2, 0);
  cloth.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper;
  gripper.centre = Vec3d(0, 1.15, 0);
  gripper.orientation = Eigen::AngleAxisd(-1.5707963267948966, Vec3d::UnitY());
  gripper.half_extents = Vec3d(0.005, 0.03, 0.06);
  gripper.opening = 0.02;
  gripper.closing_speed = 0.5;
  def.grippers = {gripper};
  return def;
}

/// Steps and compares. @returns what pushed in all ticks
std::size_t check_ticks(World<float>& world, int ticks) {
  std::size_t pushed = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    std::map<Key, Sum> sums = sums_of(world);
    pushed += sums.size();
    Key last{-1, 0, {}};
    for (const ContactPoint& contact : world.reactions()->contacts) {
      if (contact.collider == kNone) continue;
      REQUIRE(last < key_of(contact));
      last = key_of(contact);
      const Sum sum = sums[last];
      sums.erase(last);
      const Vec3d force = sum.impulse / world.tick_seconds();
      const double rounding = 1e-9 + 1e-7 * force.norm();  // of the tick's length, a float
      REQUIRE((contact.force() - force).norm() < rounding);
      if (sum.along.norm() == 0) continue;
      REQUIRE(std::abs(contact.normal_force - sum.along.normalized().dot(force)) < rounding);
    }
    REQUIRE(sums.empty());
  }
  return pushed;
}

}  // namespace

TEST_CASE("a contact's mean force is the sum of its impulses, on objects that move, turn or rest") {
  World<float> world(on_objects());
  world.measure_forces(true);
  world.measure_energy(true);  // which wants all impulses one by one
  MoveDef move{rest_pose(world.def().colliders[0].shape), 0.2, 3};
  move.target.position[1] += 0.03;
  move.target.rotation = Eigen::AngleAxisd(0.8, Vec3d(1, 2, 0.5).normalized());
  CHECK(check_ticks(world, 15) > 100);
  REQUIRE(world.move_collider(0, move));
  CHECK(check_ticks(world, 25) > 100);
}

TEST_CASE("so is that of jaws that squeeze, with what cancels between the two") {
  World<float> world(in_jaws());
  world.measure_forces(true);
  world.measure_energy(true);
  GripperCommand close;
  close.opening = 0;
  REQUIRE(world.command_gripper(0, close));
  check_ticks(world, 10);
  GripperCommand turn;
  turn.rotation = Eigen::AngleAxisd(0.2, Vec3d::UnitX());
  turn.position = Vec3d(0.01, 1.16, 0);
  REQUIRE(world.command_gripper(0, turn));
  CHECK(check_ticks(world, 15) > 100);
  const std::vector<Vec3d>& on = world.reactions()->colliders;
  CHECK(on[0].norm() > 4);  // each jaw presses with 5 N
  CHECK(on[1].norm() > 4);
}

TEST_CASE("the forces told are the same whether energies are asked for too or not") {
  World<float> alone(on_objects()), both(on_objects());
  alone.measure_forces(true);
  both.measure_forces(true);
  both.measure_energy(true);
  for (int tick = 0; tick < 30; ++tick) {
    alone.step();
    both.step();
    const auto &a = alone.reactions()->contacts, &b = both.reactions()->contacts;
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      // Where rows are worked on together, a tick's sum is rounded to single precision.
      REQUIRE((a[k].force() - b[k].force()).norm() <= 1e-5 * b[k].force().norm());
      REQUIRE(a[k].gap == b[k].gap);
    }
  }
}
