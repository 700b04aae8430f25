#include "core/scenes/scenes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "core/diagnostics/crossings.h"
#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/installed_meshes.h"
#include "tests/support/sleepers.h"
#include "tests/support/worlds.h"

// Each built-in scene shows what its sentence says, by numbers.

using namespace weft;
using namespace weft::test;

namespace {

/// Edges of cloths and of the scene's boxes and meshes that pass through each other's triangles.
std::size_t object_crossings(const World<float>& world, const WorldDef& def) {
  const ClothModel<float>& model = world.model();
  std::size_t count = 0;
  for (const ColliderDef& collider : def.colliders) {
    TriangleMesh mesh;
    if (const auto* box = std::get_if<BoxDef>(&collider.shape)) {
      mesh = box_mesh(box->half_extents);
      for (Vec3d& x : mesh.positions) x = box->centre + box->orientation * x;
    } else if (const auto* object = std::get_if<MeshDef>(&collider.shape)) {
      mesh = object->mesh;
    }
    count += count_crossings(world.state().x, model.edges, model.triangles, mesh).proper;
  }
  return count;
}

/// For four seconds nothing enters or crosses an object.
void check_stays_out(World<float>& world, const WorldDef& def) {
  double deepest = 0;
  for (int tick = 0; tick < 240; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    if (tick % 10 != 0) continue;
    deepest = std::max(deepest, world.deepest_penetration());
    REQUIRE(object_crossings(world, def) == 0);
  }
  CHECK(deepest == 0);
}

/// Mean angle of a flag's rows below the horizontal, from the hoist to the fly [rad].
double droop(const World<float>& world, std::size_t part) {
  const ClothPart<float>& flag = world.model().parts[part];
  double sum = 0;
  for (int r = 0; r < flag.rows; ++r) {
    const auto at = [&](int column) {
      return world.state()
          .x[static_cast<std::size_t>(flag.particles.first + r * flag.columns + column)];
    };
    const Vec3f along = at(flag.columns - 1) - at(0);
    sum += std::atan2(-along[1], std::hypot(along[0], along[2]));
  }
  return sum / flag.rows;
}

}  // namespace

TEST_CASE("every scene has a name, one sentence and unique names") {
  std::set<std::string> names;
  for (const SceneInfo& scene : scenes()) {
    CHECK(names.insert(scene.name).second);
    CHECK(scene.description.size() > 20);
    CHECK(scene.description.back() == '.');
    CHECK(scene.description.find(": ") != std::string::npos);  // what it is: what to look at
  }
  CHECK_THROWS_AS(make_scene("nothing"), DefinitionError);
}

TEST_CASE("the first view of every scene looks at the place of its cloth") {
  for (const SceneInfo& scene : scenes()) {
    INFO(scene.name);
    if (!is_installed(scene)) continue;
    const WorldDef def = make_scene(scene.name, mesh_directory());
    REQUIRE(def.view);
    CHECK(def.view->direction.norm() == Approx(1).margin(0.01));
    const World<float> world(def);
    double nearest = 1e9;
    for (const Vec3f& x : world.state().x)
      nearest = std::min(nearest, (x.cast<double>() - def.view->target).norm());
    // A cloth that falls or is led away reaches its view later.
    CHECK(nearest < def.view->radius + 0.6);
  }
}

TEST_CASE("the model of the seed can be chosen for every scene that has no gripper") {
  int built = 0;
  for (const SceneInfo& scene : scenes()) {
    INFO(scene.name);
    if (!is_installed(scene)) continue;
    WorldDef def = make_scene(scene.name, mesh_directory());
    const bool guarded = def.contact.seed.self == SelfContact::guard;
    set_field(def, "model", "seed");
    if (!def.grippers.empty()) {
      CHECK_THROWS_AS(World<float>(def), DefinitionError);
      continue;
    }
    const World<float> world(def);
    CHECK(solver_of(def) == SolverKind::relaxation);
    if (guarded) CHECK(def.contact.seed.self == SelfContact::triangles);
    ++built;
  }
  CHECK(built > 20);
}

TEST_CASE("the guard that was asked for by name is still refused with the contact of the seed") {
  WorldDef def;
  set_field(def, "model", "seed");
  set_field(def, "contact.self", "guard");
  CHECK_THROWS_AS(validate(def), DefinitionError);
}

TEST_CASE("the tablecloth rests on the table, hangs over all sides, and enters nothing") {
  const WorldDef def = make_scene("table");
  World<float> world(def);
  check_stays_out(world, def);
  const ClothPart<float>& cloth = world.model().parts[0];
  const auto at = [&](int row, int column) {
    return world.state().x[static_cast<std::size_t>(row * cloth.columns + column)];
  };
  // The top is at 0.74 m.
  const Vec3f middle = at(cloth.rows / 2, cloth.columns / 2);
  CHECK(middle[1] == Approx(0.74 + cloth.fabric.thickness).margin(1e-3));
  CHECK(world.state()
            .v[static_cast<std::size_t>((cloth.rows / 2) * cloth.columns + cloth.columns / 2)]
            .norm() < 0.01);
  CHECK(at(0, cloth.columns / 2)[1] < 0.65);
  CHECK(at(cloth.rows - 1, cloth.columns / 2)[1] < 0.65);
  CHECK(at(cloth.rows / 2, 0)[1] < 0.65);
  CHECK(at(cloth.rows / 2, cloth.columns - 1)[1] < 0.65);
  // Corners are farthest from the top, and hang lowest.
  CHECK(at(0, 0)[1] < at(0, cloth.columns / 2)[1]);
  for (const Vec3f& x : world.state().x) CHECK(x[1] > 0);
}

TEST_CASE("the hammock sags as a heavy elastic strip between two ends does") {
  World<float> world(make_scene("hammock"));
  REQUIRE(test::settle(world, 3, 8) < 0.02);
  const ClothPart<float>& cloth = world.model().parts[0];
  double lowest = 1e9;
  for (const Vec3f& x : world.state().x) lowest = std::min(lowest, static_cast<double>(x[1]));
  const double sag = 1.2 - lowest;
  // Shallow parabola of span L, at first straight and without tension: the arc is longer than L by
  // 8 d^2 / 3 L, the tension is w L^2 / 8 d, so d^3 = 3 w L^4 / 64 Y with w = sigma g.
  const FabricDef& fabric = cloth.fabric;
  const double w = fabric.areal_density * 9.81;
  const double uniaxial = fabric.stretch_warp - fabric.shear * fabric.shear / fabric.stretch_weft;
  const double expected = std::cbrt(3 * w * 16 / (64 * uniaxial));
  CHECK(sag == Approx(expected).epsilon(0.1));
}

TEST_CASE("in the same wind the silk flag streams and the denim flag hangs") {
  World<float> world(make_scene("two-flags"));
  double silk = 0, denim = 0;
  int samples = 0;
  for (int tick = 0; tick < 480; ++tick) {
    world.step();
    REQUIRE_FALSE(world.report().divergence);
    if (tick < 180 || tick % 5 != 0) continue;
    silk += droop(world, 0);
    denim += droop(world, 1);
    ++samples;
  }
  CHECK(denim / samples > silk / samples + 0.3);
  CHECK(world.deepest_penetration() == 0);
}

TEST_CASE("the sheet comes to lie over the bunny, touches ears and ground, and enters nothing") {
  if (!has_mesh("bunny")) {
    WARN("the bunny's package is not installed");
    return;
  }
  const WorldDef def = make_scene("drop-on-bunny", mesh_directory());
  World<float> world(def);
  check_stays_out(world, def);
  float highest = 0, lowest = 9;
  for (const Vec3f& x : world.state().x) {
    highest = std::max(highest, x[1]);
    lowest = std::min(lowest, x[1]);
  }
  // The ears end at 9.65 units of 8 cm.
  CHECK(highest == Approx(0.772).margin(0.02));
  CHECK(lowest < 0.15);
}

TEST_CASE("the turning board carries the sheet with it, and enters nothing") {
  World<float> world(make_scene("turntable", ""));
  const std::size_t off_centre = 20 * 41 + 24;  // 0.11 m from the axis
  const auto direction = [&] {
    const Vec3f& p = world.state().x[off_centre];
    return std::atan2(-static_cast<double>(p[2]), static_cast<double>(p[0]));
  };
  double turned = 0, last = direction();
  for (int tick = 0; tick < 300; ++tick) {
    CHECK_FALSE(world.step().divergence);
    REQUIRE(world.deepest_penetration() == 0);
    turned += std::remainder(direction() - last, 2 * 3.14159265358979);
    last = direction();
  }
  // Once round in five seconds, less the moment until friction holds it.
  CHECK(turned > 5.6);
  CHECK(turned < 6.4);
}

TEST_CASE("the ball lifts the sheet, is never let through, and sinks again") {
  World<float> world(make_scene("lift-sphere", ""));
  for (int tick = 1; tick <= 360; ++tick) {
    CHECK_FALSE(world.step().divergence);
    REQUIRE(world.deepest_penetration() == 0);
    if (tick != 240) continue;
    CHECK(world.colliders()[1].pose.position[1] == Approx(1.0));
    CHECK(world.state().x[20 * 41 + 20][1] > 1.19f);
  }
  CHECK(world.colliders()[1].pose.position[1] == Approx(0.2));
}

TEST_CASE("scenes in which nothing moves by itself in still air come to rest and cost nothing") {
  const std::string name = GENERATE("default", "drape-sphere", "wall", "hammock");
  INFO(name);
  WorldDef def = make_scene(name);
  if (name == "default") {  // its gusts never let it rest
    def.environment.wind.setZero();
    def.environment.gust_speed = 0;
    def.environment.damping = 2;
  }
  WorldDef sleepless = def;
  sleepless.sleep.after = 0;
  World<float> world(def), beside(sleepless);
  for (int tick = 0; tick < 300; ++tick) {
    world.step();
    beside.step();
  }
  REQUIRE(world.hash() == beside.hash());
  REQUIRE(test::run_to_sleep(world, 1800) > 0);
  const std::uint64_t hash = world.hash();
  for (int tick = 0; tick < 120; ++tick) {
    REQUIRE(world.step().rested);
    REQUIRE(test::work_of(world.report()) == 0);
  }
  CHECK(world.hash() == hash);
  const Vec3Array<float> before = world.state().x;
  world.grab(test::touch(world, 150, 0.1));
  CHECK_FALSE(world.step().rested);
  for (int tick = 0; tick < 30; ++tick) world.step();
  const auto touched = static_cast<std::size_t>(world.model().triangles[150][0]);
  CHECK((world.state().x[touched] - before[touched]).norm() > 1e-4f);
}

TEST_CASE("a scene whose objects move or whose cloth is measured does not sleep, the others do") {
  const std::set<std::string> restless = {"turntable",  "lift-sphere",     "gripper",
                                          "drape-test", "cantilever-test", "decay-test"};
  for (const SceneInfo& info : scenes()) {
    if (info.name.starts_with("hard-") || info.name.starts_with("seed-")) continue;
    if (!is_installed(info)) continue;
    INFO(info.name);
    const WorldDef def = make_scene(info.name, mesh_directory());
    CHECK((def.sleep.after > 0) == !restless.contains(info.name));
  }
}
