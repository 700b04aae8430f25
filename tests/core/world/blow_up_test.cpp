// Motion that no cloth has ends its tick before contact sees it.

#include "core/solver/blow_up.h"

#include <cmath>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "core/world/world.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

constexpr double kDt = 1e-3;

ClothState<float> still(const ClothModel<float>& model) {
  return initial_state(model);
}

ClothModel<float> two_cloths() {
  ClothDef large = test::flat_cloth(5, 7), small = large;
  small.width = small.height = 0.1;
  small.origin = Vec3d(3, 0, 0);
  return build_cloths<float>({large, small});
}

void check_goes_on(WorldDef def, int ticks) {
  World<float> world(def);
  for (int n = 0; n < ticks; ++n) {
    const TickReport& report = world.step();
    CHECK(report.tick == static_cast<std::uint64_t>(n) + 1);
    for (const Vec3f& x : world.state().x) {
      REQUIRE(x.allFinite());
      REQUIRE(static_cast<double>(x.norm()) <= kFarthestFromOrigin);
    }
    for (const Vec3f& v : world.state().v) REQUIRE(v.allFinite());
  }
}

}  // namespace

TEST_CASE("motion that is no cloth's is found at each particle, whichever component it is in") {
  const ClothModel<float> model = two_cloths();
  const ClothState<float> good = still(model);
  REQUIRE_FALSE(find_blow_up(model, good, 1e-3f));
  using Kind = BlowUp::Kind;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < good.x.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto kind_of = [&](float x, float v) {
        ClothState<float> state = good;
        if (x != 0) state.x[i][axis] = x;
        state.v[i][axis] = v;
        const auto found = find_blow_up(model, state, static_cast<float>(kDt));
        REQUIRE(found);
        CHECK(found->particle == static_cast<Index>(i));
        return found->kind;
      };
      CHECK(kind_of(kNan, 0) == Kind::not_finite);
      CHECK(kind_of(-kInfinity, 0) == Kind::not_finite);
      CHECK(kind_of(0, kNan) == Kind::not_finite);
      CHECK(kind_of(0, kInfinity) == Kind::not_finite);
      CHECK(kind_of(-1001, 0) == Kind::too_far);
      CHECK(kind_of(0, 3e4f) == Kind::too_fast);
      CHECK(kind_of(0, -std::numeric_limits<float>::max()) == Kind::too_fast);
    }
  }
}

TEST_CASE("a particle may go as far in a substep as its cloth is long, and at 200 m/s anyhow") {
  const ClothModel<float> model = two_cloths();
  for (const std::size_t part : {0u, 1u}) {
    const auto diagonal = static_cast<double>(model.parts[part].rest_diagonal);
    CHECK(diagonal == Approx(part == 0 ? std::sqrt(2.0) : 0.1 * std::sqrt(2.0)));
    const auto i = static_cast<std::size_t>(model.parts[part].particles.first) + 3;
    // Along the diagonal of space, where no component alone tells.
    const auto found_at = [&](double speed) {
      ClothState<float> state = still(model);
      state.v[i].setConstant(static_cast<float>(speed / std::sqrt(3.0)));
      return find_blow_up(model, state, static_cast<float>(kDt)).has_value();
    };
    const double most = diagonal / kDt + kPlausibleSpeed;
    CHECK_FALSE(found_at(most * 0.999));
    CHECK(found_at(most * 1.001));
  }
}

TEST_CASE("two threads find the same particle of a large cloth as one, the first") {
  const ClothModel<float> model = build_cloth<float>(test::flat_cloth(101, 97));
  test::TwoThreads two_threads;
  REQUIRE_FALSE(find_blow_up(model, initial_state(model), 1e-3f, &two_threads));
  for (const std::size_t i : {0u, 4898u, 4899u, 9796u}) {
    ClothState<float> state = initial_state(model);
    state.v[i][1] = state.x.back()[2] = std::numeric_limits<float>::quiet_NaN();
    const auto found = find_blow_up(model, state, 1e-3f, &two_threads);
    REQUIRE(found);
    CHECK(found->particle == static_cast<Index>(i));
  }
  CHECK(two_threads.shared() > 0);
}

TEST_CASE("what is held back keeps its direction and its ratios, cloth by cloth") {
  const ClothModel<float> model = two_cloths();
  const auto second = static_cast<std::size_t>(model.parts[1].particles.first);
  Vec3Array<float> displacements(model.mass.size(), Vec3f(1e-3f, 0, 2e-3f));
  const Vec3f longest(0, 30, 40);
  displacements[second] = longest;
  const Vec3Array<float> before = displacements;
  hold_back(model, 0.01f, displacements);
  CHECK(
      displacements[second].isApprox(longest * (0.01f * static_cast<float>(kPlausibleSpeed) / 50)));
  for (std::size_t i = 0; i < second; ++i) CHECK(displacements[i] == before[i]);
  for (std::size_t i = second; i < before.size(); ++i)
    CHECK(displacements[i].isApprox(before[i] * (displacements[second][1] / 30)));
}

TEST_CASE("a cloth that sleeps is not examined") {
  const ClothModel<float> model = two_cloths();
  ClothState<float> state = still(model);
  state.v[0].setConstant(1e9f);
  state.asleep = {1, 0};
  CHECK_FALSE(find_blow_up(model, state, 1e-3f));
}

TEST_CASE("a cloth in a storm of small gusts by a box goes on, whatever its numbers become") {
  WorldDef def;
  def.tick_rate = GENERATE(30, 10, 5, 3, 1);
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 7;
  cloth.width = cloth.height = 0.5;
  cloth.origin = Vec3d(0, 1, 0);
  set_field(def, "fabric", "denim");
  ColliderDef box;
  box.shape = BoxDef{Vec3d(0, 0.15, 0), Vec3d(0.25, 0.15, 0.25)};
  def.colliders.push_back(box);
  def.environment.gust_speed = 100;
  def.environment.gust_length = 0.01;
  INFO("tick rate " << def.tick_rate);
  World<float> world(def);
  world.set_softness(0.01);
  for (int n = 0; n < 30; ++n) {
    world.step();
    for (const Vec3f& x : world.state().x) REQUIRE(x.allFinite());
  }
}

TEST_CASE("a stiff cloth that is thrown at a box by a hundred times gravity goes on") {
  WorldDef def;
  def.environment.gravity = Vec3d(-187.65409041295914, -1000, -1000);
  def.environment.wind = Vec3d(-98.87432165985885, 70.70168607397761, 81.61148167931904);
  def.environment.gust_speed = 100;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = 9;
  cloth.columns = 7;
  cloth.width = 0.5;
  cloth.height = 0.3;
  cloth.origin = Vec3d(-0.06406733022671485, 1.3593775299046733, 0.48333489766464177);
  cloth.fabric.stretch_warp = 400;
  cloth.fabric.bending_weft = 9.41860593697377;
  cloth.fabric.air_tangential = 100;
  ColliderDef box;
  box.shape = BoxDef{Vec3d(-0.25395413665072786, 0.227719688534198, -0.09369996645521672),
                     Vec3d(0.1, 0.001, 0.1)};
  def.colliders.push_back(box);
  check_goes_on(def, 60);
}

TEST_CASE("a cloth that leaves the scene is told and stopped at a kilometre") {
  WorldDef def = test::empty_world(test::flat_cloth(4, 4));
  World<float> world(def);
  for (Vec3f& v : world.state().v) v = Vec3f(150, 0, 0);
  world.accept_state();
  bool told = false;
  for (int n = 0; n < 600; ++n) {
    const TickReport& report = world.step();
    for (const Vec3f& x : world.state().x)
      REQUIRE(static_cast<double>(x.norm()) <= kFarthestFromOrigin);
    if (!report.divergence) continue;
    CHECK(report.divergence->cause == DivergenceCause::too_far);
    CHECK(report.divergence->value > kFarthestFromOrigin);
    CHECK(describe(*report.divergence).find("from the origin") != std::string::npos);
    told = true;
  }
  CHECK(told);
}
