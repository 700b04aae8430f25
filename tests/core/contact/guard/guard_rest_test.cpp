#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

#include "core/scenes/dress_form.h"
#include "tests/support/sheets.h"

// Piles of cloth come to rest by themselves: nobody is stopped or put to sleep here.

using namespace weft;
using namespace weft::test;

namespace {

/// A sheet that falls upright on the ground and crumples there.
WorldDef falling_sheet() {
  return upright_sheet(24, 0.6, 0.7, 0.25, 5);
}

/// Speed that 99 % of the particles do not reach [m/s].
double fastest_but_a_hundredth(const World<float>& world) {
  std::vector<double> speed;
  for (const Vec3f& v : world.state().v) speed.push_back(static_cast<double>(v.norm()));
  std::sort(speed.begin(), speed.end());
  return speed[speed.size() * 99 / 100];
}

}  // namespace

TEST_CASE("of seven crumpled sheets six rest after 5 s, 99 % of them below 1 mm/s at any tick") {
  int resting = 0;
  std::size_t rows = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
    World<float> world(falling_sheet());
    jolt(world, 0.05, seed);
    for (int tick = 0; tick < 300; ++tick) world.step();
    rows += world.guard()->rows().size();
    double fastest = 0;
    for (int tick = 0; tick < 30; ++tick) {
      world.step();
      fastest = std::max(fastest, fastest_but_a_hundredth(world));
    }
    INFO("seed " << seed << ", " << fastest << " m/s");
    CHECK(fastest < 5e-3);
    resting += fastest < 1e-3 ? 1 : 0;
  }
  CHECK(resting >= 6);
  CHECK(rows > 7 * 50);
}

TEST_CASE("a sheet that hangs over a dressmaker's form comes to rest within 4 s, to 2 mm/s") {
  WorldDef def = falling_sheet();
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 40;
  cloth.width = cloth.height = 1;
  cloth.origin = Vec3d(-0.5, 1.56, -0.5);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric.thickness = 0.004;
  def.colliders.push_back({"form", MeshDef{make_dress_form()}});
  World<float> world(def);
  for (int tick = 0; tick < 240; ++tick) world.step();
  CHECK(world.contact().rows().size() > 100);
  double fastest = 0;
  for (int tick = 0; tick < 30; ++tick) {
    const Vec3Array<float> before = world.state().x;
    world.step();
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto way = static_cast<double>((world.state().x[i] - before[i]).norm());
      fastest = std::max(fastest, way * def.tick_rate);
    }
  }
  CHECK(fastest < 2e-3);
}

TEST_CASE("a crumpled sheet at rest is not looked at one by one until a hand of 0.1 N moves it") {
  World<float> world(falling_sheet());
  jolt(world, 0.05, 1);
  const auto quiet_part = [&](int ticks) {
    const std::uint64_t before = world.guard()->counts().quiet;
    int steps = 0;
    for (int tick = 0; tick < ticks; ++tick) steps += world.step().substeps;
    return static_cast<double>(world.guard()->counts().quiet - before) / steps;
  };
  CHECK(quiet_part(60) < 0.2);
  quiet_part(240);
  CHECK(quiet_part(30) > 0.8);
  const Vec3Array<float>& x = world.state().x;
  const auto top = static_cast<std::size_t>(
      std::max_element(x.begin(), x.end(),
                       [](const Vec3f& a, const Vec3f& b) { return a[1] < b[1]; }) -
      x.begin());
  const Vec3f before = x[top];
  GrabDef grab;
  const std::vector<Triangle>& triangles = world.model().triangles;
  grab.triangle = static_cast<Index>(
      std::find_if(triangles.begin(), triangles.end(),
                   [&](const Triangle& t) { return t[0] == static_cast<Index>(top); }) -
      triangles.begin());
  REQUIRE(grab.triangle < static_cast<Index>(triangles.size()));
  grab.barycentric = {1, 0, 0};
  grab.max_force = 0.1;
  grab.target = before.cast<double>() + Vec3d(0, 0.05, 0);
  world.grab(grab);
  CHECK(quiet_part(30) < 0.8);
  for (int tick = 0; tick < 30; ++tick) world.step();
  CHECK((world.state().x[top] - before).norm() > 2e-3f);
}
