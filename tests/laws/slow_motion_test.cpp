#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// Slow cloth with many substeps, a metre and more from the origin, where a float counts in steps of
// 0.1 um: it moves by less than one of these in a substep.

using namespace weft;

namespace {

/// Lifts a cloth's whole shape.
void move(ClothDef& cloth, const Vec3d& way) {
  cloth.origin += way;
  if (cloth.mesh) {
    for (Vec3d& p : cloth.mesh->mesh.positions) p += way;
  }
}

/// A grid and a mesh, 1.3 m away in each direction.
std::vector<ClothDef> sheets() {
  std::vector<ClothDef> all = {test::flat_cloth(9, 8, 0.3, 0.3),
                               test::triangle_sheet(test::Cut::irregular, 0.3, 0.3, 0.04)};
  for (ClothDef& sheet : all) move(sheet, Vec3d(1.3, 1.3, 1.3));
  return all;
}

/// How far the middle moves in a second, over how far it should, less one.
double excess(const WorldDef& def, const Vec3d& velocity) {
  World<float> world(def);
  for (Vec3f& v : world.state().v) v = velocity.cast<float>();
  world.accept_state();
  const Vec3d before = test::centre_of_mass(world);
  test::advance(world, 1);
  const Vec3d way = test::centre_of_mass(world) - before;
  return (way - velocity).norm() / velocity.norm();
}

}  // namespace

TEST_CASE("free cloth of 1 mm/s goes 1 mm in a second to 0.4 %, whatever its substeps") {
  for (const ClothDef& sheet : sheets()) {
    for (const int substeps : {50, 400, 3000}) {
      for (const bool touches : {false, true}) {
        for (const double density : {0.0, 1e-9}) {
          WorldDef def = test::empty_world(sheet);
          def.solver.min_substeps = substeps;
          def.environment.air_density = density;
          if (touches) {
            def.contact.seed.self = SelfContact::guard;
            def.colliders = {{"ground", PlaneDef{}}};
          }
          INFO(substeps << " substeps, contact " << touches << ", air " << density);
          CHECK(excess(def, Vec3d(1e-3, 1e-3, 1e-3) / std::sqrt(3.0)) < 0.004);
        }
      }
    }
  }
}

TEST_CASE("a slow swing of stiff cloth is the same in single precision as in double, to 2 %") {
  for (ClothDef sheet : sheets()) {
    sheet.fabric.stretch_warp = sheet.fabric.stretch_weft = 2e5;
    sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-3;
    WorldDef def = test::empty_world(sheet);
    def.pins = {{EdgeStrip{Side::top, 0.08}, 0, {}}};
    // Across the sheet.
    def.environment.gravity = sheet.mesh ? Vec3d(0, 0, -0.01) : Vec3d(0, -0.01, 0);
    World<float> single(def);
    World<double> exact(def);
    double largest = 0, off = 0;
    for (int tick = 0; tick < 90; ++tick) {
      single.step();
      exact.step();
      for (std::size_t i = 0; i < exact.state().x.size(); ++i) {
        const Vec3d moved = exact.state().x[i] - exact.model().rest_positions[i];
        const Vec3f rounded = single.state().x[i] - single.model().rest_positions[i];
        largest = std::max(largest, moved.norm());
        off = std::max(off, (rounded.cast<double>() - moved).norm());
      }
    }
    INFO(exact.report().substeps << " substeps, moves by " << largest << " m, off by " << off);
    CHECK(exact.report().substeps > 300);
    CHECK(largest > 1e-3);
    CHECK(off < 0.02 * largest);
  }
}
