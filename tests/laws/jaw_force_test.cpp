#include <catch2/catch.hpp>

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
