#include "tests/laws/shaking.h"

#include <iterator>

#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"

// A cloth that was shaken violently, crushed or torn by a pin comes back to its rest: without the
// dashpots along the springs it would stay stretched and hot for ever, though every number is
// finite. The finer cloths are in shaking_long_test.cpp.

using namespace weft;

TEST_CASE(
    "33 by 33: with damping 5/s each solver is within 1 % of its rest 5 s after a disturbance") {
  const double stiffness = GENERATE(196.0, 1962.0);
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_recovery(33, stiffness, solver);
}

TEST_CASE("33 by 33: without damping no solver gains energy beyond the work of the disturbance") {
  const double stiffness = GENERATE(196.0, 1962.0);
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_bounded_energy(33, stiffness, solver);
}

namespace {

/// The same square as a mesh, whose membrane can be as hard to quieten as springs.
WorldDef hanging_mesh(test::Cut cut, double stiffness, double damping) {
  WorldDef def = test::hanging_square(25, stiffness, damping, {"verlet"});
  ClothDef& cloth = def.cloths[0];
  cloth.mesh = test::triangle_sheet(cut, 1, 1, 1.0 / 24).mesh;
  def.pins = test::upper_border(cloth);
  return def;
}

}  // namespace

TEST_CASE("a mesh comes back to its rest after a disturbance, and never has more energy") {
  const test::Cut cut = GENERATE(from_range(test::kCuts));
  const double stiffness = GENERATE(196.0, 1962.0);
  World<float> resting(hanging_mesh(cut, stiffness, 5));
  test::advance(resting, 6);
  const Vec3Array<float> rest = resting.state().x;
  const double least = test::energy_of(resting);
  int back = 0;
  for (const test::Disturbance kind : {test::Disturbance::noise, test::Disturbance::crush}) {
    for (unsigned seed = 20; seed < 23; ++seed) {
      INFO(test::name_of(cut) << ", " << stiffness << " N/m, " << test::name_of(kind) << ", "
                              << seed);
      World<float> world(hanging_mesh(cut, stiffness, 5));
      test::advance(world, 1);
      REQUIRE(test::disturb(world, kind, seed).rescues == 0);
      for (int tick = 0; tick < 300; ++tick) REQUIRE_FALSE(world.step().divergence);
      // Noise of 20 m/s may leave a tuck, in which the sheet rests as well.
      const double off = test::distance_from(rest, world);
      if (kind == test::Disturbance::crush) CHECK(off < 0.02);
      back += off < 0.02 ? 1 : 0;
      World<float> free(hanging_mesh(cut, stiffness, 0));
      test::advance(free, 1);
      const test::DisturbanceEffect effect = test::disturb(free, kind, seed);
      REQUIRE(effect.rescues == 0);
      const double brought = effect.before + effect.work - least;
      double most = effect.excess + brought;
      for (int tick = 0; tick < 120; ++tick) {
        // Undamped noise of 20 m/s may ask for a tick with more substeps, never for a stop.
        const std::optional<Divergence> divergence = free.step().divergence;
        if (divergence) REQUIRE(divergence->remedy == DivergenceRemedy::more_substeps);
        most = std::max(most, test::energy_of(free) - least);
      }
      CHECK(most <= 1.01 * brought);
    }
  }
  CHECK(back >= 5);  // of six
}
