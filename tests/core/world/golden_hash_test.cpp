#include <cstdint>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/random.h"
#include "tests/support/targets.h"
#include "tests/support/two_threads.h"

// The same bits for any number of threads, in Debug and Release, with gcc and clang. The hashes
// below change with every change of the physics; then they are taken anew from a run of this test,
// and what stays tested is that all builds agree on them.

using namespace weft;
using namespace weft::test;

namespace {

/// A cloth of an irregular triangle mesh that hangs by a corner in the wind and meets the ground.
WorldDef mesh_scene() {
  constexpr int kSide = 25;
  ClothMesh mesh;
  Random random(5);
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      // One after the other: compilers differ in the order of a call's arguments.
      const double y = 0.6 + 0.01 * random.uniform(0, 1);
      const double x = 0.04 * c + 0.01 * random.uniform(0, 1);
      mesh.mesh.positions.emplace_back(x, y, 0.04 * r);
    }
  }
  for (Index r = 0; r + 1 < kSide; ++r) {
    for (Index c = 0; c + 1 < kSide; ++c) {
      const Index a = r * kSide + c, b = a + 1, e = a + kSide, f = e + 1;
      mesh.mesh.triangles.push_back({a, f, b});
      mesh.mesh.triangles.push_back({a, e, f});
    }
  }
  WorldDef def = make_scene("flag");
  def.cloths.resize(1);
  def.cloths[0].mesh = mesh;
  def.colliders = {{"ground", PlaneDef{}}};
  def.pins = {{0, 0, {}}};
  return def;
}

/// A built-in scene, or one of those that only stand here.
WorldDef scene_of(const std::string& name) {
  if (name == "mesh") return mesh_scene();
  const bool xpbd = name == "XPBD", seed = name == "seed's relaxation";
  const bool implicit = name == "implicit";
  if (!xpbd && !seed && !implicit) return make_scene(name);
  WorldDef def = make_scene("curtain");
  if (implicit) {
    def.solver.kind = SolverKind::implicit;
    return def;
  }
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.substeps = xpbd ? 16 : 1;
  def.relaxation.sweeps = xpbd ? 2 : 10;
  def.relaxation.compliance = xpbd ? 1 : 0;
  return def;
}

std::uint64_t hash_after(const std::string& scene, int ticks, Executor* executor) {
  World<float> world(scene_of(scene), {executor, nullptr});
  for (int tick = 0; tick < ticks; ++tick) world.step();
  return world.hash();
}

}  // namespace

TEST_CASE("objects that move leave the same hash with one and two threads") {
  TwoThreads two_threads;
  for (const std::string scene : {"turntable", "lift-sphere"})
    CHECK(hash_after(scene, 120, nullptr) == hash_after(scene, 120, &two_threads));
}

TEST_CASE("each scene has the same hash with one and two threads, and the golden one") {
  const auto [scene, golden] = GENERATE(table<std::string, std::uint64_t>({
      {"default", 0x902c91589c6786bc},
      {"curtain", 0xd0d4ed4d4ab5bfe6},
      {"flag", 0xe045d8608a418edc},
      {"drape-sphere", 0x18dd63f8b29a7a68},
      {"wall", 0x5574d0264b3aa8db},
      {"mesh", 0x4753af4d74e999f8},
      {"XPBD", 0x1b7bcf3f5bc23926},
      {"seed's relaxation", 0xa320213f3833f267},
      {"implicit", 0xa2aa2c978d7ca834},
      {"seed-fig9-default", 0x22f50f0f8c934f75},
      {"seed-fig12-triangle-pairs", 0xca7557428ee9420a},
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
  World<float> world(scene_of(scene));
  std::uint64_t met = 0;
  for (int tick = 0; tick < ticks; ++tick) met += world.step().profile[Stage::contact].work;
  CHECK(met > 0);
  for_each_target([&, &name = scene, count = ticks] {
    CHECK(hash_after(name, count, nullptr) == world.hash());
  });
}

TEST_CASE("meshes, XPBD, the seed and implicit leave the same hash with every instruction set") {
  const std::string scene =
      GENERATE("mesh", "XPBD", "seed's relaxation", "seed-fig9-default", "implicit");
  INFO(scene);
  const std::uint64_t hash = hash_after(scene, 10, nullptr);
  for_each_target([&] { CHECK(hash_after(scene, 10, nullptr) == hash); });
}
