#include <catch2/catch.hpp>

#include "tests/laws/shaking.h"

// The laws of shaking_test.cpp on a finer cloth.

using namespace weft;

TEST_CASE("64 by 64: 5 s after an insult a cloth with drag 5/s is within 1 % of its rest") {
  const double stiffness = GENERATE(196.0, 1962.0);
  test::check_recovery(64, stiffness);
}

TEST_CASE("64 by 64: without drag an insult leaves no more energy than it brought") {
  const double stiffness = GENERATE(196.0, 1962.0);
  test::check_bounded_energy(64, stiffness);
}
