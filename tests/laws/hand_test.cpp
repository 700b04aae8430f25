#include <algorithm>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// A hand is a spring to its target, whatever solver steps the cloth and however finely.

using namespace weft;
using namespace weft::test;

namespace {

/// A cloth of 0.32 kg that a hand of 100 N/m holds by the middle of its upper border.
WorldDef held_cloth() {
  ClothDef cloth = flat_cloth(9, 9, 0.4, 0.4);
  cloth.fabric.areal_density = 2;
  WorldDef def = empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 4;
  return def;
}

GrabDef hand_at_the_top(const World<float>& world) {
  GrabDef hand;
  double best = 1e9;
  for (std::size_t t = 0; t < world.model().triangles.size(); ++t) {
    Vec3d middle = Vec3d::Zero();
    for (const Index i : world.model().triangles[t])
      middle += world.state().x[static_cast<std::size_t>(i)].cast<double>() / 3;
    const double distance = (middle - Vec3d(0.2, 0, 0)).norm();
    if (distance >= best) continue;
    best = distance;
    hand.triangle = static_cast<Index>(t);
    hand.target = middle;
  }
  hand.radius = 0.06;
  hand.stiffness = 100;
  return hand;
}

/// How far the held point hangs below the hand's target [m].
double sag_of(const World<float>& world) {
  const Grab<float>& grab = world.grabs().list[0];
  return static_cast<double>(grab.target.y() - held_point(grab, world.state().x).y());
}

}  // namespace

TEST_CASE("a hand that holds a cloth still is stretched by its weight, with any solver and step") {
  struct Way {
    SolverKind solver;
    double compliance;
    int substeps;
    double tick_rate;
  };
  const Way way =
      GENERATE(Way{SolverKind::verlet, 0, 1, 60}, Way{SolverKind::implicit, 0, 1, 60},
               Way{SolverKind::implicit, 0, 16, 60}, Way{SolverKind::implicit, 0, 64, 60},
               Way{SolverKind::implicit, 0, 1, 480}, Way{SolverKind::relaxation, 0, 8, 60},
               Way{SolverKind::relaxation, 1, 32, 60}, Way{SolverKind::relaxation, 1, 8, 240});
  CAPTURE(static_cast<int>(way.solver), way.compliance, way.substeps, way.tick_rate);
  WorldDef def = held_cloth();
  def.solver.kind = way.solver;
  def.implicit.substeps = def.relaxation.substeps = way.substeps;
  def.relaxation.compliance = way.compliance;
  def.relaxation.damping = 0;
  def.tick_rate = way.tick_rate;
  World<float> world(def);
  world.grab(hand_at_the_top(world));
  advance(world, 4);
  double mass = 0;
  for (const float m : world.model().mass) mass += static_cast<double>(m);
  const double weight = mass * 9.81;
  CHECK(world.grabs().list[0].told.y() == Approx(weight).epsilon(0.02));
  CHECK(sag_of(world) == Approx(weight / 100).epsilon(0.03));
}

TEST_CASE("with implicit no held particle moves faster than 30 m/s, however short its steps") {
  const int substeps = GENERATE(1, 16);
  WorldDef def = held_cloth();
  def.cloths[0].fabric.areal_density = 0.05;
  def.solver.kind = SolverKind::implicit;
  def.implicit.substeps = substeps;
  World<float> world(def);
  GrabDef hand = hand_at_the_top(world);
  hand.stiffness = 2e4;
  hand.max_force = 1000;
  hand.target += Vec3d(0, 0, 5);
  world.grab(hand);
  double fastest = 0;
  for (int tick = 0; tick < 20; ++tick) {
    const Vec3Array<float> before = world.state().x;
    world.step();
    for (const Index k : world.grabs().list[0].particles) {
      const auto i = static_cast<std::size_t>(k);
      fastest = std::max(fastest, static_cast<double>((world.state().x[i] - before[i]).norm()) /
                                      world.tick_seconds());
    }
  }
  CHECK(fastest < 30.1);
  CHECK(fastest > 10);
}

TEST_CASE("a hand on the front of a tube without uv holds nothing of its back") {
  // Projected along an axis, both lie at the same places of the fabric.
  constexpr int kAround = 24, kRows = 9;
  ClothMesh tube;
  for (int r = 0; r < kRows; ++r) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      tube.mesh.positions.push_back(
          Vec3d(0.1 * std::cos(angle), 0.2 * r / (kRows - 1), 0.1 * std::sin(angle)));
    }
  }
  for (Index r = 0; r + 1 < kRows; ++r) {
    for (Index k = 0; k < kAround; ++k) {
      const Index a = r * kAround + k, b = r * kAround + (k + 1) % kAround;
      tube.mesh.triangles.push_back({a, b, a + kAround});
      tube.mesh.triangles.push_back({b, b + kAround, a + kAround});
    }
  }
  ClothDef cloth;
  cloth.mesh = tube;
  World<float> world(empty_world(cloth));
  int looked_at = 0;
  for (std::size_t t = 0; t < world.model().triangles.size(); ++t) {
    float depth = 0;
    for (const Index i : world.model().triangles[t])
      depth += world.state().x[static_cast<std::size_t>(i)].z() / 3;
    if (std::abs(depth) < 0.08F) continue;  // beside the silhouette a disc reaches round it
    ++looked_at;
    GrabDef hand;
    hand.triangle = static_cast<Index>(t);
    hand.radius = 0.04;
    const GrabId id = world.grab(hand);
    const Grab<float>& grab = world.grabs().list.back();
    CHECK(grab.particles.size() > 3);
    for (const Index i : grab.particles)
      CHECK(world.state().x[static_cast<std::size_t>(i)].z() * depth > 0);
    world.release(id);
  }
  CHECK(looked_at > 100);
}
