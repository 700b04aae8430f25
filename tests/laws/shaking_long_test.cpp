#include <iterator>

#include <catch2/catch.hpp>

#include "tests/laws/shaken_mesh.h"
#include "tests/laws/shaking.h"

// The laws of shaking_test.cpp on a finer cloth.

using namespace weft;

TEST_CASE(
    "64 by 64: with damping 5/s each solver is within 1 % of its rest 5 s after a disturbance") {
  const double stiffness = GENERATE(196.0, 1962.0);
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_recovery(64, stiffness, solver);
}

TEST_CASE("64 by 64: without damping no solver gains energy beyond the work of the disturbance") {
  const double stiffness = GENERATE(196.0, 1962.0);
  const test::ShakenSolver solver =
      GENERATE(from_range(std::begin(test::kShakenSolvers), std::end(test::kShakenSolvers)));
  test::check_bounded_energy(64, stiffness, solver);
}

TEST_CASE("of 20 meshes in a ball of 1 mm nine tenths come back, and no fewer than by hinges") {
  test::MeshRecoveries all, by_hinges;
  for (const double stiffness : {196.0, 1962.0}) {
    test::MeshRecoveries ours;
    for (const test::Cut cut : test::kCuts) {
      ours += test::ShakenMesh{cut, stiffness}.recoveries(test::Disturbance::crush, 20);
      by_hinges += test::ShakenMesh{cut, stiffness, BendingModel::hinges}.recoveries(
          test::Disturbance::crush, 20);
    }
    INFO(stiffness << " N/m: " << ours.back << " of " << ours.all);
    CHECK(ours.back >= 0.9 * ours.all);
    all += ours;
  }
  INFO(all.back << ", by hinges " << by_hinges.back << " of " << all.all);
  CHECK(all.back >= by_hinges.back);
}
