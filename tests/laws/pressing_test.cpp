#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// The force of an object that presses cloth on the ground.

using namespace weft;

namespace {

/// Sheets of 20 cm on the ground, on top of each other, under a plate of 10 cm.
/// @param max_force  of the plate [N]
WorldDef plate_on_layers(int layers, double thickness, double max_force) {
  WorldDef def = test::empty_world(test::flat_cloth(13, 13, 0.2, 0.2));
  ClothDef sheet = def.cloths[0];
  sheet.fabric.thickness = thickness;
  sheet.fabric.areal_density = 0.2;
  def.cloths.clear();
  for (int k = 0; k < layers; ++k) {
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin = Vec3d(-0.1, (k + 1) * (thickness + 1e-5), -0.1);
    sheet.v = Vec3d::UnitZ();
    def.cloths.push_back(sheet);
  }
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  ColliderDef ground, plate;
  ground.name = "ground";
  ground.shape = PlaneDef{Vec3d::Zero(), Vec3d::UnitY()};
  plate.name = "plate";
  plate.shape = BoxDef{Vec3d(0, 0.07, 0), Vec3d(0.05, 0.02, 0.05), Eigen::Quaterniond::Identity()};
  plate.max_force = max_force;
  def.colliders = {ground, plate};
  return def;
}

}  // namespace

TEST_CASE("an object that layers resist presses them with its force, to 15 % after 4 s") {
  struct Case {
    int layers;
    double thickness, max_force;  // [m], [N]
  };
  for (const auto& [layers, thickness, max_force] :
       {Case{2, 2e-3, 50}, Case{3, 2e-3, 5}, Case{4, 5e-4, 5}}) {
    World<float> world(plate_on_layers(layers, thickness, max_force));
    world.measure_forces(true);
    MoveDef down;
    down.target.position = Vec3d::Zero();
    down.speed = 0.1;
    REQUIRE(world.move_collider(1, down));
    test::advance(world, 4);
    constexpr int kTicks = 60;
    double pressed = 0;
    for (int t = 0; t < kTicks; ++t) {
      world.step();
      pressed -= world.reactions()->colliders[1][1] / kTicks;
    }
    INFO(layers << " layers of " << thickness << " m");
    CHECK(std::abs(pressed) == Approx(max_force).epsilon(0.15));
  }
}
