#include <memory>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/support/worlds.h"

// The forces that jaws are told to press with, and those that they are told to feel.

using namespace weft;

namespace {

/// Open jaws that close along z.
/// @param half   of a face's side [m]
/// @param force  of each [N]
GripperDef jaws_at(const Vec3d& centre, double half, double force) {
  GripperDef gripper;
  gripper.centre = centre;
  gripper.orientation = Eigen::AngleAxisd(-1.5707963267948966, Vec3d::UnitY());
  gripper.half_extents = Vec3d(0.005, half, half);
  gripper.opening = 0.04;
  gripper.force = force;
  return gripper;
}

void close(World<float>& world) {
  GripperCommand command;
  command.opening = 0;
  REQUIRE(world.command_gripper(0, command));
}

/// Two sheets of 20 cm that hang between jaws along their upper edge, held at the lower one too.
/// @param load  their weight over what friction with both jaws holds [1]
WorldDef two_hanging_sheets(double load) {
  constexpr double kForce = 5, kFriction = 0.3;
  WorldDef def = test::empty_world(test::flat_cloth(13, 13, 0.2, 0.2));
  ClothDef sheet = def.cloths[0];
  sheet.fabric.thickness = 2e-3;
  sheet.fabric.friction = kFriction;
  sheet.fabric.areal_density = load * 2 * kFriction * kForce / (2 * 0.2 * 0.2 * 9.81);
  def.cloths.clear();
  for (int k = 0; k < 2; ++k) {
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin = Vec3d(-0.1, 1, (k - 0.5) * 2.01e-3);
    sheet.v = -Vec3d::UnitY();
    def.cloths.push_back(sheet);
    PinDef pin;
    pin.place = EdgeStrip{Side::bottom, 0};
    pin.cloth = sheet.name;
    def.pins.push_back(pin);
  }
  def.contact.seed.self = SelfContact::guard;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.grippers = {jaws_at(Vec3d(0, 0.98, 0), 0.02, kForce)};
  def.grippers[0].half_extents[2] = 0.11;
  return def;
}

/// A sheet of 20 x 28 cm, 2 mm thick, that hangs from closed jaws, and by its upper edge too.
std::unique_ptr<World<float>> sheet_in_jaws(const std::string& fabric, Index rows, Index columns) {
  ClothDef sheet = test::flat_cloth(rows, columns, 0.2, 0.28);
  sheet.fabric = make_fabric(fabric);
  sheet.fabric.thickness = 2e-3;
  sheet.origin = Vec3d(-0.1, 1.03, 0);
  sheet.v = -Vec3d::UnitY();
  WorldDef def = test::empty_world(sheet);
  def.contact.seed.self = SelfContact::guard;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.pins = {{EdgeStrip{Side::top, 0}}};
  def.grippers = {jaws_at(Vec3d(0, 1, 0), 0.02, 8)};
  def.grippers[0].half_extents = Vec3d(0.004, 0.02, 0.08);
  auto world = std::make_unique<World<float>>(def);
  close(*world);
  test::advance(*world, 2);
  REQUIRE(world->grippers()[0].gripping);
  return world;
}

/// The same world with cloth of another thickness [m].
std::unique_ptr<World<float>> with_thickness(const World<float>& world, double thickness) {
  FabricDef fabric = world.def().cloths[0].fabric;
  fabric.thickness = thickness;
  std::unique_ptr<World<float>> changed = world.with_fabric(0, fabric);
  changed->measure_forces(true);
  return changed;
}

/// Mean force of the coming half second with which the jaws press [N].
double pressed_by(World<float>& world) {
  double pressed = 0;
  for (int t = 0; t < 30; ++t) {
    world.step();
    for (const Vec3d& on_jaw : world.reactions()->colliders) pressed += on_jaw.norm() / 60;
  }
  return pressed;
}

}  // namespace

TEST_CASE("jaws press any number of layers with their force, to 15 % after 3 s") {
  for (const int layers : {1, 2, 3, 5}) {
    for (const double force : {0.5, 5.0}) {
      WorldDef def = test::empty_world(test::flat_cloth(13, 13, 0.2, 0.2));
      ClothDef sheet = def.cloths[0];
      sheet.fabric.thickness = 2e-3;
      sheet.fabric.areal_density = 0.2;
      def.cloths.clear();
      for (int k = 0; k < layers; ++k) {
        sheet.name = "sheet" + std::to_string(k);
        sheet.origin = Vec3d(-0.1, 0.1, (k - 0.5 * (layers - 1)) * 2.01e-3);
        sheet.v = -Vec3d::UnitY();
        def.cloths.push_back(sheet);
      }
      def.contact.seed.self = SelfContact::guard;
      def.environment.damping = 1;
      def.grippers = {jaws_at(Vec3d::Zero(), 0.02, force)};
      World<float> world(def);
      world.measure_forces(true);
      close(world);
      test::advance(world, 3);
      REQUIRE(world.grippers()[0].gripping);
      constexpr int kTicks = 30;
      double pressed = 0;
      for (int t = 0; t < kTicks; ++t) {
        world.step();
        for (const Vec3d& on_jaw : world.reactions()->colliders)
          pressed += on_jaw.norm() / (2 * kTicks);
      }
      INFO(layers << " layers");
      CHECK(pressed == Approx(force).epsilon(0.15));
    }
  }
}

TEST_CASE("a pin and jaws carry a cloth's weight and nothing across, wherever the jaws' rims lie") {
  // Particles are 2 cm apart, from -0.2 m on.
  for (const double middle : {0.14, 0.15, 0.1695, 0.1705}) {
    for (const double waited : {0.0, 1.5}) {
      ClothDef cloth = test::flat_cloth(21, 21);
      cloth.fabric.areal_density = 0.3;
      cloth.fabric.friction = 0.6;
      cloth.fabric.bending_damping = 0.005;
      cloth.width = cloth.height = 0.4;
      cloth.origin = Vec3d(-0.2, 1.2, 0);
      cloth.v = -Vec3d::UnitY();
      WorldDef def = test::empty_world(cloth);
      def.environment.gravity = Vec3d(0, -9.81, 0);
      def.environment.damping = 5;
      def.grippers = {jaws_at(Vec3d(middle, 1.18, 0), 0.03, 5)};
      def.pins = {{Corner::top_left, 0.03, {}}, {Corner::bottom_right, 0, {}}};
      World<float> world(def);
      double weight = 0;
      for (const float mass : world.model().mass) weight += 9.81 * static_cast<double>(mass);
      world.measure_forces(true);
      test::advance(world, waited);
      close(world);
      test::advance(world, 1.2);
      REQUIRE(world.grippers()[0].gripping);
      world.unpin(world.pins().list[1].id);
      test::advance(world, 5);
      constexpr int kTicks = 30;
      Vec3d sum = Vec3d::Zero();
      for (int t = 0; t < kTicks; ++t) {
        world.step();
        for (const PinReaction& pin : world.reactions()->pins) sum += pin.force / kTicks;
        for (const Vec3d& on_object : world.reactions()->colliders) sum -= on_object / kTicks;
      }
      INFO("jaws at " << middle << " m after " << waited << " s: across " << sum[0] << ", "
                      << sum[2] << " N");
      CHECK((sum - Vec3d(0, weight, 0)).norm() < 0.002 * weight);
    }
  }
}

TEST_CASE("jaws hold two layers at 0.9 of what friction with both allows, and not at 1.1") {
  for (const double load : {0.5, 0.9, 1.1}) {
    World<float> world(two_hanging_sheets(load));
    close(world);
    test::advance(world, 1);
    REQUIRE(world.grippers()[0].gripping);
    while (!world.pins().list.empty()) world.unpin(world.pins().list.front().id);
    test::advance(world, 2);
    const double before = test::centre_of_mass(world)[1];
    test::advance(world, 3);
    const double slipped = before - test::centre_of_mass(world)[1];
    INFO("load " << load << " slips by " << slipped << " m in 3 s");
    if (load < 1)
      CHECK(std::abs(slipped) < 2e-4);
    else
      CHECK(slipped > 0.01);
  }
}

TEST_CASE(
    "cloth that becomes thicker than its cells pushes jaws open, is held, and loses no tick") {
  struct Case {
    const char* fabric;
    Index rows, columns;
    double thickness;
  };
  // Cells of 17, 17, 20 and 12 mm.
  for (const Case& c : {Case{"cotton", 17, 13, 0.013}, Case{"cotton", 17, 13, 0.016},
                        Case{"denim", 15, 15, 0.02}, Case{"leather", 25, 19, 0.012}}) {
    std::unique_ptr<World<float>> world = sheet_in_jaws(c.fabric, c.rows, c.columns);
    world->unpin(world->pins().list[0].id);
    test::advance(*world, 1);
    world = with_thickness(*world, c.thickness);
    const double before = test::centre_of_mass(*world)[1];
    double strain = 0;
    for (int t = 0; t < 60; ++t) {
      REQUIRE_FALSE(world->step().divergence);
      strain = std::max(strain, world->report().largest_strain);
    }
    INFO(c.fabric << " of " << c.thickness << " m");
    CHECK(strain < 0.15);
    CHECK(world->grippers()[0].opening == Approx(2 * c.thickness).epsilon(1e-3));
    CHECK(pressed_by(*world) == Approx(8).epsilon(0.05));
    CHECK(std::abs(test::centre_of_mass(*world)[1] - before) < 0.003);
  }
}

TEST_CASE(
    "jaws that thicker cloth has pushed open close again on what becomes thin, and press it") {
  std::unique_ptr<World<float>> world = sheet_in_jaws("cotton", 17, 13);
  world = with_thickness(*world, 0.016);
  test::advance(*world, 1);
  world = with_thickness(*world, 2e-3);
  test::advance(*world, 1);
  CHECK(world->grippers()[0].opening == Approx(4e-3).epsilon(1e-3));
  CHECK(pressed_by(*world) == Approx(8).epsilon(0.05));
}
