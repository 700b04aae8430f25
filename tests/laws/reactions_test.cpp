#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/weight.h"
#include "tests/support/worlds.h"

// What holds a cloth carries its weight.

using namespace weft;

namespace {

using test::kGravity, test::weight_of;

/// A sheet of 12 x 14 particles in the plane y = `height`, with gravity and much damping.
WorldDef sheet_at(double height) {
  ClothDef cloth = test::flat_cloth(12, 14);
  cloth.origin[1] = height;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 5;
  return def;
}

Vec3d sum_of_pins(const Reactions& reactions) {
  Vec3d sum = Vec3d::Zero();
  for (const PinReaction& pin : reactions.pins) sum += pin.force;
  return sum;
}

}  // namespace

TEST_CASE("the pins of a cloth that hangs at rest carry its weight, and nothing across") {
  WorldDef def = sheet_at(1);
  def.environment.damping = 8;
  def.pins = {{Corner::top_left, 0.05}, {Corner::top_right, 0.05}, {0, 0}};
  World<float> world(def);
  test::advance(world, 12);
  const Reactions reactions = world.coming_reactions();
  REQUIRE(reactions.pins.size() == 3);
  const Vec3d sum = sum_of_pins(reactions);
  CHECK(sum[1] == Approx(weight_of(world)).epsilon(1e-3));
  CHECK(std::hypot(sum[0], sum[2]) < weight_of(world) * 1e-3);
  // Two corners alike, but for what the third pin shares with the first.
  CHECK(reactions.pins[0].force[1] + reactions.pins[2].force[1] ==
        Approx(reactions.pins[1].force[1]).epsilon(0.02));
}

TEST_CASE("the pins of a mesh carry its weight, whatever its membrane") {
  ClothDef sheet = test::triangle_sheet(test::Cut::irregular, 0.4, 0.3, 0.05, 0.5);
  sheet.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  WorldDef def = test::empty_world(sheet);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 8;
  def.pins = test::upper_border(sheet);
  World<float> world(def);
  test::advance(world, 6);
  const Vec3d sum = sum_of_pins(world.coming_reactions());
  CHECK(sum[1] == Approx(weight_of(world)).epsilon(1e-3));
  CHECK(std::hypot(sum[0], sum[2]) < weight_of(world) * 1e-3);
}

TEST_CASE("the strip that holds a curtain carries its weight") {
  WorldDef def = make_scene("default");
  def.environment = EnvironmentDef{};
  def.environment.damping = 8;
  def.colliders.clear();
  World<float> world(def);
  test::advance(world, 12);
  const Vec3d sum = sum_of_pins(world.coming_reactions());
  CHECK(sum[1] == Approx(weight_of(world)).epsilon(1e-3));
}

TEST_CASE("the pins of cloth that lies crumpled on itself carry all of its weight") {
  // Drawn sideways by more than its weight, it hangs from a strip and folds upon itself.
  ClothDef cloth = test::flat_cloth(8, 16, 0.9376, 0.8933);
  cloth.fabric = make_fabric("cotton");
  cloth.fabric.areal_density = 0.3;
  cloth.fabric.shear = 25.72;
  cloth.fabric.shear_damping = 0.0173;
  cloth.fabric.bending_damping = 0;
  cloth.fabric.friction = 0.3;
  cloth.fabric.thickness = GENERATE(1e-3, 2e-3, 3e-3);
  cloth.origin = Vec3d(-0.4931, 0.8362, 0.0169);
  cloth.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(-18.34, -0.1018, -0.7848);
  def.environment.damping = 5;
  def.tick_rate = 30;
  def.contact.seed.self = SelfContact::guard;
  def.pins = {{EdgeStrip{Side::left, 0.0612}}, {MaterialPoint{0.3202, 0.5707}}};
  World<float> world(def);
  test::advance(world, 8);
  world.measure_forces(true);
  const auto momentum = [&world] {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < world.state().v.size(); ++i)
      sum += world.state().v[i].cast<double>() * static_cast<double>(world.model().mass[i]);
    return sum;
  };
  const Vec3d before = momentum();
  Vec3d pins = Vec3d::Zero(), drag = Vec3d::Zero();
  const int ticks = 60;
  for (int t = 0; t < ticks; ++t) {
    drag += momentum() * def.environment.damping / ticks;
    world.step();
    pins += sum_of_pins(*world.reactions()) / ticks;
  }
  const double seconds = ticks * world.tick_seconds();
  const Vec3d weight = def.environment.gravity * (weight_of(world) / kGravity);
  const Vec3d lack = pins + weight - drag - (momentum() - before) / seconds;
  CAPTURE(cloth.fabric.thickness, lack / weight.norm());
  CHECK(lack.norm() < 0.002 * weight.norm());
}

TEST_CASE("what a sheet lies on carries its weight: ground and box, moving or still") {
  const auto shape = GENERATE(as<ShapeDef>(), ShapeDef{PlaneDef{}},
                              ShapeDef{BoxDef{Vec3d(0, -0.5, 0), Vec3d(2, 0.5, 2)}});
  const bool moving = GENERATE(false, true);
  CAPTURE(shape.index(), moving);
  WorldDef def = sheet_at(0.01);
  def.colliders = {{"table", shape}};
  World<float> world(def);
  double expected = weight_of(world);
  if (moving) {
    MoveDef up{rest_pose(shape), 0.02, 1};
    up.target.position[1] += 0.2;
    world.move_collider(0, up);
    expected *= 1 + def.environment.damping * up.speed / kGravity;
  }
  test::advance(world, 3);
  const Reactions reactions = world.coming_reactions();
  CHECK(-reactions.colliders[0][1] == Approx(expected).epsilon(1e-3));
  double normal = 0;
  for (const ContactPoint& contact : reactions.contacts) {
    CHECK(contact.collider == 0);
    CHECK(contact.normal[1] == Approx(1).epsilon(1e-4));
    CHECK(contact.gap == Approx(def.cloths[0].fabric.thickness).epsilon(0.1));
    normal += contact.normal_force;
  }
  CHECK(normal == Approx(expected).epsilon(1e-3));
  CHECK(reactions.contacts.size() >= world.model().mass.size());
}

TEST_CASE("the gap of a contact is its distance from the ball, also while cloth slips off it") {
  constexpr double kRadius = 0.1;
  WorldDef def = sheet_at(0.01);
  def.cloths[0].fabric.friction = 0.05;
  const Vec3d centre = def.cloths[0].origin + Vec3d(0.6 * def.cloths[0].width, -0.01 - kRadius, 0);
  def.colliders = {{"ball", SphereDef{centre, kRadius}}};
  World<float> world(def);
  world.measure_forces(true);
  std::size_t contacts = 0;
  for (int t = 0; t < 90; ++t) {
    world.step();
    for (const ContactPoint& contact : world.reactions()->contacts) {
      const double distance = (contact.point - centre).norm() - kRadius;
      REQUIRE(contact.gap == Approx(distance).margin(1e-5));
      ++contacts;
    }
  }
  CHECK(contacts > 50);
}

TEST_CASE("friction holds a sheet on a slope: its sum is the weight along it") {
  WorldDef def = sheet_at(0.004);
  def.cloths[0].fabric.friction = 1;
  const double angle = 0.3;  // gravity leans instead of the ground
  def.environment.gravity = kGravity * Vec3d(std::sin(angle), -std::cos(angle), 0);
  def.colliders = {{"ground", PlaneDef{}}};
  World<float> world(def);
  test::advance(world, 2);
  Vec3d friction = Vec3d::Zero();
  for (const ContactPoint& contact : world.coming_reactions().contacts) {
    friction += contact.friction;
    CHECK(contact.friction.norm() <= contact.normal_force * 1.0001 + 1e-9);
  }
  CHECK(-friction[0] == Approx(weight_of(world) * std::sin(angle)).epsilon(0.01));
}

TEST_CASE("of two sheets the lower one carries the upper one's weight at each tick") {
  WorldDef def = sheet_at(0.006);
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "upper";
  def.cloths[1].origin += Vec3d(0.013, 0.006, 0.017);
  def.contact.seed.self = SelfContact::guard;
  def.colliders = {{"ground", PlaneDef{}}};
  World<float> world(def);
  test::advance(world, 3);
  world.measure_forces(true);
  for (int t = 0; t < 60; ++t) {
    world.step();
    REQUIRE(world.reactions());
    double between = 0;
    for (const ContactPoint& contact : world.reactions()->contacts) {
      if (contact.collider != kNone) continue;
      const bool up = contact.particle[0] >= world.model().parts[1].particles.first;
      between += (up ? 1 : -1) * contact.force()[1];
    }
    REQUIRE(between == Approx(weight_of(world) / 2).epsilon(0.02));
  }
}

TEST_CASE(
    "sheets nearer to the ground and each other than their thickness come apart at their weight") {
  const double thickness = GENERATE(0.004, 0.01);
  CAPTURE(thickness);
  WorldDef def = test::empty_world(test::flat_cloth(13, 13, 0.4, 0.4));
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.environment.damping = 0.5;
  ClothDef& lower = def.cloths[0];
  lower.fabric = fabric_presets().front().fabric;
  lower.fabric.thickness = thickness;
  lower.origin[1] = 0.3 * thickness;
  def.cloths.push_back(lower);
  def.cloths[1].name = "upper";
  def.cloths[1].origin[1] = 0.57 * thickness;
  def.contact.seed.self = SelfContact::guard;
  def.colliders = {{"ground", PlaneDef{}}};
  World<float> world(def);
  world.measure_forces(true);
  test::advance(world, 2);
  for (int t = 0; t < 60; ++t) {
    world.step();
    REQUIRE(-world.reactions()->colliders[0][1] == Approx(weight_of(world)).epsilon(0.02));
  }
  const auto upper = static_cast<std::size_t>(world.model().parts[1].particles.first);
  for (std::size_t i = 0; i < upper; ++i) {
    REQUIRE(static_cast<double>(world.state().x[i][1]) > 0.98 * thickness);
    REQUIRE(static_cast<double>(world.state().x[upper + i][1]) > 1.85 * thickness);
  }
}

TEST_CASE("a sheet that falls on a held one gets in each tick what is told that they press with") {
  WorldDef def = sheet_at(0);
  def.environment.damping = 0;
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "upper";
  def.cloths[1].origin += Vec3d(0.013, 0.05, 0.017);
  def.contact.seed.self = SelfContact::guard;
  for (const Side side : {Side::top, Side::bottom, Side::left, Side::right})
    def.pins.push_back({EdgeStrip{side, 0}});
  World<float> world(def);
  world.measure_forces(true);
  const IndexRange upper = world.model().parts[1].particles;
  const auto momentum = [&] {
    double sum = 0;
    for (Index i = upper.first; i < upper.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      sum += static_cast<double>(world.state().v[k][1] * world.model().mass[k]);
    }
    return sum;
  };
  double most = 0, off = 0;
  for (int t = 0; t < 60; ++t) {
    const double before = momentum();
    world.step();
    double told = 0;
    for (const ContactPoint& contact : world.reactions()->contacts) {
      for (std::size_t k = 0; k < 4; ++k)
        if (upper.contains(contact.particle[k])) told += contact.force()[1] * contact.weight[k];
    }
    const double pressed = (momentum() - before) / world.tick_seconds() + weight_of(world) / 2;
    most = std::max(most, pressed);
    off = std::max(off, std::abs(told - pressed));
  }
  CHECK(most > weight_of(world));
  CHECK(off < 0.03 * most);
}

TEST_CASE("to ask for forces changes nothing, and the coming forces are those that come") {
  WorldDef def = sheet_at(0.05);
  def.environment.wind = Vec3d(1, 0, 0);
  def.pins = {{Corner::top_left, 0.1}};
  def.colliders = {{"ground", PlaneDef{}}, {"ball", SphereDef{Vec3d(0, 0, 0), 0.04}}};
  def.contact.seed.self = GENERATE(SelfContact::none, SelfContact::guard);
  def.solver.kind = GENERATE(SolverKind::verlet, SolverKind::relaxation, SolverKind::implicit);
  World<float> asked(def), left(def);
  left.measure_forces(true);
  asked.grab({30, {0.2, 0.3, 0.5}, 0.05, 100, 50, Vec3d(0, 0.3, 0)});
  left.grab({30, {0.2, 0.3, 0.5}, 0.05, 100, 50, Vec3d(0, 0.3, 0)});
  for (int t = 0; t < 40; ++t) {
    const Reactions coming = asked.coming_reactions();
    asked.step();
    left.step();
    REQUIRE(asked.hash() == left.hash());
    REQUIRE_FALSE(asked.reactions());
    const Reactions& now = *left.reactions();
    REQUIRE(coming.tick == now.tick);
    REQUIRE(coming.contacts.size() == now.contacts.size());
    for (std::size_t k = 0; k < now.contacts.size(); ++k)
      REQUIRE(coming.contacts[k].force() == now.contacts[k].force());
    REQUIRE(coming.pins.size() == now.pins.size());
    for (std::size_t k = 0; k < now.pins.size(); ++k)
      REQUIRE(coming.pins[k].force == now.pins[k].force);
  }
}

TEST_CASE("of two pins on the same particles the one that rests bears all, if the other moves") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 2;
  def.cloths[0].fabric.stretch_damping = 0.01;
  const PinDef strip{EdgeStrip{Side::top, 0}, 0, {}};
  def.pins = {strip};
  World<float> world(def);
  world.measure_forces(true);
  const bool moves = GENERATE(false, true);
  const PinId second = world.pin(strip);
  if (moves) {
    const auto centre = static_cast<std::size_t>(world.pins().list.back().centre);
    world.move_pin(second, {world.state().x[centre].cast<double>() + Vec3d(0, 2, 0), 0.5});
  }
  test::advance(world, 8);
  double mass = 0, told = 0;
  for (const float m : world.model().mass) mass += static_cast<double>(m);
  for (const PinReaction& pin : world.reactions()->pins) told += pin.force.y();
  CHECK(world.reactions()->pins.size() == 2);
  CHECK(told == Approx(mass * 9.81).epsilon(0.01));
}

TEST_CASE("the seed's contact, which does not know its impulses, tells no force on objects") {
  WorldDef def = test::empty_world(test::flat_cloth(5, 5, 0.4, 0.4));
  def.contact.model = ContactModel::seed;
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -0.5, 0), Vec3d::UnitY()}}};
  World<float> world(def);
  world.measure_forces(true);
  world.step();
  CHECK(world.reactions()->colliders.empty());
}
