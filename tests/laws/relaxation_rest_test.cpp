#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// XPBD near rest, where a sheet shows whether the map of a substep grows anything.

using namespace weft;
using namespace weft::test;

namespace {

WorldDef xpbd_world(ClothDef cloth, const char* fabric, int sweeps, int substeps) {
  cloth.fabric = make_fabric(fabric);
  WorldDef def = empty_world(cloth);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.compliance = 1;
  def.relaxation.damping = 0;
  def.relaxation.sweeps = sweeps;
  def.relaxation.substeps = substeps;
  return def;
}

/// Stirs a sheet a little, in its plane and across it, and tells the most kinetic energy that it
/// has at the end of any of 60 ticks, as a multiple of what it was given. That of its shape says
/// little: XPBD is softer than the fabric, of which it is told.
double largest_growth(const WorldDef& def) {
  World<float> world(def);
  SeededRandom random(11);
  double given = 0;
  for (std::size_t i = 0; i < world.state().v.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      world.state().v[i][axis] = static_cast<float>(random.uniform(-0.01, 0.01));
    given += 0.5 * static_cast<double>(world.model().mass[i]) *
             static_cast<double>(world.state().v[i].squaredNorm());
  }
  world.accept_state();
  double most = 0;
  for (int tick = 0; tick < 60; ++tick) {
    const TickReport& report = world.step();
    if (report.divergence) return INFINITY;
    most = std::max(most, report.energies.kinetic / given);
  }
  return most;
}

/// A sheet of cells of 15 mm: long ones show waves that grow as they travel.
ClothDef grid_of(int rows, int columns, BendingModel bending) {
  ClothDef cloth = flat_cloth(rows, columns, 0.015 * (columns - 1), 0.015 * (rows - 1));
  cloth.bending_model = bending;
  return cloth;
}

}  // namespace

TEST_CASE("stirred at rest a grid under XPBD never moves with more energy than it was given") {
  const char* fabric = GENERATE("cotton", "silk", "wool", "denim", "leather", "nylon");
  const BendingModel bending = GENERATE(BendingModel::quadratic, BendingModel::hinges);
  const int substeps = GENERATE(1, 4, 16);
  for (const int sweeps : {1, 2, 3, 5}) {
    for (const auto& [rows, columns] : {std::pair{20, 20}, {60, 6}, {6, 60}}) {
      INFO(fabric << (bending == BendingModel::hinges ? " with hinges, " : ", ") << substeps
                  << " substeps of " << sweeps << ", " << rows << " x " << columns);
      CHECK(largest_growth(xpbd_world(grid_of(rows, columns, bending), fabric, sweeps, substeps)) <
            1.01);
    }
  }
}

TEST_CASE("stirred at rest a mesh under XPBD never moves with more energy than it was given") {
  const char* fabric = GENERATE("cotton", "nylon");
  const Cut cut = GENERATE(Cut::one_diagonal, Cut::irregular);
  const int substeps = GENERATE(1, 16);
  for (const int sweeps : {1, 2, 3, 5}) {
    for (const auto& [width, height] : {std::pair{0.3, 0.3}, {0.1, 0.9}, {0.9, 0.1}}) {
      INFO(fabric << ", " << name_of(cut) << ", " << substeps << " substeps of " << sweeps << ", "
                  << width << " x " << height);
      CHECK(largest_growth(xpbd_world(triangle_sheet(cut, width, height, 0.02), fabric, sweeps,
                                      substeps)) < 1.01);
    }
  }
}

TEST_CASE("hung by two corners a sheet under XPBD comes to rest, whatever its sweeps") {
  const int sweeps = GENERATE(1, 2, 3, 5), substeps = GENERATE(8, 32);
  const BendingModel bending = GENERATE(BendingModel::quadratic, BendingModel::hinges);
  WorldDef def = xpbd_world(grid_of(20, 20, bending), "nylon", sweeps, substeps);
  def.pins = {{Corner::top_left, 0, {}}, {Corner::top_right, 0, {}}};
  def.environment.gravity = Vec3d(0, -9.81, 0);
  INFO(substeps << " substeps of " << sweeps
                << (bending == BendingModel::hinges ? ", with hinges" : ""));
  World<float> world(def);
  CHECK(settle(world, 5, 8) < 0.003);
}
