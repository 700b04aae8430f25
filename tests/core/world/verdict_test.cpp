#include "core/world/verdict.h"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

#include "core/geometry/distance.h"
#include "tests/support/cloths.h"
#include "tests/support/sheets.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// Smallest distance of features that share no particle, over all of them [m].
double brute_force_gap(const World<float>& world) {
  const ClothModel<float>& model = world.model();
  const auto at = [&world](Index i) {
    return world.state().x[static_cast<std::size_t>(i)].cast<double>().eval();
  };
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : model.triangles) {
    for (Index i = 0; i < model.particle_count(); ++i) {
      if (i == t[0] || i == t[1] || i == t[2]) continue;
      const Vec3d p = at(i), nearest = closest_on_triangle(p, at(t[0]), at(t[1]), at(t[2])).point;
      least = std::min(least, (p - nearest).norm());
    }
  }
  for (const Edge& e : model.edges) {
    for (const Edge& f : model.edges) {
      if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) continue;
      const auto nearest = closest_of_segments(at(e[0]), at(e[1]), at(f[0]), at(f[1]));
      least = std::min(least, (nearest.p - nearest.q).norm());
    }
  }
  return least;
}

}  // namespace

TEST_CASE("a verdict's smallest gap is that of the nearest features where they are, to 1 um") {
  // A hand sweeps one crumpling sheet over another: rows are from before they went on.
  WorldDef def;
  def.cloths = {test::flat_cloth(9, 9, 0.4, 0.4), test::flat_cloth(6, 6, 0.2, 0.2)};
  def.cloths[1].name = "upper";
  def.cloths[0].origin = Vec3d(-0.2, 0, -0.2);
  def.cloths[1].origin = Vec3d(-0.1, 0.012, -0.1);
  for (ClothDef& cloth : def.cloths) cloth.fabric.thickness = 0.01;
  for (const Side side : {Side::left, Side::right})
    def.pins.push_back({EdgeStrip{side, 0.0}, 0.0, {}});
  HandDef hand;
  hand.cloth = "upper";
  hand.path = {{0.2, Vec3d::Zero()}, {0.4, Vec3d(0.3, -0.02, 0.2)}, {0.6, Vec3d(-0.2, -0.02, 0)}};
  def.hands = {hand};
  def.contact.seed.self = SelfContact::guard;
  World<float> world(def);
  int met = 0;
  for (int tick = 0; tick < 40; ++tick) {
    world.step();
    Verdict<float> verdict;
    verdict.look(world);
    REQUIRE(verdict.crossings == 0);
    const double gap = brute_force_gap(world);
    if (gap > 0.01) continue;
    ++met;
    REQUIRE(verdict.smallest_gap == Approx(gap).margin(1e-6));
  }
  CHECK(met > 20);
}

TEST_CASE("what the guard took before a tick was taken back is counted in the verdict still") {
  World<float> world(test::upright_sheet(14, 0.6, 0.75, 0.25, 0.2));
  test::jolt(world, 5, 3);
  Verdict<float> verdict;
  for (int tick = 0; tick < 40; ++tick) {
    world.step();
    verdict.look(world);
  }
  const double wanted = world.guard()->counts().wanted, lost = verdict.lost_motion * wanted;
  REQUIRE(wanted > 0);
  world.state().v[5][1] = std::numeric_limits<float>::quiet_NaN();
  world.step();
  REQUIRE(world.report().divergence);
  verdict.look(world);
  CHECK(world.guard()->counts().wanted >= wanted);
  CHECK(verdict.lost_motion * world.guard()->counts().wanted >= lost * (1 - 1e-12));
}

TEST_CASE("what is to return to its rest is judged whenever that is, and fails if it never rests") {
  // A free sheet falls on and on. At 60 Hz half a tick lies between two ticks.
  const double half = 0.5 / 60;
  for (const auto& [rest_at, back_by, fails] : std::vector<std::tuple<double, double, bool>>{
           {0, 0.2, true}, {0.1 + half, 0.2 + half, true}, {0.3, 0.2, true}, {0.1, 0, false}}) {
    INFO("rest at " << rest_at << " s, back by " << back_by << " s");
    WorldDef def = test::empty_world(test::flat_cloth(5, 5));
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.verdict.rest_at = rest_at;
    def.verdict.back_by = back_by;
    World<float> world(def);
    Verdict<float> verdict;
    for (int tick = 0; tick < 20; ++tick) {
      world.step();
      verdict.look(world);
    }
    const std::vector<std::string> found = verdict.failures(def.verdict);
    CHECK(std::any_of(found.begin(), found.end(), [](const std::string& one) {
            return one.find("off its rest") == 0;
          }) == fails);
  }
}
