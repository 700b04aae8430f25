#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// A cloth that was treated with violence comes to rest. Without dashpots, or with a few per cent
// fewer substeps than the rule takes, it stays hot and stretched for ever though every number is
// finite, so no bound of a linear theory may lower that count.

using namespace weft;

namespace {

/// The test cloth that hangs by one edge.
WorldDef hung(int n, double structural) {
  ClothDef cloth = test::flat_cloth(n, n);
  cloth.v = -Vec3d::UnitY();
  cloth.fabric.shear = 0.1 * structural;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 1.1 * structural;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.drag = 5;
  for (Index i = 0; i < n; ++i) def.pins.push_back({i, 0, {}});
  return def;
}

template <class Change>
void change_free_particles(World<float>& world, Change&& change) {
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    if (world.state().inverse_mass[i] > 0) change(i);
  }
  world.accept_state();
}

void hurt(World<float>& world, const std::string& insult) {
  test::Random random(6);
  if (insult == "velocities of 20 m/s") {
    change_free_particles(world, [&](std::size_t i) {
      world.state().v[i] = (random.vector(1).normalized() * 20).cast<float>();
    });
  } else if (insult == "all particles in a ball of 1 mm") {
    change_free_particles(world, [&](std::size_t i) {
      world.state().x[i] = (Vec3d(0.5, -0.5, 0) + random.vector(0.5e-3)).cast<float>();
    });
  } else {
    for (const float z : {3.0F, -3.0F}) {
      world.state().x[0][2] += z;
      world.accept_state();
      for (int tick = 0; z > 0 && tick < 6; ++tick) world.step();
    }
  }
}

}  // namespace

TEST_CASE("5 s after an insult a hanging cloth rests and is stretched by its weight alone") {
  const auto [n, structural] = GENERATE(table<int, double>({{33, 196}, {33, 1962}, {48, 196}}));
  const std::string insult = GENERATE("velocities of 20 m/s", "all particles in a ball of 1 mm",
                                      "a pin 3 m away and back");
  CAPTURE(n, structural, insult);
  World<float> world(hung(n, structural));
  for (int tick = 0; tick < 60; ++tick) world.step();
  hurt(world, insult);
  test::advance(world, 5);
  const Energies& e = world.report().energies;
  // Shaken for ever it would have hundreds of joules of either.
  CHECK(e.kinetic < 1e-4);
  CHECK(e.stretch < 0.2);
  // It hangs: hanging smoothly it has -0.98 J; it may be in folds, which nothing keeps apart.
  CHECK(e.gravity < -0.6);
}
