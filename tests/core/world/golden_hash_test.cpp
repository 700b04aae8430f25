#include <cstdint>

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/two_threads.h"

// The same bits for any number of threads, in Debug and Release, with gcc and clang. The hashes
// below change with every change of the physics; then they are taken anew from a run of this test,
// and what stays tested is that all builds agree on them.

using namespace weft;
using namespace weft::test;

namespace {

std::uint64_t hash_after(const std::string& scene, int ticks, Executor* executor) {
  World<float> world(make_scene(scene), {executor, nullptr});
  for (int tick = 0; tick < ticks; ++tick) world.step();
  return world.hash();
}

/// Lets the program use these instruction sets alone; 0 for all that there are.
void use_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

TEST_CASE("objects that move leave the same hash with one and two threads") {
  TwoThreads two_threads;
  for (const std::string scene : {"turntable", "lift-sphere"})
    CHECK(hash_after(scene, 120, nullptr) == hash_after(scene, 120, &two_threads));
}

TEST_CASE("each scene has the same hash with one and two threads, and the golden one") {
  const auto [scene, golden] = GENERATE(table<std::string, std::uint64_t>({
      {"default", 0xd3dfd47ae7fdd162},
      {"curtain", 0x1507b3829ba2c29d},
      {"flag", 0xdb51bdd00d585de5},
      {"drape-sphere", 0xb31819e8dc8cd5ee},
      {"wall", 0xa34f12525f405789},
  }));
  INFO(scene);
  TwoThreads two_threads;
  const std::uint64_t alone = hash_after(scene, 60, nullptr);
  CHECK(alone == hash_after(scene, 60, &two_threads));
  CHECK(alone == golden);
}

TEST_CASE("scenes full of contact leave the same hash with every instruction set") {
  const auto [scene, ticks] = GENERATE(table<std::string, int>({
      {"default", 30},
      {"drape-sphere", 10},
      {"gripper", 10},
      {"hard-knives", 15},
      {"hard-tablecloth", 15},
  }));
  INFO(scene);
  use_targets(0);
  const std::int64_t all = hwy::SupportedTargets();
  World<float> world(make_scene(scene));
  std::uint64_t met = 0;
  for (int tick = 0; tick < ticks; ++tick) met += world.step().profile[Stage::contact].work;
  CHECK(met > 0);
  int tried = 0;
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    use_targets(left & -left);
    INFO(hwy::TargetName(left & -left));
    CHECK(hash_after(scene, ticks, nullptr) == world.hash());
    ++tried;
  }
  use_targets(0);
  CHECK(tried > 1);
}
