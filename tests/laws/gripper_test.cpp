#include <catch2/catch.hpp>

#include "core/attachments/gripper_load.h"
#include "core/diagnostics/crossings.h"
#include "core/error.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/weight.h"
#include "tests/support/worlds.h"

// A gripper holds as much as friction allows: twice its coefficient times the force.

using namespace weft;

namespace {

using test::kGravity, test::weight_of;

/// A square cloth that hangs in the plane z = 0 by its upper strip, between open jaws.
/// @param height        of the jaws [m]; the strip is at 1.2
/// @param half_extents  of each jaw, across the cloth, up and along it [m]
WorldDef hung(ClothDef cloth, double side, double height, const Vec3d& half_extents) {
  cloth.width = cloth.height = side;
  cloth.origin = Vec3d(-side / 2, 1.2, 0);
  cloth.u = Vec3d::UnitX();
  cloth.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  GripperDef gripper;
  gripper.centre = Vec3d(0, height, 0);
  gripper.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(-1.5707963267948966, Vec3d::UnitY()));
  gripper.half_extents = half_extents;
  gripper.opening = 0.04;
  def.grippers = {gripper};
  return def;
}

WorldDef hung_between_jaws() {
  WorldDef def = hung(test::flat_cloth(17, 17), 0.2, 1.15, Vec3d(0.005, 0.03, 0.06));
  def.environment.damping = 4;
  return def;
}

/// Its upper border hangs between jaws of 4 x 12 cm: two rows of particles at 15 x 15.
WorldDef hung_between_narrow_jaws(int particles) {
  ClothDef cloth;
  cloth.rows = cloth.columns = particles;
  cloth.fabric.friction = 0.35;
  WorldDef def = hung(cloth, 0.25, 1.19, Vec3d(0.01, 0.02, 0.06));
  def.environment.damping = 0.5;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

void free_pins(World<float>& world) {
  while (!world.pins().list.empty()) world.unpin(world.pins().list.front().id);
}

void command(World<float>& world, double opening, double force) {
  GripperCommand command;
  command.opening = opening;
  command.force = force;
  REQUIRE(world.command_gripper(0, command));
}

/// Closes the jaws with the force whose friction is the cloth's weight over `load`, and frees it.
void grip_by_load(World<float>& world, double load) {
  command(world, 0, weight_of(world) / (2 * world.def().cloths[0].fabric.friction * load));
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  free_pins(world);
}

/// Particles between the faces of the jaws, by 5 mm.
std::vector<std::size_t> pinched(const World<float>& world) {
  std::vector<std::size_t> found;
  const Gripper& gripper = world.grippers()[0];
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const Vec3d p = world.state().x[i].cast<double>() - gripper.pose.position;
    const Vec3d inside = world.def().grippers[0].half_extents - Vec3d::Constant(0.005);
    if (std::abs(p[0]) < inside[2] && std::abs(p[1]) < inside[1]) found.push_back(i);
  }
  return found;
}

/// Largest displacement of any of them against the jaws over some seconds [m].
double creep(World<float>& world, double seconds) {
  const std::vector<std::size_t> held = pinched(world);
  REQUIRE(held.size() > 10);
  const Vec3Array<float> before = world.state().x;
  const Vec3d jaws = world.grippers()[0].pose.position;
  test::advance(world, seconds);
  const Vec3d displacement = world.grippers()[0].pose.position - jaws;
  double most = 0;
  for (const std::size_t i : held)
    most = std::max(most, ((world.state().x[i] - before[i]).cast<double>() - displacement).norm());
  return most;
}

std::size_t crossings(const World<float>& world) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const auto* box = std::get_if<BoxDef>(&world.def().colliders[k].shape);
    if (!box) continue;
    TriangleMesh mesh = world_mesh(*box);
    const Pose& pose = world.colliders()[k].pose;
    for (Vec3d& p : mesh.positions)
      p = pose.position + pose.rotation * (p - pivot_of(world.def().colliders[k].shape));
    count +=
        count_crossings(world.state().x, world.model().edges, world.model().triangles, mesh).proper;
  }
  return count;
}

}  // namespace

TEST_CASE("jaws close on a cloth, stop at its two thicknesses, lift it, and it does not creep") {
  World<float> world(hung_between_jaws());
  const double weight = weight_of(world), friction = world.def().cloths[0].fabric.friction;
  const double least = weight / (2 * friction);
  command(world, 0, 1.25 * least);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  // Jaws of so little force yield a little to what bends round their rims.
  CHECK(world.grippers()[0].opening ==
        Approx(2 * world.def().cloths[0].fabric.thickness).epsilon(0.01));
  free_pins(world);
  GripperCommand lift;
  lift.position = Vec3d(0.1, 1.6, 0);
  world.command_gripper(0, lift);
  for (int t = 0; t < 180; ++t) {
    world.step();
    REQUIRE(crossings(world) == 0);
  }
  CHECK(world.grippers()[0].pose.position == *lift.position);
  CHECK(creep(world, 10) < 1e-4);
  // The jaws carry it together.
  Vec3d carried = Vec3d::Zero();
  for (const Vec3d& force : world.coming_reactions().colliders) carried -= force;
  CHECK(carried[1] == Approx(weight).epsilon(0.01));

  command(world, 0.04, least);
  test::advance(world, 0.5);
  CHECK_FALSE(world.grippers()[0].gripping);
  CHECK(pinched(world).empty());
}

TEST_CASE("narrow jaws hold 0.9 of what friction allows for 20 s, at any number of particles") {
  World<float> world(hung_between_narrow_jaws(GENERATE(15, 31)));
  grip_by_load(world, 0.9);
  test::advance(world, 6);  // until the cloth, let go at once, swings no more
  CHECK(creep(world, 20) < 1e-4);
}

TEST_CASE("a cloth that weighs more than the friction of narrow jaws slips off them") {
  const double load = GENERATE(1.05, 1.4, 2.0);
  CAPTURE(load);
  World<float> world(hung_between_narrow_jaws(GENERATE(15, 31)));
  grip_by_load(world, load);
  test::advance(world, 2);
  CHECK(test::centre_of_mass(world)[1] < 0.5);
}

TEST_CASE("the contacts of each jaw press with its force, and rub with no more than friction") {
  World<float> world(hung_between_jaws());
  const double friction = world.def().cloths[0].fabric.friction;
  const double force = 2 * weight_of(world) / friction;
  world.measure_forces(true);
  command(world, 0, force);
  test::advance(world, 1);
  free_pins(world);
  test::advance(world, 2);
  REQUIRE(world.grippers()[0].gripping);
  Vec3d rubbed = Vec3d::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t jaw = world.grippers()[0].jaw[k];
    double pressed = 0;
    std::size_t count = 0;
    for (const ContactPoint& c : world.reactions()->contacts) {
      if (c.collider != static_cast<Index>(jaw)) continue;
      ++count;
      pressed += c.normal_force;
      rubbed += c.friction;
      CHECK(c.friction.norm() <= friction * c.normal_force * 1.001 + 1e-9);
    }
    CHECK(count > 10);
    CHECK(pressed == Approx(force).epsilon(0.01));
    // Along its direction of pressing the cloth resists it with as much.
    const Vec3d press = press_of(world.grippers()[0], k);
    CHECK(-press.dot(world.reactions()->colliders[jaw]) == Approx(force).epsilon(0.01));
  }
  CHECK(rubbed[1] == Approx(weight_of(world)).epsilon(0.01));
}

TEST_CASE("the torque on a gripper is the weight of its cloth times the lever, to 2 %") {
  const bool flat = GENERATE(false, true);
  CAPTURE(flat);
  WorldDef def = hung_between_jaws();
  if (flat) {  // a stiff cloth held at one side from above and below: by the jaws' normal forces
    def.cloths[0].v = Vec3d::UnitZ();
    def.cloths[0].fabric.bending_warp = def.cloths[0].fabric.bending_weft = 0.01;
    def.grippers[0].centre = Vec3d(-0.07, 1.2, 0.1);
    def.grippers[0].orientation = Eigen::AngleAxisd(1.5707963267948966, Vec3d::UnitZ());
    def.grippers[0].half_extents = Vec3d(0.005, 0.03, 0.06);
    def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  } else {  // one that hangs, off its middle: by friction alone
    def.grippers[0].centre[0] = -0.06;
  }
  World<float> world(def);
  const double weight = weight_of(world);
  command(world, 0, 100 * weight);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  free_pins(world);
  test::settle(world, 20, 3);
  constexpr int kTicks = 60;
  Vec3d told = Vec3d::Zero(), expected = Vec3d::Zero();
  for (int t = 0; t < kTicks; ++t) {
    world.step();
    const Vec3d lever = test::centre_of_mass(world) - world.grippers()[0].pose.position;
    told += load_of(world.grippers()[0], world.colliders(), world.tick_seconds()).torque / kTicks;
    expected += lever.cross(Vec3d(0, -weight, 0)) / kTicks;
  }
  REQUIRE(expected.norm() > 0.02 * weight);  // a lever of 2 cm
  CHECK((told - expected).norm() < 0.02 * expected.norm());
}

TEST_CASE("jaws that come down on folded cloth stop with their force and do not drive it") {
  WorldDef def = make_scene("gripper");
  World<float> world(def);
  const auto go = [&world](const Vec3d& position, double speed, double opening) {
    GripperCommand command;
    command.position = position;
    command.speed = speed;
    command.opening = opening;
    world.command_gripper(0, command);
  };
  world.step();
  go(Vec3d(0.28, 0.9, 0), 5, 0.08);  // folds the border over
  test::advance(world, 0.5);
  go(Vec3d(0, 0.5, 0), 1, 0.02);
  test::advance(world, 0.75);
  // The space between the lower jaw and the table ends long before the jaw's path does.
  const double speed = GENERATE(0.5, 1.0);
  go(Vec3d(0, 0.25, 0), speed, 0.02);
  const double most = def.grippers[0].max_force;
  double sum = 0;
  for (int t = 0; t < 100; ++t) {
    const TickReport& report = world.step();
    REQUIRE_FALSE(report.divergence);
    REQUIRE(report.largest_strain < 1);
    REQUIRE(report.energies.kinetic + report.energies.stretch < 1);
    const double force = world.colliders()[world.grippers()[0].jaw[0]].force.norm();
    CHECK(force < 10 * most);  // the blow of the first tick
    if (t >= 70) sum += force / 30;
  }
  CHECK(world.grippers()[0].opening > 0.015);  // both jaws stand
  CHECK(world.grippers()[0].pose.position[1] > 0.3);
  CHECK(sum < 1.5 * most);
  // It lets itself be lifted again.
  go(Vec3d(0, 0.6, 0), 1, 0.02);
  test::advance(world, 1);
  CHECK(world.grippers()[0].pose.position[1] == Approx(0.6));
}

TEST_CASE("jaws whose friction is less than the weight let the cloth slip") {
  World<float> world(hung_between_jaws());
  const double least = weight_of(world) / (2 * world.def().cloths[0].fabric.friction);
  command(world, 0, 0.9 * least);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  free_pins(world);
  CHECK(creep(world, 2) > 0.01);
}

TEST_CASE("jaws with nothing between them meet, and open again") {
  WorldDef def = hung_between_jaws();
  def.grippers[0].centre[1] = 3;
  World<float> world(def);
  command(world, 0, 5);
  test::advance(world, 1);
  CHECK(world.grippers()[0].opening == Approx(0).margin(1e-9));
  CHECK_FALSE(world.grippers()[0].gripping);
  command(world, 0.03, 5);
  test::advance(world, 1);
  CHECK(world.grippers()[0].opening == Approx(0.03));
}

TEST_CASE("a gripper turns with its jaws, and a world with one is repeated bit for bit") {
  WorldDef def = hung_between_jaws();
  World<float> first(def), second(def);
  GripperCommand turn;
  turn.opening = 0.0;
  turn.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vec3d::UnitZ()));
  for (World<float>* world : {&first, &second}) {
    world->command_gripper(0, turn);
    test::advance(*world, 1);
  }
  CHECK(first.hash() == second.hash());
  CHECK(first.grippers()[0].pose.rotation.angularDistance(*turn.rotation) < 1e-9);
  first.reset();
  CHECK(first.hash() == World<float>(def).hash());
  CHECK(first.grippers()[0].opening == def.grippers[0].opening);
}

TEST_CASE("a gripper whose orientation is not quite of unit norm is where the turned one is") {
  WorldDef def = hung_between_jaws();
  World<float> exact(def);
  def.grippers[0].orientation.coeffs() *= 1.0009;
  World<float> nearly(def);
  for (World<float>* world : {&exact, &nearly}) {
    command(*world, 0, 5);
    test::advance(*world, 1);
    free_pins(*world);
    test::advance(*world, 0.1);
  }
  REQUIRE(exact.grippers()[0].gripping);
  CHECK(nearly.grippers()[0].opening == Approx(exact.grippers()[0].opening).margin(1e-9));
  CHECK(nearly.grippers()[0].gripping);
  for (std::size_t k = 0; k < 2; ++k) {
    const Pose &a = exact.colliders()[k].pose, &b = nearly.colliders()[k].pose;
    CHECK((a.position - b.position).norm() < 1e-9);
  }
}

TEST_CASE("the steps of a scene turn a gripper the short way, at its rate, with what it holds") {
  constexpr double kAngle = 2, kRate = 0.8;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(kAngle, Vec3d::UnitY()));
  WorldDef def = hung_between_jaws();
  def.grippers[0].turn_speed = kRate;
  def.grippers[0].steps = {{0, Vec3d::Zero(), 0}, {1, Vec3d(0, 0.2, 0), 0, turned}};
  def.grippers[0].steps.push_back({5, Vec3d(0, 0.2, 0), 0, Eigen::Quaterniond(-turned.coeffs())});
  def.grippers[0].steps.push_back({6, Vec3d(0, 0.2, 0), 0});
  World<float> world(def);
  test::advance(world, 1);
  REQUIRE(world.grippers()[0].gripping);
  const std::vector<std::size_t> held = pinched(world);
  REQUIRE(held.size() > 10);
  const Vec3Array<float> before = world.state().x;
  const Vec3d from = world.grippers()[0].pose.position;
  free_pins(world);
  for (int t = 0; t < 180; ++t) {
    const Eigen::Quaterniond last = world.grippers()[0].pose.rotation;
    world.step();
    const double rate = world.grippers()[0].pose.rotation.angularDistance(last) * def.tick_rate;
    REQUIRE(rate < kRate * (1 + 1e-6));
    if (t < 140) REQUIRE(rate > kRate * (1 - 1e-6));
    REQUIRE(crossings(world) == 0);
  }
  const Pose& pose = world.grippers()[0].pose;
  CHECK(pose.rotation.angularDistance(turned) < 1e-9);
  double slipped = 0;
  for (const std::size_t i : held) {
    const Vec3d kept = turned * (before[i].cast<double>() - from);
    slipped = std::max(slipped, (world.state().x[i].cast<double>() - pose.position - kept).norm());
  }
  CHECK(slipped < 2e-3);
  test::advance(world, 1.5);
  CHECK(pose.rotation.angularDistance(turned) < 1e-9);  // the same turn, told otherwise
  test::advance(world, 3);
  CHECK(pose.rotation.angularDistance(Eigen::Quaterniond::Identity()) < 1e-9);
}

TEST_CASE("the scene of the gripper lifts its cloth off the table and holds it") {
  World<float> world(make_scene("gripper"));
  test::advance(world, 6);
  CHECK(world.grippers()[0].gripping);
  CHECK(test::centre_of_mass(world)[1] > 0.4);
  const double height = test::centre_of_mass(world)[1];
  test::advance(world, 3);
  CHECK(test::centre_of_mass(world)[1] == Approx(height).margin(0.01));
  CHECK(crossings(world) == 0);
}

TEST_CASE("a wrong gripper and a wrong command are refused by name") {
  WorldDef def = hung_between_jaws();
  def.grippers[0].force = -1;
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
  def = hung_between_jaws();
  def.grippers.push_back(def.grippers[0]);  // the same name twice
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
  def = hung_between_jaws();
  def.contact.model = ContactModel::seed;
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
  def = hung_between_jaws();
  def.grippers[0].steps = {{0, Vec3d::Zero(), 0, Eigen::Quaterniond(1, 0, 0, 1)}};
  CHECK_THROWS_AS(World<float>(def), DefinitionError);
  World<float> world(hung_between_jaws());
  GripperCommand wrong;
  wrong.opening = std::nan("");
  CHECK_THROWS_AS(world.command_gripper(0, wrong), DefinitionError);
  CHECK_FALSE(world.command_gripper(1, GripperCommand{}));
  CHECK_THROWS_AS(world.move_collider(0, MoveDef{}), DefinitionError);
}
