#include "core/world/pin_extent.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// What pins hold of the fabric, beside what was asked for.

using namespace weft;

namespace {

/// A square metre with cells of a side of 1 / (particles - 1).
std::vector<PinExtent> extents(int particles, const std::vector<PinDef>& pins) {
  WorldDef def = test::empty_world(test::flat_cloth(particles, particles, 1, 1));
  def.pins = pins;
  return coarse_pins(World<double>(def));
}

}  // namespace

TEST_CASE("a strip is told with the width that it holds, if that is off by more than 1 %") {
  CHECK(extents(41, {{EdgeStrip{Side::top, 0.05}, 0, {}}}).empty());
  CHECK(extents(41, {{EdgeStrip{Side::top, 0.0504}, 0, {}}}).empty());
  const auto found = extents(41, {{EdgeStrip{Side::top, 0.05}, 0, {}},
                                  {EdgeStrip{Side::right, 0.07}, 0, {}},
                                  {EdgeStrip{Side::bottom, 0}, 0, {}}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].pin == 1);
  CHECK(found[0].asked == 0.07);
  CHECK(found[0].held == Approx(0.075));
  CHECK(found[0].clamps);
  CHECK(describe(found).rfind("pins[1]: a strip of 0.07 m holds the fabric up to 0.075 m", 0) == 0);
}

TEST_CASE("of a disc the area within the fabric was asked for: whole, half and a quarter") {
  constexpr double kPi = 3.14159265358979323846;
  const auto [place, part] = GENERATE(table<PinPlace, double>(
      {{MaterialPoint{0.5, 0.5}, 1}, {MaterialPoint{0.5, 0}, 0.5}, {Corner::bottom_right, 0.25}}));
  const auto found = extents(41, {{place, 0.06, {}}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].asked_area == Approx(part * kPi * 0.06 * 0.06).epsilon(1e-9));
  CHECK(found[0].held == Approx(0.025 * std::sqrt(5.0)));  // (2, 1) cells away; (2, 2) is beyond
}

TEST_CASE(
    "a disc holds the area of its particles: that of a coarse one is far off, a fine one near") {
  const auto coarse = extents(21, {{MaterialPoint{0.5, 0.5}, 0.06, {}}});
  REQUIRE(coarse.size() == 1);
  CHECK(coarse[0].held_area == Approx(5 * 0.05 * 0.05));
  const auto fine = extents(401, {{MaterialPoint{0.5, 0.5}, 0.06, {}}});
  REQUIRE(fine.size() == 1);  // it holds what lies just beyond its circle too, and clamps there
  CHECK(fine[0].clamps);
  CHECK(fine[0].held_area == Approx(fine[0].asked_area).epsilon(0.06));
}

TEST_CASE("a single particle asks for no area, and of many pins the first four are named") {
  CHECK(extents(21, {{7, 0, {}}, {Corner::top_left, 0, {}}}).empty());
  std::vector<PinDef> pins;
  for (int k = 0; k < 6; ++k) pins.push_back({MaterialPoint{0.5, 0.1 * k + 0.1}, 0.06, {}});
  const std::string text = describe(extents(21, pins));
  CHECK(text.find("pins[3]") != std::string::npos);
  CHECK(text.find("pins[4]") == std::string::npos);
  CHECK(text.find("; and 2 more") != std::string::npos);
}

TEST_CASE("a pin that holds all of its cloth is told so, and not that a finer grid comes nearer") {
  const PinDef strip{EdgeStrip{Side::left, 3}, 0, {}}, disc{MaterialPoint{0.5, 0.5}, 2, {}};
  for (const int particles : {5, 41}) {
    CHECK(describe(extents(particles, {strip})) ==
          "pins[0]: a strip of 3 m holds all of its cloth");
    CHECK(describe(extents(particles, {disc})) == "pins[0]: a disc of 2 m holds all of its cloth");
  }
  const auto found = extents(41, {strip, {EdgeStrip{Side::right, 0.07}, 0, {}}});
  CHECK(describe(found).find("and a finer grid comes nearer") != std::string::npos);
  CHECK(extents(41, {{EdgeStrip{Side::left, 1}, 0, {}}}).empty());
}
