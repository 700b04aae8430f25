#include <algorithm>
#include <cstdint>
#include <string>

#include <catch2/catch.hpp>

#include "core/scenes/scene_parts.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/worlds.h"

// What is stopped by its certificate costs no momentum.

using namespace weft;

namespace {

/// Two free sheets above each other in empty space.
WorldDef two_sheets(const std::string& fabric, double thickness, double gap) {
  WorldDef def;
  set_field(def, "fabric", fabric);
  set_field(def, "environment.gravity", "0,0,0");
  set_field(def, "environment.drag", "0");
  set_field(def, "contact.self", "guard");
  ClothDef& sheet = def.cloths[0];
  sheet.rows = sheet.columns = 15;
  sheet.width = sheet.height = 0.3;
  sheet.u = Vec3d::UnitX();
  sheet.v = Vec3d::UnitZ();
  sheet.origin = Vec3d(-0.15, 0, -0.15);
  sheet.fabric.thickness = thickness;
  def.cloths.push_back(sheet);
  def.cloths[0].name = "lower";
  def.cloths[1].name = "upper";
  def.cloths[1].origin[1] = gap;
  return def;
}

struct Motion {
  Vec3d mean = Vec3d::Zero();  ///< velocity, by mass [m/s]
  double energy = 0;           ///< of motion [J]
};

Motion motion_of(const World<float>& world) {
  Motion m;
  double mass = 0;
  for (std::size_t i = 0; i < world.state().v.size(); ++i) {
    const double own = static_cast<double>(world.model().mass[i]);
    const Vec3d v = world.state().v[i].cast<double>();
    mass += own;
    m.mean += own * v;
    m.energy += own * v.squaredNorm() / 2;
  }
  m.mean /= mass;
  return m;
}

/// Both fly sideways, and the upper one down.
void throw_at_each_other(double common, double speed, World<float>& world) {
  Vec3Array<float>& v = world.state().v;
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = Vec3d(common, i < v.size() / 2 ? 0 : -speed, 0).cast<float>();
  world.accept_state();
}

/// A sheet in empty space that hangs by two corners.
WorldDef shaken_sheet(const std::string& fabric, double thickness, int rows) {
  WorldDef def = two_sheets(fabric, thickness, 0);
  def.cloths.pop_back();
  set_field(def, "environment.gravity", "0,-9.81,0");
  def.environment.air_density = 0;
  ClothDef& sheet = def.cloths[0];
  sheet.rows = sheet.columns = rows;
  sheet.width = sheet.height = 0.4;
  sheet.u = Vec3d::UnitZ();
  sheet.v = -Vec3d::UnitY();
  sheet.origin = Vec3d(0, 1, -0.2);
  def.pins = {{Index(0), 0, {}}, {static_cast<Index>(rows - 1), 0, {}}};
  return def;
}

/// Brings both pins together, swings them to and fro, and lets go: gravity ends with that.
void shake_and_let_go(World<float>& world) {
  const auto send = [&world](const Vec3d& target, double speed, int ticks) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double side = k == 0 ? -0.01 : 0.01;
      world.move_pin(world.pins().list[k].id,
                     {target + Vec3d(k == 0 ? 0 : 0.01, 0, side), speed, 50});
    }
    for (int tick = 0; tick < ticks; ++tick) world.step();
  };
  send(Vec3d(0, 1, 0), 1, 20);
  for (const double side : {0.1, -0.1, 0.1}) send(Vec3d(side, 1.2, 0), 4, 8);
  while (!world.pins().list.empty()) world.unpin(world.pins().list[0].id);
  EnvironmentDef environment = world.environment();
  environment.gravity.setZero();
  world.set_environment(environment);
}

}  // namespace

TEST_CASE("sheets that meet faster than a thickness a substep keep their momentum to 1e-5",
          "[core][guard]") {
  struct Case {
    const char* fabric;
    double thickness, gap, speed, common;
  };
  for (const Case& c : {Case{"cotton", 0.0005, 0.02, 1, 1}, Case{"cotton", 0.001, 0.02, 2, 1},
                        Case{"silk", 0.0005, 0.02, 2, 1}, Case{"denim", 0.0005, 0.033, 4, 1},
                        Case{"cotton", 0.004, 0.05, 20, 5}}) {
    INFO(c.fabric << ", " << c.thickness << " m, " << c.speed << " m/s");
    World<float> world(two_sheets(c.fabric, c.thickness, c.gap));
    throw_at_each_other(c.common, c.speed, world);
    const Motion start = motion_of(world);
    for (int tick = 0; tick < 20; ++tick) world.step();
    const Motion end = motion_of(world);
    CHECK(world.guard()->counts().truncated > 0);
    CHECK((end.mean - start.mean).norm() < 1e-5 * (c.common + c.speed));
    CHECK(end.energy < start.energy * 1.001);
    // The lower one was hit: it goes down about as fast as the upper one, or faster.
    const Vec3Array<float>& v = world.state().v;
    double down = 0;
    for (std::size_t i = 0; i < v.size() / 2; ++i) down -= static_cast<double>(v[i][1]);
    CHECK(down / (static_cast<double>(v.size()) / 2) > 0.4 * c.speed);
  }
}

TEST_CASE("with implicit sheets that meet within a tick keep their momentum to 1e-4",
          "[core][guard]") {
  for (const double gap : {0.04, 0.06, 0.08, 0.1, 0.12}) {
    INFO(gap << " m apart");
    WorldDef def = two_sheets("cotton", 0.004, gap);
    def.solver.kind = SolverKind::implicit;
    World<float> world(def);
    throw_at_each_other(1, 3, world);
    const Motion start = motion_of(world);
    for (int tick = 0; tick < 20; ++tick) world.step();
    const Motion end = motion_of(world);
    CHECK((end.mean - start.mean).norm() < 4e-4);
    CHECK(end.energy < start.energy * 1.001);
  }
}

TEST_CASE("a sheet that crumples in flight keeps its momentum, and flies as fast as that says",
          "[core][guard]") {
  struct Case {
    const char* fabric;
    double thickness;
    int rows;
  };
  const Case c =
      GENERATE(Case{"cotton", 0.0005, 11}, Case{"wool", 0.0005, 15}, Case{"cotton", 0.001, 11});
  INFO(c.fabric << ", " << c.thickness << " m, " << c.rows << " rows");
  World<float> world(shaken_sheet(c.fabric, c.thickness, c.rows));
  shake_and_let_go(world);
  const float speed = GENERATE(0.0F, 20.0F);
  for (Vec3f& v : world.state().v) v[0] += speed;
  world.accept_state();
  const Motion start = motion_of(world);
  const double truncated = world.guard()->counts().truncated;
  for (int tick = 0; tick < 60; ++tick) world.step();
  const Vec3d before = test::centre_of_mass(world);
  for (int tick = 0; tick < 30; ++tick) world.step();
  const Vec3d flown = (test::centre_of_mass(world) - before) * 2;
  CHECK(world.guard()->counts().truncated > truncated);
  CHECK((motion_of(world).mean - start.mean).norm() < 0.01 * start.mean.norm());
  CHECK((flown - start.mean).norm() < 0.01 * start.mean.norm());
}

TEST_CASE("layers of any thickness lie still on each other, as far apart as they are thick",
          "[core][guard]") {
  for (const double edges : {0.45, 0.66, 0.8, 1.2, 1.8}) {
    const double thickness = edges * 0.1 / 14;
    INFO(edges << " edges thick");
    WorldDef def = two_sheets("cotton", thickness, 1.05 * thickness);
    set_field(def, "environment.gravity", "0,-9.81,0");
    for (ClothDef& sheet : def.cloths) {
      sheet.width = sheet.height = 0.1;
      sheet.origin += Vec3d(0.1, 1.02 * thickness, 0.1);
    }
    def.colliders = {ground()};
    World<float> world(def);
    for (int tick = 0; tick < 180; ++tick) world.step();
    const ClothState<float>& state = world.state();
    const std::size_t half = state.x.size() / 2;
    double fastest = 0, apart = 0;
    for (std::size_t i = 0; i < half; ++i) {
      fastest = std::max(fastest, static_cast<double>(state.v[half + i].norm()));
      apart += static_cast<double>(state.x[half + i][1] - state.x[i][1]);
    }
    CHECK(fastest < 0.002);
    CHECK(apart / static_cast<double>(half) == Approx(thickness).epsilon(0.02));
  }
}

TEST_CASE("cloth that a ball tore off crashes at tens of metres a second in bounded work") {
  World<float> world(make_scene("hard-start-inside"));
  for (int tick = 0; tick < 245; ++tick) world.step();
  PinDef pin;
  pin.place = Index(544);
  world.pin(pin);
  const auto& colliders = world.def().colliders;
  const auto ball = std::find_if(colliders.begin(), colliders.end(),
                                 [](const ColliderDef& one) { return one.name == "ball"; });
  REQUIRE(ball != colliders.end());
  MoveDef move;
  move.target.position = Vec3d(0, 2, 0);
  move.speed = 20;
  move.force = true;
  world.move_collider(static_cast<std::size_t>(ball - colliders.begin()), move);
  std::uint64_t before = world.guard()->counts().critical, most = 0;
  double speed = 0;
  for (int tick = 0; tick < 20; ++tick) {
    world.step();
    const std::uint64_t now = world.guard()->counts().critical;
    most = std::max(most, now - before);
    before = now;
    for (const Vec3f& v : world.state().v) speed = std::max(speed, static_cast<double>(v.norm()));
  }
  CHECK(speed > 50);
  // Pairs of 1,089 particles in one tick that a step certifies by themselves.
  CHECK(most < 3'000'000);
}
