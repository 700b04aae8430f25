#include "core/world/reactions.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// What holds a cloth gets the opposite of what it gives.

using namespace weft;

namespace {

const Vec3d kGravity(0, -9.81, 0);

Vec3d momentum(const World<double>& world) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < world.state().v.size(); ++i)
    sum += world.state().v[i] * world.model().mass[i];
  return sum;
}

double mass_of(const World<double>& world) {
  double sum = 0;
  for (const double m : world.model().mass) sum += m;
  return sum;
}

/// Forces of pins on a cloth that falls around them, after some ticks.
std::vector<Vec3d> forces_of(const std::vector<PinDef>& pins) {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.environment.gravity = kGravity;
  def.pins = pins;
  World<double> world(def);
  world.measure_forces(true);
  test::advance(world, 0.2);
  std::vector<Vec3d> forces;
  for (const PinReaction& pin : world.reactions()->pins) forces.push_back(pin.force);
  REQUIRE(forces.size() == pins.size());
  return forces;
}

}  // namespace

TEST_CASE("in each tick objects get the momentum that gravity gave and the cloth has not") {
  ClothDef cloth = test::flat_cloth(9, 9, 0.4, 0.4);
  cloth.origin = Vec3d(-0.15, 0.01, -0.2);
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = kGravity;
  def.colliders = {{"box", BoxDef{Vec3d(0, -0.1, 0), Vec3d(0.1, 0.1, 0.1)}},
                   {"ground", PlaneDef{Vec3d(0, -0.1, 0), Vec3d::UnitY()}}};
  // Steps so short that no particle leaves its reach and is held there, which is no object's force.
  def.solver.min_substeps = 80;
  World<double> world(def);
  world.measure_forces(true);
  Vec3d most = Vec3d::Zero();
  for (int tick = 0; tick < 40; ++tick) {
    const Vec3d before = momentum(world);
    REQUIRE_FALSE(world.step().divergence);
    const std::vector<Vec3d>& on = world.reactions()->colliders;
    const Vec3d left = before + kGravity * mass_of(world) * world.tick_seconds() - momentum(world);
    REQUIRE((on[0] + on[1] - left / world.tick_seconds()).norm() < 1e-12);
    for (int k = 0; k < 2; ++k) most[k] = std::max(most[k], -on[static_cast<std::size_t>(k)][1]);
  }
  CHECK(most[0] > 0.1);
  CHECK(most[1] > 0.1);
}

TEST_CASE("pins that hold the same particles share their force evenly, as if one held them") {
  const PinDef wide{Corner::top_left, 0.3, {}}, narrow{Corner::top_left, 0.13, {}};
  const Vec3d alone = forces_of({wide})[0];
  CHECK(alone.norm() > 0.1);
  for (const Vec3d& shared : forces_of({wide, wide})) CHECK(2 * shared == alone);
  const std::vector<Vec3d> unlike = forces_of({wide, narrow, narrow});
  CHECK(unlike[1] == unlike[2]);
  CHECK(unlike[1].norm() > 0.01);
  CHECK((unlike[0] + unlike[1] + unlike[2] - alone).norm() < 1e-12 * alone.norm());
}
