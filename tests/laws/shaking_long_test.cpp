#include <iterator>

#include <catch2/catch.hpp>

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
