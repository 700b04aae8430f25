#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/support/sheets.h"

// Steps in which nothing can meet go by without contact (fused_steps.h): that changes no bit, and
// nobody gets anywhere unseen.

using namespace weft;
using namespace weft::test;

namespace {

/// A level sheet, turned a little in its plane so that no row of it comes down at once.
ClothDef sheet(int rows, int columns, double height) {
  ClothDef cloth;
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.width = 0.03 * (columns - 1);
  cloth.height = 0.03 * (rows - 1);
  cloth.origin = Vec3d(-0.3, height, -0.3);
  cloth.u = Vec3d(1, 0.1, 0).normalized();
  cloth.v = Vec3d::UnitZ();
  cloth.fabric.thickness = 0.004;
  return cloth;
}

void throw_all(World<float>& world, std::size_t part, const Vec3f& velocity) {
  const IndexRange& range = world.model().parts[part].particles;
  for (Index i = range.first; i < range.end(); ++i)
    world.state().v[static_cast<std::size_t>(i)] += velocity;
  world.accept_state();
}

}  // namespace

TEST_CASE("steps that go by without contact change no bit, falling on an object too") {
  const auto [rows, columns] = GENERATE(std::pair{20, 20}, std::pair{17, 31}, std::pair{9, 40});
  WorldDef def;
  def.cloths[0] = sheet(rows, columns, 0.5);
  def.colliders = {{"ball", SphereDef{Vec3d(0.05, 0.1, 0), 0.2}}, {"ground", PlaneDef{}}};
  def.contact.seed.self = SelfContact::none;
  World<float> alone(def);
  def.contact.seed.self = SelfContact::guard;
  World<float> guarded(def);
  float nearest = 1;
  int ticks = 0;
  while (ticks < 120) {
    alone.step();
    guarded.step();
    if (!guarded.guard()->pairs().empty()) break;
    ++ticks;
    REQUIRE(guarded.hash() == alone.hash());
    for (const Vec3f& x : guarded.state().x)
      nearest = std::min(nearest, (x - Vec3f(0.05f, 0.1f, 0)).norm() - 0.2f);
  }
  INFO(ticks << " ticks, nearest " << nearest << " m");
  CHECK(ticks > 15);
  CHECK(nearest < 0.005f);
  CHECK(guarded.guard()->counts().calm > 200);
}

TEST_CASE("a sheet that is thrown at an object through steps without contact does not get in") {
  const float speed = GENERATE(2.0f, 10.0f, 30.0f);
  WorldDef def;
  def.cloths[0] = sheet(20, 20, 1.5);
  def.colliders = {{"ball", SphereDef{Vec3d(0, 0.3, 0), 0.25}}, {"ground", PlaneDef{}}};
  def.contact.seed.self = SelfContact::guard;
  World<float> world(def);
  throw_all(world, 0, Vec3f(0, -speed, 0));
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    for (const Vec3f& x : world.state().x) {
      REQUIRE(x[1] > 0);
      REQUIRE((x - Vec3f(0, 0.3f, 0)).norm() > 0.25f);
    }
  }
  CHECK(world.guard()->counts().calm > 0);
}

TEST_CASE("two sheets that fly at each other through steps without contact do not cross") {
  const float speed = GENERATE(1.0f, 5.0f, 15.0f);
  WorldDef def;
  def.environment.gravity.setZero();
  def.cloths = {sheet(20, 20, 1.5), sheet(16, 24, 0.8)};
  def.cloths[1].name = "other";
  def.cloths[1].u = Vec3d(1, -0.2, 0).normalized();
  def.contact.seed.self = SelfContact::guard;
  World<float> world(def);
  throw_all(world, 0, Vec3f(0, -speed, 0));
  throw_all(world, 1, Vec3f(0, speed, 0));
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    REQUIRE(crossings(world) == 0);
  }
  CHECK(world.guard()->counts().calm > 0);
}
