#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "core/attachments/clamp_line.h"
#include "core/attachments/pin_place.h"
#include "core/attachments/pins.h"
#include "tests/support/cloths.h"

// Discs whose circles go through particles: what they hold is decided by the fabric, not by
// rounding.

using namespace weft;

namespace {

/// What a disc does to a square grid.
struct HeldGrid {
  bool clamps = false;
  std::vector<char> has;        ///< of each particle
  std::vector<double> factors;  ///< of the bending about each, the larger one
};

template <class Real>
HeldGrid held_on_grid(ClothModel<Real>& model, int side, const MaterialPoint& at, double radius) {
  Pins pins = make_pins(model);
  ClothState<Real> state = initial_state(model);
  const PinId id = add_pin(model, {at, radius, ""}, pins, state);
  set_clamps(clamps_of(pins), model);
  HeldGrid held;
  held.clamps = find_pinned(model, {at, radius, ""}).disc.has_value();
  held.has.assign(model.mass.size(), 0);
  for (const Index i : pins.list[0].particles) held.has[at_index(i)] = 1;
  const GridCells& cells = model.parts[0].cells;
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c)
      held.factors.push_back(
          std::max(cells.stiffening_along_u(r, c), cells.stiffening_along_v(r, c)));
  }
  remove_pin(model, id, pins, state);
  set_clamps(clamps_of(pins), model);
  return held;
}

}  // namespace

TEMPLATE_TEST_CASE("a disc of whole cells on a grid holds and clamps mirrored and turned alike", "",
                   float, double) {
  const int side = GENERATE(21, 41);
  const double width = GENERATE(1.0, 0.3);
  const int cells = GENERATE(1, 2, 3, 4, 5, 6);
  CAPTURE(side, width, cells);
  ClothDef cloth = test::flat_cloth(side, side, width, width);
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-5;
  ClothModel<TestType> model = build_cloth<TestType>(cloth);
  const double radius = cells * width / (side - 1);
  for (const double u : {0.0, 0.25, 0.5}) {
    const double v = 0.75;
    const HeldGrid held = held_on_grid(model, side, {u, v}, radius);
    CHECK(held.clamps == (cells >= 3));
    const auto check = [&](const MaterialPoint& at, auto&& image_of) {
      const HeldGrid image = held_on_grid(model, side, at, radius);
      CHECK(image.clamps == held.clamps);
      for (int r = 0; r < side; ++r) {
        for (int c = 0; c < side; ++c) {
          const auto [row, column] = image_of(r, c);
          REQUIRE(image.has[at_index(row * side + column)] == held.has[at_index(r * side + c)]);
          CHECK(image.factors[at_index(row * side + column)] ==
                Approx(held.factors[at_index(r * side + c)]).epsilon(1e-3));
        }
      }
    };
    check({1 - u, v}, [&](int r, int c) { return std::pair(r, side - 1 - c); });
    check({u, 1 - v}, [&](int r, int c) { return std::pair(side - 1 - r, c); });
    check({v, u}, [](int r, int c) { return std::pair(c, r); });
  }
}

TEMPLATE_TEST_CASE("a disc holds what lies on its circle, wherever on a mesh it is", "", float,
                   double) {
  constexpr int kSide = 21;
  const double from = GENERATE(0.0, 1.0, 0.3), cell = GENERATE(0.05, 0.013);
  const int cells = GENERATE(1, 2, 3, 5);
  CAPTURE(from, cell, cells);
  ClothDef cloth;
  cloth.mesh = ClothMesh{};
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      const double u = from + cell * c, v = cell * r;
      cloth.mesh->mesh.positions.emplace_back(u, 0, v);
      cloth.mesh->uv.push_back({u, v});
      if (r == 0 || c == 0) continue;
      const Index d = r * kSide + c, b = d - kSide;
      cloth.mesh->mesh.triangles.push_back({b - 1, d - 1, d});
      cloth.mesh->mesh.triangles.push_back({b - 1, d, b});
    }
  }
  const ClothModel<TestType> model = build_cloth<TestType>(cloth);
  for (const int row : {0, 5, 10, 20}) {
    for (const int column : {0, 5, 10, 20}) {
      std::vector<Index> expected;
      for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) {
          const int across = c - column, along = r - row;
          if (across * across + along * along <= cells * cells) expected.push_back(r * kSide + c);
        }
      }
      const MaterialPoint at{column / (kSide - 1.0), row / (kSide - 1.0)};
      std::vector<Index> held;  // as the vertices were numbered
      for (const Index i : find_pinned(model, {at, cells * cell, ""}).particles) {
        const auto& place = model.material[at_index(i)];
        const auto c = std::lround((static_cast<double>(place[0]) - from) / cell);
        const auto r = std::lround(static_cast<double>(place[1]) / cell);
        held.push_back(static_cast<Index>(r * kSide + c));
      }
      std::sort(held.begin(), held.end());
      CHECK(held == expected);
    }
  }
}
