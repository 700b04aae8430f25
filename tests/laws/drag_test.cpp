#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// What is told of cloth under drag is what acts on it, however strong the drag and however few the
// substeps: forces by its weight, work by Coulomb's law.

using namespace weft;

namespace {

constexpr double kGravity = 9.81, kFriction = 0.3;

/// A way to step cloth under drag.
struct Way {
  double drag;
  int substeps;
};

/// A soft sheet of 0.3 kg/m^2 on the ground, which verlet may step as coarsely as `way` says.
WorldDef sheet_on_ground(const Way& way) {
  ClothDef cloth = test::flat_cloth(7, 9, 0.4, 0.3);
  cloth.fabric.areal_density = 0.3;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 5;
  cloth.fabric.shear = 1;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-6;
  cloth.fabric.friction = kFriction;
  cloth.origin = Vec3d(0, cloth.fabric.thickness, 0);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = way.drag;
  def.solver.min_substeps = way.substeps;
  def.colliders = {{"ground", PlaneDef{}}};
  return def;
}

double weight_of(const World<double>& world) {
  double mass = 0;
  for (const double m : world.model().mass) mass += m;
  return mass * kGravity;
}

Vec3d mean_velocity(const World<double>& world) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& v : world.state().v) sum += v;
  return sum / static_cast<double>(world.state().v.size());
}

/// Forces of the ground on the cloths [N].
Vec3d sum_of_ground(const Reactions& reactions) {
  Vec3d sum = Vec3d::Zero();
  for (const ContactPoint& contact : reactions.contacts) {
    if (contact.collider != kNone) sum += contact.force();
  }
  return sum;
}

/// Forces of the first cloth on the second one [N].
Vec3d sum_between_cloths(const World<double>& world) {
  const IndexRange& second = world.model().parts[1].particles;
  Vec3d sum = Vec3d::Zero();
  for (const ContactPoint& contact : world.reactions()->contacts) {
    if (contact.collider == kNone)
      sum += second.contains(contact.particle[0]) ? contact.force() : -contact.force();
  }
  return sum;
}

/// Four particles of that sheet, without ground.
WorldDef free_patch(const Way& way) {
  WorldDef def = sheet_on_ground(way);
  def.colliders.clear();
  def.cloths[0].rows = def.cloths[0].columns = 2;
  def.cloths[0].width = def.cloths[0].height = 0.1;
  return def;
}

GrabDef hand_at_a_corner(const World<double>& world) {
  GrabDef hand;
  hand.barycentric = {1, 0, 0};
  hand.radius = 0;
  hand.target = world.state().x[static_cast<std::size_t>(world.model().triangles[0][0])];
  return hand;
}

}  // namespace

TEST_CASE("under any drag a sheet at rest tells its weight to the ground, to 1e-5") {
  const Way way = GENERATE(Way{0, 3}, Way{5, 3}, Way{100, 1}, Way{100, 3}, Way{100, 24},
                           Way{1000, 3}, Way{1000, 40});
  CAPTURE(way.drag, way.substeps);
  World<double> world(sheet_on_ground(way));
  test::advance(world, 1);
  world.measure_forces(true);
  world.step();
  const Vec3d told = world.reactions()->colliders[0];
  CHECK(-told.y() == Approx(weight_of(world)).epsilon(1e-5));
  CHECK(sum_of_ground(*world.reactions()).y() == Approx(weight_of(world)).epsilon(1e-5));
}

TEST_CASE("under any drag a sheet on another tells its weight to that, to 2e-3") {
  const Way way = GENERATE(Way{0, 4}, Way{100, 4}, Way{1000, 12});
  CAPTURE(way.drag, way.substeps);
  WorldDef def = sheet_on_ground(way);
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "upper";
  def.cloths[1].origin.y() += def.cloths[0].fabric.thickness;
  def.contact.seed.self = SelfContact::guard;
  World<double> world(def);
  test::advance(world, 4);
  world.measure_forces(true);
  world.step();
  const auto carried = [&](std::size_t cloth) {  // what still sinks is carried by drag too
    const IndexRange& range = world.model().parts[cloth].particles;
    double sum = 0;
    for (auto i = static_cast<std::size_t>(range.first); i < static_cast<std::size_t>(range.end());
         ++i)
      sum += world.model().mass[i] * (kGravity + way.drag * world.state().v[i].y());
    return sum;
  };
  CHECK(sum_between_cloths(world).y() == Approx(carried(1)).epsilon(2e-3));
  CHECK(-world.reactions()->colliders[0].y() == Approx(carried(0) + carried(1)).epsilon(2e-3));
  CHECK(carried(1) == Approx(weight_of(world) / 2).epsilon(0.01));
}

TEST_CASE("under any drag a box that lifts a sheet evenly is told its weight and drag, to 1e-3") {
  const Way way = GENERATE(Way{1, 3}, Way{100, 3}, Way{100, 24});
  CAPTURE(way.drag, way.substeps);
  WorldDef def = sheet_on_ground(way);
  const ShapeDef box = BoxDef{Vec3d(0.2, -0.5, 0.15), Vec3d(2, 0.5, 2)};
  def.colliders = {{"box", box}};
  World<double> world(def);
  constexpr double kSpeed = 0.05;
  MoveDef up{rest_pose(box), kSpeed, 1};
  up.target.position[1] += 1;
  world.move_collider(0, up);
  test::advance(world, 2);
  world.measure_forces(true);
  world.step();
  const double expected = weight_of(world) * (1 + way.drag * kSpeed / kGravity);
  CHECK(-world.reactions()->colliders[0].y() == Approx(expected).epsilon(1e-3));
  CHECK(-world.colliders()[0].force.y() == Approx(expected).epsilon(1e-3));
}

TEST_CASE("under any drag a hand tells the weight that it holds at rest, to 1e-5") {
  const Way way = GENERATE(Way{2, 3}, Way{50, 3}, Way{200, 6}, Way{200, 24});
  CAPTURE(way.drag, way.substeps);
  World<double> world(free_patch(way));
  GrabDef hand = hand_at_a_corner(world);
  hand.stiffness = 10;
  world.grab(hand);
  test::advance(world, 30 + way.drag / 2);
  CHECK(world.grabs().list[0].told.y() == Approx(weight_of(world)).epsilon(1e-5));
  CHECK(std::abs(mean_velocity(world).y()) < 1e-6);
}

TEST_CASE("under any drag a pin that lifts a sheet evenly tells its weight and drag, to 1 %") {
  const Way way = GENERATE(Way{0.5, 3}, Way{20, 3}, Way{100, 3});
  CAPTURE(way.drag, way.substeps);
  WorldDef def = sheet_on_ground(way);
  def.colliders.clear();
  def.pins = {{Corner::top_left, 1}};
  World<double> world(def);
  PinMove lift;
  lift.speed = 0.05;
  lift.max_force = 1000;
  lift.target = world.state().x[static_cast<std::size_t>(world.pins().list[0].centre)];
  lift.target.y() += 1;
  world.move_pin(world.pins().list[0].id, lift);
  test::advance(world, 5);
  world.measure_forces(true);
  world.step();
  const double speed = mean_velocity(world).y();
  CHECK(speed == Approx(lift.speed).epsilon(1e-3));
  CHECK(world.reactions()->pins[0].force.y() ==
        Approx(weight_of(world) * (1 + way.drag * speed / kGravity)).epsilon(0.01));
}

TEST_CASE("under any drag a sliding sheet tells friction mu times its weight, to 1e-4") {
  const Way way = GENERATE(Way{1, 3}, Way{20, 3}, Way{100, 3}, Way{100, 24});
  CAPTURE(way.drag, way.substeps);
  WorldDef def = sheet_on_ground(way);
  def.environment.gravity = Vec3d(kGravity, -kGravity, 0);
  World<double> world(def);
  world.measure_forces(true);
  world.measure_energy(true);
  test::advance(world, 0.5);
  const Vec3d before = test::centre_of_mass(world);
  const EnergyFlows start = world.energy_balance()->flows;
  double drag = 0;  // m a v^2 dt
  for (int tick = 0; tick < 60; ++tick) {
    world.step();
    const Vec3d force = -world.reactions()->colliders[0];
    CHECK(force.y() == Approx(weight_of(world)).epsilon(1e-4));
    CHECK(-force.x() == Approx(kFriction * weight_of(world)).epsilon(1e-4));
    drag += way.drag * weight_of(world) / kGravity * mean_velocity(world).squaredNorm() *
            world.tick_seconds();
  }
  const double way_down = (test::centre_of_mass(world) - before).x();
  REQUIRE(way_down > 0.05);
  const EnergyFlows& flows = world.energy_balance()->flows;
  CHECK(flows.friction - start.friction ==
        Approx(kFriction * weight_of(world) * way_down).epsilon(0.01));
  CHECK(flows.drag - start.drag == Approx(drag).epsilon(0.02));
}

TEST_CASE("under drag a hand's work is its force along its way, and drag and its load get it") {
  const Way way = GENERATE(Way{50, 3}, Way{200, 24});
  CAPTURE(way.drag, way.substeps);
  World<double> world(free_patch(way));
  const GrabDef hand = hand_at_a_corner(world);
  const GrabId id = world.grab(hand);
  test::advance(world, 5 + way.drag / 10);
  world.measure_energy(true);
  const double start = world.report().energies.total();
  const Vec3d from = hand.target;
  double told = 0;  // force of the hand times its way
  for (int tick = 1; tick <= 120; ++tick) {
    const Vec3d before = held_point(world.grabs().list[0], world.state().x);
    world.move_grab(id, from + Vec3d(0, 0.1 * tick / 120, 0));
    world.step();
    const Grab<double>& grab = world.grabs().list[0];
    told += grab.told.dot(held_point(grab, world.state().x) - before);
  }
  const EnergyFlows& flows = world.energy_balance()->flows;
  CHECK(flows.hands == Approx(told).epsilon(0.01));
  CHECK(flows.hands - flows.drag - flows.damping ==
        Approx(world.report().energies.total() - start).epsilon(0.01));
}
