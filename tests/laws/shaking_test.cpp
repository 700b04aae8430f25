#include "tests/laws/shaking.h"

#include <iterator>

#include <catch2/catch.hpp>

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
