#include "core/world/energy_account.h"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

using namespace weft;

namespace {

constexpr double kMass = 0.2;  // [kg]
constexpr double kTick = 1.0 / 60;

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
  account.accept(tick(100, 1), kTick);
  CHECK_FALSE(account.is_runaway(tick(1, 100)));
  for (int i = 0; i < 300; ++i) account.accept(tick(1, 1), kTick);
  CHECK(account.is_runaway(tick(1, 100)));
  account.accept(tick(100, 1), kTick);
  account.clear();
  CHECK(account.is_runaway(tick(1, 100)));
}

TEST_CASE("energy that has gone is forgotten by time, not by ticks: after 0.5 s alike to 15 %") {
  const auto left = [](int ticks) {
    EnergyAccount account(kMass);
    account.accept(tick(1000, 0), 1e-9);
    for (int i = 0; i < ticks; ++i) account.accept(tick(0, 0), 0.5 / ticks);
    return -account.unexplained(tick(0, 0));
  };
  CHECK(left(30) == Approx(1000 * std::exp(-0.5 / 0.325)).epsilon(0.05));
  CHECK(left(500) == Approx(left(30)).epsilon(0.15));
  CHECK(left(15) == Approx(left(30)).epsilon(0.15));
}
