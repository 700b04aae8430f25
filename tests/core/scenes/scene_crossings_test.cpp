#include <iostream>
#include <string>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/crossing_counter.h"
#include "tests/support/installed_meshes.h"

// In every built-in scene that promises it nothing crosses, at each tick. The hard cases have their
// own verdicts (tests/stability); those of the seed promise nothing.

using namespace weft;
using namespace weft::test;

namespace {

bool is_ordinary(const SceneInfo& scene) {
  return !scene.name.starts_with("hard-") && !scene.name.starts_with("seed-");
}

/// Runs each of them, and counts after each tick that its verdict does not leave out.
/// @return how many there were
int check_scenes(int ticks) {
  int looked_at = 0;
  for (const SceneInfo& scene : scenes()) {
    if (!is_ordinary(scene) || !is_installed(scene)) continue;
    ++looked_at;
    World<float> world(make_scene(scene.name, mesh_directory()));
    REQUIRE(world.guard() != nullptr);
    CrossingCounter<float> counter;
    std::size_t cloths = 0, objects = 0;
    std::uint64_t first = 0;
    double deepest = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      world.step();
      if (world.report().time <= world.def().verdict.clear_after) continue;
      const WorldCrossings found = counter.count(world);
      if (found.total() > 0 && first == 0) first = world.tick();
      cloths += found.cloths.proper + found.cloths.touching;
      objects += found.objects.proper + found.objects.touching;
      deepest = std::max(deepest, world.deepest_penetration());
    }
    INFO(scene.name << ": " << cloths << " of cloths, " << objects << " with objects, from tick "
                    << first << " on");
    CHECK(cloths == 0);
    CHECK(objects == 0);
    CHECK(deepest == 0);
  }
  return looked_at;
}

}  // namespace

TEST_CASE("in the first second of every ordinary scene nothing crosses, at each tick") {
  CHECK(check_scenes(60) >= 14);
}

TEST_CASE("in 600 ticks of every ordinary scene nothing crosses, at each tick", "[.long]") {
  CHECK(check_scenes(600) >= 14);
}
