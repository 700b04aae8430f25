#include <cmath>
#include <iostream>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_modes.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// With implicit a mesh moves as a grid of the same fabric does, however stiff: its linear systems
// are solved as well.

using namespace weft;
using namespace weft::test;

namespace {

constexpr double kFree = 0.2, kHeld = 0.05, kWidth = 0.03, kCell = 0.005;  // [m]

/// A level cloth of a mesh whose uv are metres.
ClothDef cloth_of(const FlatMesh& flat) {
  ClothMesh cut;
  for (const auto& p : flat.points) {
    cut.mesh.positions.emplace_back(p[0], 0, p[1]);
    cut.uv.push_back({p[0], p[1]});
  }
  cut.mesh.triangles = flat.triangles;
  ClothDef cloth = flat_cloth(2, 2);
  cloth.mesh = cut;
  return cloth;
}

/// A level strip that is held at its left end.
WorldDef strip(bool mesh, double rigidity, double relaxation) {
  ClothDef cloth = mesh ? cloth_of(cut_rectangle(Cut::alternating, kFree + kHeld, kWidth, kCell))
                        : flat_cloth(7, 51, kFree + kHeld, kWidth);
  FabricDef& fabric = cloth.fabric;
  fabric.areal_density = 0.2;
  fabric.stretch_warp = fabric.stretch_weft = 3000;
  fabric.shear = 300;
  fabric.bending_warp = fabric.bending_weft = rigidity;
  fabric.bending_damping = relaxation;
  WorldDef def = empty_world(cloth);
  def.pins = {{EdgeStrip{Side::left, kHeld}, 0, {}}};
  def.solver.kind = SolverKind::implicit;
  return def;
}

struct Oscillation {
  double period = 0;  ///< [s]
  double decay = 0;   ///< of the amplitude [1/s]
};

/// How a strip swings in its first mode.
Oscillation swing(const WorldDef& def, double seconds) {
  World<float> world(def);
  const double root = 1.8751040687119612;
  const double turn = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root));
  std::size_t tip = 0;
  for (std::size_t i = 0; i < world.state().v.size(); ++i) {
    const auto x = static_cast<double>(world.state().x[i][0]);
    if (x > static_cast<double>(world.state().x[tip][0])) tip = i;
    const double s = root * (x - kHeld) / kFree;
    if (s <= 1e-6) continue;
    const double shape = std::cosh(s) - std::cos(s) - turn * (std::sinh(s) - std::sin(s));
    world.state().v[i] = Vec3f(0, static_cast<float>(0.02 * shape), 0);
  }
  world.accept_state();
  std::vector<double> crossings, peaks;
  double before = 0, peak = 0;
  while (world.report().time < seconds) {
    REQUIRE_FALSE(world.step().divergence);
    const auto y = static_cast<double>(world.state().x[tip][1]);
    peak = std::max(peak, std::abs(y));
    if (before * y < 0) {
      crossings.push_back(world.report().time - world.tick_seconds() * y / (y - before));
      peaks.push_back(peak);
      peak = 0;
    }
    before = y;
  }
  REQUIRE(crossings.size() >= 4);
  const auto halves = static_cast<double>(crossings.size() - 1);
  const double time = crossings.back() - crossings.front();
  return {2 * time / halves, std::log(peaks.front() / peaks.back()) / time};
}

}  // namespace

TEST_CASE("with implicit a stiff strip of a mesh swings as that of a grid: period to 0.2 %") {
  const double rigidity = GENERATE(5e-4, 2e-3, 8e-3);
  const double seconds = rigidity > 1e-3 ? 2 : 3;
  const Oscillation grid = swing(strip(false, rigidity, 0), seconds),
                    mesh = swing(strip(true, rigidity, 0), seconds);
  std::cout << "implicit, B " << rigidity << ": grid " << grid.period << " s, decays by "
            << grid.decay << "/s, mesh " << mesh.period << " s, " << mesh.decay << "/s"
            << std::endl;
  CHECK(mesh.period == Approx(grid.period).epsilon(0.002));
  CHECK(mesh.decay < 2 * grid.decay + 0.005);
}

TEST_CASE("with implicit bending damping makes a mesh decay by its law and what the steps lose") {
  constexpr double kTime = 5e-3;
  const WorldDef def = strip(true, 2e-3, kTime);
  const double omega = angular_frequency(def.cloths[0].fabric, FabricMode::bending, kFree);
  const Oscillation mesh = swing(def, 2);
  CHECK(mesh.decay == Approx(omega * omega * kTime / 2).epsilon(0.2));
  CHECK(mesh.period == Approx(2 * std::acos(-1.0) / omega).epsilon(0.01));
}

TEST_CASE("with implicit a level mesh falls through still air without gliding sideways") {
  ClothDef cloth = cloth_of(cut_rectangle(Cut::irregular, 0.3, 0.3, 0.03));
  FabricDef& fabric = cloth.fabric;
  fabric.areal_density = 0.1;
  fabric.stretch_warp = fabric.stretch_weft = 300;
  fabric.shear = 30;
  fabric.bending_warp = fabric.bending_weft = 1e-2;
  fabric.air_normal = 1.5;
  fabric.air_tangential = 0;
  WorldDef def = empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.air_density = 1.225;
  def.environment.still_air = true;
  def.solver.kind = SolverKind::implicit;
  World<float> world(def);
  const Vec3d start = centre_of_mass(world);
  advance(world, 2);
  const Vec3d gone = centre_of_mass(world) - start;
  INFO("gone by " << gone.transpose());
  CHECK(std::hypot(gone[0], gone[2]) < 2e-4);
}
