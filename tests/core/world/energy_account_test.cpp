#include "core/world/energy_account.h"

#include <limits>

#include <catch2/catch.hpp>

using namespace weft;

namespace {

constexpr double kMass = 0.2;  // [kg]

AdvanceResult tick(double kinetic_before, double kinetic_after, double fallen = 0,
                   double work = 0) {
  AdvanceResult result;
  result.before.kinetic = kinetic_before;
  result.after.kinetic = kinetic_after;
  result.before.gravity = fallen;
  result.work = work;
  return result;
}

}  // namespace

TEST_CASE("energy that comes from the start, from falling or from work is no runaway") {
  const EnergyAccount account(kMass);
  CHECK_FALSE(account.is_runaway(tick(100, 100)));
  CHECK_FALSE(account.is_runaway(tick(0, 100, 100)));
  CHECK_FALSE(account.is_runaway(tick(0, 100, 0, 100)));
  CHECK_FALSE(account.is_runaway(tick(100, 0)));
}

TEST_CASE(
    "energy without a source is a runaway in the tick in which it appears, NaN and infinity too") {
  const EnergyAccount account(kMass);
  CHECK(account.is_runaway(tick(0, 100)));
  CHECK(account.is_runaway(tick(1, 100)));
  CHECK(account.is_runaway(tick(0, 100, -100)));     // it rose meanwhile
  CHECK(account.is_runaway(tick(0, 100, 0, -100)));  // and hands held it back
  CHECK(account.is_runaway(tick(0, std::numeric_limits<double>::quiet_NaN())));
  CHECK(account.is_runaway(tick(0, std::numeric_limits<double>::infinity())));
  CHECK(account.unexplained(tick(1, 100)) == Approx(99));
}

TEST_CASE("energy that went into the highest modes may come back soon, but not seconds later") {
  EnergyAccount account(kMass);
  account.accept(tick(100, 1));
  CHECK_FALSE(account.is_runaway(tick(1, 100)));
  for (int i = 0; i < 300; ++i) account.accept(tick(1, 1));
  CHECK(account.is_runaway(tick(1, 100)));
  account.accept(tick(100, 1));
  account.clear();
  CHECK(account.is_runaway(tick(1, 100)));
}
