#include "core/contact/objects/object_rows.h"

#include <catch2/catch.hpp>

#include "core/scenes/dress_form.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

// Rows that parts of the work have made are those that one part makes, in the same order.

using namespace weft;

namespace {

/// A large cloth that falls on a form, a ball and the ground.
WorldDef falling(double height) {
  WorldDef def = test::empty_world(test::flat_cloth(71, 73, 1, 1));
  def.cloths[0].origin = Vec3d(-0.5, height, -0.5);
  def.cloths[0].v = Vec3d::UnitZ();
  def.environment.gravity = Vec3d(0, -9.81, 0);
  TriangleMesh form = make_dress_form();
  for (Vec3d& p : form.positions) p -= Vec3d(0.2, 1.4, 0);
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -0.1, 0), Vec3d::UnitY()}},
                   {"form", MeshDef{form}},
                   {"ball", SphereDef{Vec3d(0.25, 0, 0.1), 0.2}}};
  return def;
}

void check_rows(const World<float>& one, const World<float>& two) {
  const std::vector<ContactRow<float>>&a = one.contact().rows(), &b = two.contact().rows();
  REQUIRE(a.size() == b.size());
  for (std::size_t r = 0; r < a.size(); ++r) {
    const bool same = a[r].particle == b[r].particle && a[r].weight == b[r].weight &&
                      a[r].share == b[r].share && a[r].count == b[r].count &&
                      a[r].normal == b[r].normal && a[r].offset == b[r].offset &&
                      a[r].distance == b[r].distance && a[r].least_height == b[r].least_height &&
                      a[r].keep == b[r].keep && a[r].mover == b[r].mover &&
                      a[r].collider == b[r].collider && a[r].responds == b[r].responds;
    INFO("row " << r << " of " << a.size());
    REQUIRE(same);
  }
}

/// @return most rows in a tick
std::size_t check_fall(const WorldDef& def, int ticks) {
  test::TwoThreads two_threads;
  World<float> one(def), two(def, {&two_threads, nullptr});
  std::size_t most = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    one.step();
    two.step();
    check_rows(one, two);
    REQUIRE(one.bad_starts() == two.bad_starts());
    for (std::size_t s = 0; s < kStageCount; ++s)
      REQUIRE(one.report().profile.stages[s].work == two.report().profile.stages[s].work);
    REQUIRE(one.hash() == two.hash());
    most = std::max(most, one.contact().rows().size());
  }
  return most;
}

}  // namespace

TEST_CASE("a cloth meets objects in the same rows with one and two threads") {
  CHECK(check_fall(falling(0.22), 20) > 2000);
}

TEST_CASE("it does where an object moves") {
  WorldDef def = falling(0.22);
  def.colliders[1].motion.keyframes = {{0, Vec3d::Zero()}, {1, Vec3d(0, 0.2, 0)}};
  def.colliders[2].motion.keyframes = {{0, Vec3d::Zero()}, {1, Vec3d(0.1, 0.1, 0)}};
  CHECK(check_fall(def, 12) > 1000);
}

TEST_CASE("it does where the cloth starts inside, and is led out") {
  const WorldDef def = falling(-0.095);  // all of it is near the ground
  World<float> world(def);
  world.step();
  REQUIRE(world.bad_starts().size() >= 1);
  CHECK(check_fall(def, 6) > 4000);
}
