#include "tests/laws/shaking.h"

#include <catch2/catch.hpp>

// A cloth that was shaken violently, crushed or torn by a pin comes back to its rest: without the
// dashpots along the springs it would stay stretched and hot for ever, though every number is
// finite. The finer cloths are in shaking_long_test.cpp.

using namespace weft;

TEST_CASE("33 by 33: 5 s after an insult a cloth with drag 5/s is within 1 % of its rest") {
  const double stiffness = GENERATE(196.0, 1962.0);
  test::check_recovery(33, stiffness);
}

TEST_CASE("33 by 33: without drag an insult leaves no more energy than it brought") {
  const double stiffness = GENERATE(196.0, 1962.0);
  test::check_bounded_energy(33, stiffness);
}
