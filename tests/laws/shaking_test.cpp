#include "tests/laws/shaking.h"

#include <iterator>

#include <catch2/catch.hpp>

#include "tests/laws/shaken_mesh.h"

// A cloth that was shaken violently, crushed or torn by a pin comes back to its rest: without the
// dashpots along the springs it would stay stretched and hot for ever, though every number is
// finite. Stiffer and finer cloths are in shaking_long_test.cpp.

using namespace weft;

TEST_CASE(
    "33 by 33: with damping 5/s each solver is within 1 % of its rest 5 s after a disturbance") {
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_recovery(33, 196, solver);
}

TEST_CASE("33 by 33: without damping no solver gains energy beyond the work of the disturbance") {
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_bounded_energy(33, 196, solver);
}

TEST_CASE("a mesh comes back from noise of 5 m/s each time") {
  const test::Cut cut = GENERATE(from_range(test::kCuts));
  const double stiffness = GENERATE(196.0, 1962.0);
  INFO(test::name_of(cut) << ", " << stiffness << " N/m");
  const test::MeshRecoveries thrown =
      test::ShakenMesh{cut, stiffness}.recoveries(test::Disturbance::noise, 4, 5);
  CHECK(thrown.back == thrown.all);
}

TEST_CASE("a shaken mesh never has more energy than it was given") {
  const test::Cut cut = GENERATE(from_range(test::kCuts));
  const double stiffness = GENERATE(196.0, 1962.0);
  const test::ShakenMesh mesh{cut, stiffness};
  const double least = mesh.least_energy();
  for (const test::Disturbance kind : {test::Disturbance::noise, test::Disturbance::crush}) {
    for (unsigned seed = 20; seed < 23; ++seed) {
      INFO(test::name_of(cut) << ", " << stiffness << " N/m, " << test::name_of(kind) << ", "
                              << seed);
      World<float> free(mesh.world(0));
      test::advance(free, 1);
      const test::DisturbanceEffect effect = test::disturb(free, kind, seed);
      REQUIRE(effect.rescues == 0);
      const double brought = effect.before + effect.work - least;
      double most = effect.excess + brought;
      for (int tick = 0; tick < 120; ++tick) {
        test::require_no_stop(free.step());
        most = std::max(most, test::energy_of(free) - least);
      }
      CHECK(most <= 1.01 * brought);
    }
  }
}
