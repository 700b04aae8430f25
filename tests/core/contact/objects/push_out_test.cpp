#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/contact/objects/constants.h"
#include "core/world/world.h"
#include "tests/support/cylinders.h"
#include "tests/support/worlds.h"

// Cloth that becomes thicker while it lies on objects: it is lifted, and not thrown.

using namespace weft;

namespace {

/// Mean height of the particles that lie within a rectangle about the y axis, above some height.
double mean_height(const World<float>& world, double half_x, double half_z, double above) {
  double sum = 0;
  int count = 0;
  for (const Vec3f& x : world.state().x) {
    const Vec3d place = x.cast<double>();
    if (std::abs(place[0]) > half_x || std::abs(place[2]) > half_z || place[1] < above) continue;
    sum += place[1];
    ++count;
  }
  REQUIRE(count > 0);
  return sum / count;
}

}  // namespace

TEST_CASE("cloth that hangs over a box is lifted by what it becomes thicker, and not thrown") {
  constexpr double kTop = 0.5, kThicker = 0.008, kGravity = 9.81;
  const int substeps = GENERATE(1, 200);
  CAPTURE(substeps);
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth = test::flat_cloth(25, 25, 0.9, 0.9);
  cloth.origin = Vec3d(-0.45, kTop + 0.005, -0.45);
  cloth.fabric = make_fabric("cotton");
  def.colliders = {{"box", BoxDef{Vec3d(0, kTop / 2, 0), Vec3d(0.25, kTop / 2, 0.2)}}};
  def.solver.min_substeps = substeps;
  World<float> at_rest(def);
  test::settle(at_rest, 4, 5);
  EnvironmentDef environment = at_rest.environment();
  environment.damping = 0;
  at_rest.set_environment(environment);
  FabricDef thick = cloth.fabric;
  thick.thickness += kThicker;
  const std::unique_ptr<World<float>> world = at_rest.with_fabric(0, thick);
  world->measure_energy(true);
  double mass = 0;
  for (const float m : world->model().mass) mass += static_cast<double>(m);
  const double start = world->report().energies.total(), top = mean_height(*world, 0.2, 0.15, 0.4);
  double most = 0, rise = 0, kinetic = 0;
  for (int tick = 0; tick < 40; ++tick) {
    REQUIRE_FALSE(world->step().divergence);
    most = std::max(most, world->report().energies.total() - start);
    kinetic = std::max(kinetic, world->report().energies.kinetic);
    rise = mean_height(*world, 0.2, 0.15, 0.4) - top;
    CHECK(rise < 1.02 * kThicker);
  }
  const double lift = mass * kGravity * kThicker;
  CHECK(most < 2 * lift);
  CHECK(kinetic < 0.3 * lift);
  CHECK(rise > 0.98 * kThicker);
}

TEST_CASE("cloth rolled on a cylinder that becomes thicker goes out as it is pushed, no faster") {
  constexpr double kRadius = 0.1985, kThicker = 0.0026;
  const bool mesh = GENERATE(true, false);
  CAPTURE(mesh);
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.mesh =
      ClothMesh{test::rolled(kRadius + 0.0005, std::numbers::pi / 3, 48, 24, 1.2, 0.95), {}};
  cloth.fabric = make_fabric("cotton");
  cloth.fabric.thickness = 0.0004;
  def.environment.gravity.setZero();
  def.environment.air_density = 0;
  ShapeDef shape = CapsuleDef{Vec3d(0, 0, 0), Vec3d(0, 2, 0), kRadius};
  if (mesh) shape = MeshDef{test::rolled(kRadius, 2 * std::numbers::pi, 64, 60, 2, 0)};
  def.colliders = {{"cylinder", shape}};
  const World<float> at_rest(def);
  FabricDef thick = cloth.fabric;
  thick.thickness += kThicker;
  const std::unique_ptr<World<float>> world = at_rest.with_fabric(0, thick);
  const auto farthest = [&world] {
    double far = 0;
    for (const Vec3f& x : world->state().x)
      far = std::max(far, static_cast<double>(std::hypot(x[0], x[2])));
    return far;
  };
  double most = 0, fastest = 0;
  for (int tick = 0; tick < 12; ++tick) {
    const Vec3d before = test::centre_of_mass(*world);
    const double far = farthest();
    REQUIRE_FALSE(world->step().divergence);
    most = std::max(most, farthest() - far);
    fastest = std::max(fastest, (test::centre_of_mass(*world) - before).norm());
  }
  const double pushed = kPushOutSpeed * world->tick_seconds();
  CHECK(fastest < 1.2 * pushed);
  CHECK(most < 1.3 * pushed);
  CHECK(farthest() > kRadius + thick.thickness);
}
