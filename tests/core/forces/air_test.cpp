#include "core/forces/air/air.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// What blows: how fast at most, with what it drifts, when it may be left out; and that the substeps
// follow it.

using namespace weft;

namespace {

/// An environment with up to three fans, with or without wind and gusts.
EnvironmentDef random_air(test::Random& random) {
  EnvironmentDef air;
  if (random.uniform(0, 1) < 0.5) air.wind = random.vector(20);
  if (random.uniform(0, 1) < 0.5) air.gust_speed = random.uniform(0, 10);
  air.gust_length = random.uniform(0.05, 2);
  const int fans = static_cast<int>(random.uniform(0, 4));
  for (int k = 0; k < fans; ++k) {
    FanDef fan;
    fan.position = random.vector(1);
    fan.direction = random.vector(1);
    fan.speed = random.uniform(0, 50);
    fan.radius = random.uniform(0.1, 1);
    air.fans.push_back(fan);
  }
  return air;
}

Vec3Array<double> random_places(test::Random& random, int count) {
  Vec3Array<double> x;
  for (int k = 0; k < count; ++k) x.push_back(random.vector(2));
  return x;
}

Vec3Array<double> air_at(const EnvironmentDef& environment, double time,
                         const Vec3Array<double>& x) {
  Vec3Array<double> air(x.size());
  sample_air(environment, time, Vec3d::Zero(), x, air);
  return air;
}

/// The largest rate at which a cloth at rest in this air loses velocity [1/s]: by power iteration
/// on the derivative of the forces, and Rayleigh's quotient, which is never above it.
double fastest_loss(const ClothModel<double>& model, const EnvironmentDef& environment) {
  const Vec3Array<double>& x = model.rest_positions;
  Vec3Array<double> wind(x.size());
  sample_air(environment, 0, Vec3d::Zero(), x, wind);
  Vec3Array<double> v(x.size(), Vec3d(0.1, 1, 0.9)), still(x.size(), Vec3d::Zero());
  double rate = 0;
  for (int round = 0; round < 200; ++round) {
    constexpr double kSpeed = 1e-6;
    Vec3Array<double> slow = v, kept = still, lost = still;
    for (Vec3d& p : slow) p *= kSpeed;
    add_air_forces(model, wind, environment.air_density, x, still, kept);
    add_air_forces(model, wind, environment.air_density, x, slow, lost);
    double power = 0, energy = 0, largest = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3d force = (kept[i] - lost[i]) / kSpeed;
      power += force.dot(v[i]);
      energy += model.mass[i] * v[i].squaredNorm();
      v[i] = force / model.mass[i];
      largest = std::max(largest, v[i].norm());
    }
    rate = power / energy;
    for (Vec3d& p : v) p /= largest;
  }
  return rate;
}

}  // namespace

TEST_CASE("the air damps no motion of a cloth faster than the bound, which is at most 1.2 of it") {
  const int cells = GENERATE(2, 5);
  const bool grid = GENERATE(true, false);
  ClothDef cloth = grid ? test::flat_cloth(cells + 1, cells + 1)
                        : test::triangle_sheet(test::Cut::irregular, 1, 1, 1.0 / cells);
  cloth.mass_lumping = GENERATE(MassLumping::area, MassLumping::equal);
  const bool along = GENERATE(false, true);
  CAPTURE(cells, grid, cloth.mass_lumping == MassLumping::equal, along);
  cloth.fabric.air_normal = along ? 0 : 1.3;
  cloth.fabric.air_tangential = along ? 0.7 : 0;
  const ClothModel<double> model = build_cloth<double>(cloth);
  EnvironmentDef environment;
  environment.wind = 12 * (grid ? Vec3d::UnitY() : Vec3d::UnitZ());
  const double fastest = fastest_loss(model, environment);
  const ClothPart<double>& part = model.parts[0];
  const double bound = air_damping_rate(environment, part.fabric, part.bounds.area_per_mass, 0);
  CHECK(fastest <= bound * (1 + 1e-6));
  CHECK(bound <= 1.2 * fastest);
}

TEST_CASE("no air that is sampled anywhere is faster than the bound, with wind, gusts and fans") {
  test::SeededRandom random(7);
  for (int run = 0; run < 200; ++run) {
    const EnvironmentDef environment = random_air(random);
    const double bound = fastest_air(environment) * (1 + 1e-12);
    for (const Vec3d& air : air_at(environment, random.uniform(0, 100), random_places(random, 50)))
      REQUIRE(air.norm() <= bound);
  }
}

TEST_CASE("before a fan its core blows with the fan's speed, and the bound counts each of them") {
  EnvironmentDef environment;
  for (int k = 0; k < 3; ++k) {
    FanDef fan;
    fan.position = Vec3d(0, 1, 1);
    fan.direction = -Vec3d::UnitZ();
    fan.speed = 7;
    environment.fans.push_back(fan);
    const double fastest = air_at(environment, 0, {Vec3d(0, 1, 0.5)})[0].norm();
    CHECK(fastest == Approx(7.0 * (k + 1)));
    CHECK(fastest_air(environment) >= fastest * (1 - 1e-12));
  }
}

TEST_CASE("a jet is the same at any distance in its core, beyond its reach as 1 / distance") {
  test::SeededRandom random(7);
  for (int run = 0; run < 50; ++run) {
    EnvironmentDef environment;
    environment.fans.emplace_back();
    FanDef& fan = environment.fans[0];
    fan.position = random.vector(1);
    fan.direction = random.vector(1);
    fan.spread = random.uniform(0, 0.5);
    fan.reach = random.uniform(1, 3);
    const Vec3d along = fan.direction.normalized(), across = along.unitOrthogonal();
    const double share = random.uniform(0, 0.95);  // of the jet's radius
    const auto speed_at = [&](double distance) {
      const double away = share * (fan.radius + fan.spread * distance);
      const Vec3d place = fan.position + along * distance + across * away;
      return air_at(environment, 0, {place})[0].dot(along);
    };
    const double core = speed_at(0.9 * fan.reach);
    REQUIRE(core > 0);
    REQUIRE(speed_at(fan.reach) == Approx(core));
    for (const double times : {1.5, 2.0, 7.0})
      REQUIRE(speed_at(times * fan.reach) == Approx(core / times));
  }
}

TEST_CASE("gusts are carried along by the wind: later the same eddy is as far downwind (Taylor)") {
  test::SeededRandom random(7);
  for (int run = 0; run < 50; ++run) {
    EnvironmentDef environment;
    environment.wind = random.vector(20);
    environment.gust_speed = 3;
    environment.gust_length = 4;
    const double time = random.uniform(0, 10), later = 0.4;
    const Vec3Array<double> x = random_places(random, 20);
    Vec3Array<double> downwind = x;
    for (Vec3d& place : downwind) place += environment.wind * later;
    const Vec3Array<double> before = air_at(environment, time, x);
    const Vec3Array<double> after = air_at(environment, time + later, downwind);
    // Without wind eddies drift by half a metre a second, which is little of their length.
    for (std::size_t i = 0; i < x.size(); ++i) REQUIRE((before[i] - after[i]).norm() < 1.0);
    double square = 0, difference = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      square += (before[i] - environment.wind).squaredNorm();
      difference += (before[i] - after[i]).squaredNorm();
    }
    CHECK(difference < 0.1 * square);
  }
}

TEST_CASE("gusts change at a place, all else blows there for ever as it does now") {
  test::SeededRandom random(7);
  int changing = 0;
  for (int run = 0; run < 100; ++run) {
    const EnvironmentDef environment = random_air(random);
    const Vec3Array<double> x = random_places(random, 10);
    const bool changed = air_at(environment, 1, x) != air_at(environment, 1.7, x);
    CHECK(changed == changes_by_itself(environment));
    changing += changed;
  }
  CHECK(changing > 10);
  CHECK(changing < 90);
}

TEST_CASE("air is calm where none has a velocity, unless still air was asked for, or in vacuum") {
  test::SeededRandom random(7);
  for (int run = 0; run < 100; ++run) {
    EnvironmentDef environment = random_air(random);
    if (run % 4 == 0) environment = EnvironmentDef{};
    const bool blows = fastest_air(environment) > 0;
    CHECK(is_calm(environment) == !blows);
    if (!blows)
      for (const Vec3d& air : air_at(environment, 3, random_places(random, 10)))
        CHECK(air.isZero(0));
    environment.still_air = true;
    CHECK_FALSE(is_calm(environment));
    environment.air_density = 0;
    CHECK(is_calm(environment));
    CHECK(air_damping_rate(environment, FabricDef{}, 5, 3) == 0);
  }
}

TEST_CASE("a tick has as many substeps before a fan as in a wind of its speed") {
  WorldDef def = test::empty_world(test::flat_cloth(8, 8));
  def.environment.air_density = 1000;  // so that the air decides
  def.environment.still_air = true;
  const World<float> calm(def);
  EnvironmentDef wind = def.environment, fan = def.environment;
  wind.wind = Vec3d(50, 0, 0);
  fan.fans.emplace_back();
  fan.fans[0].speed = 50;
  CHECK(calm.cost_in(fan).substeps == calm.cost_in(wind).substeps);
  CHECK(calm.cost_in(fan).substeps > 2 * calm.cost_in(def.environment).substeps);
}

TEST_CASE("light cloth close before a strong fan keeps to it and does not blow up") {
  ClothDef cloth = test::flat_cloth(9, 9);
  cloth.fabric.areal_density = 0.02;
  cloth.v = -Vec3d::UnitY();
  cloth.origin = Vec3d(-0.5, 1.5, 0.7);
  WorldDef def = test::empty_world(cloth);
  def.environment.air_density = 10;
  def.environment.fans.emplace_back();
  def.environment.fans[0].speed = 50;
  def.environment.fans[0].radius = 1;
  for (Index column = 0; column < 9; ++column) def.pins.push_back({column, 0});
  World<float> world(def);
  REQUIRE_NOTHROW(test::advance(world, 0.5));
  CHECK(test::centre_of_mass(world).z() < 0.7);
}
