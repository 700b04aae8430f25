#include "tests/core/contact/drags.h"

#include <cmath>
#include <ctime>
#include <string>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/scene_parts.h"
#include "core/scenes/scenes.h"
#include "tests/support/installed_meshes.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets.h"

// Random hands pull a cloth about over what it lies on. A seed decides all of it.

using namespace weft;
using namespace weft::test;

namespace {

/// A sheet of cotton, thick by a quarter of its edges, that falls upright and crumples.
WorldDef pile(int n) {
  WorldDef def = upright_sheet(n, 0.8, 0.85, 0.25, 0.5, make_fabric("cotton"));
  def.name = "pile";
  return def;
}

/// A built-in scene with as many particles a side.
WorldDef scene(const char* name, int n) {
  WorldDef def = make_scene(name, mesh_directory());
  def.cloths[0].rows = def.cloths[0].columns = n;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

/// A thin star with five points, of triangles that are sharp on all sides.
TriangleMesh star(double size) {
  constexpr Index kPoints = 5;
  TriangleMesh mesh;
  mesh.positions = {Vec3d(0, 0.08 * size, 0), Vec3d(0, -0.08 * size, 0)};
  for (Index k = 0; k < 2 * kPoints; ++k) {
    const double radius = size * (k % 2 == 0 ? 1 : 0.3), angle = 3.14159265358979 * k / kPoints;
    mesh.positions.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
    const Index a = 2 + k, b = 2 + (k + 1) % (2 * kPoints);
    mesh.triangles.push_back({0, b, a});
    mesh.triangles.push_back({1, a, b});
  }
  return mesh;
}

/// A weak sheet over a star that jumps and turns about in it, strong enough to tear along what it
/// meets.
WorldDef stirred(int n, double thickness, unsigned seed) {
  Random random(seed);
  WorldDef def;
  def.name = "stirred";
  ClothDef& cloth = def.cloths[0];
  cloth = lying_cloth(n, 0.8, 0.56);
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 40;
  cloth.fabric.shear = 8;
  cloth.fabric.thickness = thickness;
  def.environment.damping = 0.5;
  TriangleMesh mesh = star(0.25);
  for (Vec3d& p : mesh.positions) p += Vec3d(0, 0.5, 0);
  ColliderDef spoon{"star", MeshDef{mesh}};
  spoon.max_force = 3000;
  spoon.motion.keyframes = {{0.2}};
  for (double time = 0.2; time < 4;) {
    time += random.uniform(0.1, 0.4);
    Keyframe key;
    key.time = time;
    key.offset = random.vector(0.15);
    key.rotation = Eigen::AngleAxisd(random.uniform(-2, 2), random.vector(1).normalized());
    spoon.motion.keyframes.push_back(key);
  }
  def.colliders = {spoon, {"ground", PlaneDef{}}};
  def.contact.seed.self = SelfContact::guard;
  return def;
}

void check_drags(const WorldDef& def, int settle_ticks, int drags, unsigned seed) {
  if (!is_chosen(seed)) return;
  const Repeatable repeatable(seed);
  const std::clock_t start = std::clock();
  const DragFigures seen = drag_about(def, settle_ticks, drags, seed);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  INFO(def.name << ": " << drags << " drags, " << seen.ticks << " ticks, " << seen.crossings
                << " crossings in " << seen.crossed_ticks << " ticks from tick " << seen.first_tick
                << " on, lost " << seen.lost << ", strain " << seen.strain << ", inside "
                << seen.deepest << " m, " << 1000 * seconds / seen.ticks << " ms a tick");
  CHECK(seen.crossings == 0);
  CHECK(seen.deepest == 0);
  CHECK(seen.blow_ups == 0);
  CHECK(seen.lost < 0.2);
}

}  // namespace

TEST_CASE("a few drags of up to ten hands at up to 5 m/s leave no crossing anywhere") {
  check_drags(pile(21), 40, 3, 1);
  check_drags(scene("hard-needles", 17), 20, 2, 2);
  if (has_mesh("bunny"))
    check_drags(scene("drop-on-bunny", 21), 30, 2, 3);
  else
    WARN("the bunny's package is not installed");
}

TEST_CASE("ten hands of 1 MN at 20 m/s at a time leave no crossing anywhere") {
  const auto check = [](const WorldDef& def, int settle_ticks, int drags, unsigned seed) {
    if (!is_chosen(seed)) return;
    const Repeatable repeatable(seed);
    const DragFigures seen = drag_about(def, settle_ticks, drags, seed, kGiant);
    INFO(def.name << ": " << seen.crossings << " crossings in " << seen.crossed_ticks
                  << " ticks from tick " << seen.first_tick << " on, inside " << seen.deepest
                  << " m, strain " << seen.strain << ", " << seen.blow_ups << " blow-ups");
    CHECK(seen.crossings == 0);
    CHECK(seen.deepest == 0);
  };
  check(pile(15), 40, 2, 501);
  check(scene("hard-needles", 13), 20, 1, 502);
  check(stirred(9, 3e-4, 503), 30, 1, 503);
}

TEST_CASE("a sharp object that is stirred about in dragged cloth does not pass through it") {
  check_drags(stirred(9, 3e-4, 401), 30, 2, 401);
  check_drags(stirred(17, 4e-4, 402), 30, 1, 402);
  check_drags(stirred(13, 2e-3, 403), 30, 2, 403);
}

TEST_CASE("200 drags of up to ten hands at up to 5 m/s leave no crossing anywhere", "[.long]") {
  constexpr int kDrags = 10;
  for (unsigned seed = 101; seed <= 107; ++seed) check_drags(pile(41), 60, kDrags, seed);
  for (unsigned seed = 201; seed <= 206; ++seed)
    check_drags(scene("hard-needles", 33), 40, kDrags, seed);
  for (unsigned seed = 411; seed <= 420; ++seed)
    check_drags(stirred(seed % 2 ? 9 : 17, seed % 3 ? 4e-4 : 3e-3, seed), 30, 3, seed);
  REQUIRE(has_mesh("bunny"));
  for (unsigned seed = 301; seed <= 307; ++seed)
    check_drags(scene("drop-on-bunny", 49), 60, kDrags, seed);
}
