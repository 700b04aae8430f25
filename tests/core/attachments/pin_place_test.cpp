#include "core/attachments/pin_place.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/attachments/constants.h"
#include "core/error.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"

using namespace weft;

namespace {

ClothModel<double> two_cloths() {
  ClothDef first = test::flat_cloth(5, 7, 1.2, 0.8), second = test::flat_cloth(3, 4, 0.6, 0.4);
  second.name = "second";
  return build_cloths<double>({first, second});
}

std::string refused_field(const PinDef& def) {
  try {
    find_pinned(two_cloths(), def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "nothing";
}

}  // namespace

TEST_CASE("corners are the ends of the first and last row") {
  const ClothModel<double> model = two_cloths();
  const auto at = [&](Corner corner, const char* cloth) {
    return find_pinned(model, {corner, 0, cloth}).particles;
  };
  CHECK(at(Corner::top_left, "") == std::vector<Index>{0});
  CHECK(at(Corner::top_right, "") == std::vector<Index>{6});
  CHECK(at(Corner::bottom_left, "") == std::vector<Index>{28});
  CHECK(at(Corner::bottom_right, "") == std::vector<Index>{34});
  CHECK(at(Corner::top_right, "second") == std::vector<Index>{35 + 3});
  CHECK(at(Corner::bottom_left, "second") == std::vector<Index>{35 + 8});
}

TEST_CASE("a strip holds the lines up to its border, or one more where that is nearer") {
  // Cells are 0.2 m; a strip of 1.95 cells holds three lines.
  const ClothModel<double> model = two_cloths();
  const auto [side, width, rows_or_columns] = GENERATE(table<Side, double, int>({
      {Side::top, 0, 1},
      {Side::top, 0.2, 2},
      {Side::top, 0.27, 2},
      {Side::top, 0.28, 3},
      {Side::left, 0.01, 2},
      {Side::bottom, 0.39, 3},
      {Side::left, 0, 1},
      {Side::right, 0.4, 3},
      {Side::right, 0.41, 3},
      {Side::bottom, 100, 5},
  }));
  const bool lines_are_rows = side == Side::top || side == Side::bottom;
  const PinnedParticles held = find_pinned(model, {EdgeStrip{side, width}, 0, ""});
  CHECK(held.particles.size() ==
        static_cast<std::size_t>(rows_or_columns * (lines_are_rows ? 7 : 5)));
  CHECK(std::binary_search(held.particles.begin(), held.particles.end(), held.centre));
  for (const Index i : held.particles) {
    const int row = i / 7, column = i % 7;
    const int line = side == Side::top      ? row
                     : side == Side::bottom ? 4 - row
                     : side == Side::left   ? column
                                            : 6 - column;
    CHECK(line < rows_or_columns);
  }
}

TEST_CASE("what bends at a strip's border reaches from there to the middle of the next cell") {
  for (double width = 0; width < 8; width += 1.0 / 64) {
    const HeldLines held = held_lines(width, 1e-6, 12);
    CHECK(held.lines >= (width > 0 ? 2 : 1));
    if (width == 0) continue;
    const double middle_of_free_cell = held.lines - 0.5;
    CHECK(held.stiffening == Approx(1 / (middle_of_free_cell - width)).epsilon(2e-4));
    CHECK(held.stiffening <= kMostStiffening);
    // Sums of such weights are exact in single precision.
    CHECK(held.stiffening * kStiffeningParts == std::round(held.stiffening * kStiffeningParts));
  }
  CHECK(held_lines(2 - 1e-7, 1e-6, 12).lines == 3);
  CHECK(held_lines(2 + 1e-7, 1e-6, 12).stiffening == 2);
}

TEST_CASE("what holds all lines, and a strip of no width, clamp nothing") {
  const ClothModel<double> model = two_cloths();
  CHECK(held_lines(0, 1e-6, 12).lines == 1);
  CHECK(held_lines(11, 1e-6, 12).lines == 12);
  CHECK(held_lines(10.5, 1e-6, 12).lines == 12);
  CHECK_FALSE(find_pinned(model, {EdgeStrip{Side::left, 0}, 0, ""}).clamp);
  CHECK_FALSE(find_pinned(model, {EdgeStrip{Side::bottom, 100}, 0, ""}).clamp);
  CHECK_FALSE(find_pinned(model, {MaterialPoint{0.5, 0.5}, 0.3, ""}).clamp);
}

TEST_CASE("of strips along one side the widest clamps; those along others clamp beside it") {
  ClothModel<double> model = two_cloths();
  Pins pins = make_pins(model);
  ClothState<double> state = initial_state(model);
  const auto factors = [&] {
    set_clamps(clamps_of(pins), model);
    return model.parts[0].cells.row_stiffening;
  };
  const auto pin = [&](Side side, double width) {
    return add_pin(model, {EdgeStrip{side, width}, 0, ""}, pins, state);
  };
  pin(Side::top, 0.2);
  CHECK(factors() == std::vector<double>{1, 2, 1, 1, 1});
  const PinId wide = pin(Side::top, 0.45);
  CHECK(factors() == std::vector<double>{1, 1, 4, 1, 1});
  pin(Side::bottom, 0.2);
  CHECK(factors() == std::vector<double>{1, 1, 4, 2, 1});
  pin(Side::right, 0.2);
  CHECK(factors() == std::vector<double>{1, 1, 4, 2, 1});
  CHECK(model.parts[0].cells.column_stiffening == std::vector<double>{1, 1, 1, 1, 1, 2, 1});
  CHECK(model.parts[1].cells.row_stiffening.empty());
  remove_pin(model, wide, pins, state);
  CHECK(factors() == std::vector<double>{1, 2, 1, 2, 1});
  CHECK(set_clamps(clamps_of(pins), model).empty());
  CHECK(set_clamps({}, model) == std::vector<std::size_t>{0});
  CHECK(model.parts[0].cells.row_stiffening.empty());
}

TEST_CASE("a point of the fabric is its nearest particle, at any resolution") {
  for (const int rows : {9, 17, 33}) {
    const ClothModel<double> model = build_cloth<double>(test::flat_cloth(rows, 2 * rows - 1));
    const PinnedParticles held = find_pinned(model, {MaterialPoint{0.25, 0.5}, 0.1, ""});
    const auto& m = model.material[static_cast<std::size_t>(held.centre)];
    CHECK(m[0] == Approx(0.25));
    CHECK(m[1] == Approx(0.5));
    // About pi r^2 / h^2 particles; fewer on a coarse grid.
    const double cells = 3.14159 * 0.01 * (rows - 1) * (2 * rows - 2);
    CHECK(static_cast<double>(held.particles.size()) == Approx(cells).epsilon(0.5));
  }
}

TEST_CASE(
    "a pin holds its own piece of a mesh, where another one has the same place in the fabric") {
  ClothDef def;
  ClothMesh& pieces = def.mesh.emplace();
  constexpr int kSide = 7;
  for (const double z : {0.0, 0.1}) {
    const auto first = static_cast<Index>(pieces.mesh.positions.size());
    for (int r = 0; r < kSide; ++r) {
      for (int c = 0; c < kSide; ++c) {
        pieces.mesh.positions.emplace_back(0.1 * c, 0.1 * r, z);
        pieces.uv.push_back({0.1 * c, 0.1 * r});
        if (r + 1 == kSide || c + 1 == kSide) continue;
        const Index a = first + r * kSide + c, b = a + kSide;
        pieces.mesh.triangles.push_back({a, a + 1, b});
        pieces.mesh.triangles.push_back({a + 1, b + 1, b});
      }
    }
  }
  const ClothModel<double> model = build_cloth<double>(def);
  for (const double radius : {0.0, 0.05, 0.15}) {
    INFO("radius " << radius);
    for (const Index centre : {Index{20}, Index{60}}) {
      const double z = model.rest_positions[static_cast<std::size_t>(centre)][2];
      const std::vector<Index> held = find_pinned(model, {centre, radius, {}}).particles;
      CHECK(held.size() == (radius < 0.1 ? 1 : held.size()));
      CHECK(std::find(held.begin(), held.end(), centre) != held.end());
      for (const Index i : held) CHECK(model.rest_positions[static_cast<std::size_t>(i)][2] == z);
    }
  }
}

TEST_CASE("a place that does not exist is refused by its field") {
  CHECK(refused_field({Index(-1), 0, ""}) == "pin.particle");
  CHECK(refused_field({Index(47), 0, ""}) == "pin.particle");
  CHECK(refused_field({Index(46), 0, ""}) == "nothing");
  CHECK(refused_field({Index(12), 0, "second"}) == "pin.particle");
  CHECK(refused_field({Index(11), 0, "second"}) == "nothing");
  CHECK(refused_field({Index(0), -1, ""}) == "pin.radius");
  CHECK(refused_field({Index(0), 0, "third"}) == "pin.cloth");
  CHECK(refused_field({EdgeStrip{Side::top, -1}, 0, ""}) == "pin.width");
  CHECK(refused_field({MaterialPoint{1.5, 0}, 0, ""}) == "pin.u");
  CHECK(refused_field({MaterialPoint{0, std::nan("")}, 0, ""}) == "pin.v");
}

TEST_CASE("every scene keeps its pins at any resolution") {
  for (const SceneInfo& scene : scenes()) {
    INFO(scene.name);
    if (!scene.installed.empty()) continue;
    const World<float> as_built(make_scene(scene.name));
    WorldDef def = make_scene(scene.name);
    for (ClothDef& cloth : def.cloths) {
      cloth.rows += 12;
      cloth.columns += 16;
    }
    const World<float> finer(def);
    REQUIRE(finer.pins().list.size() == as_built.pins().list.size());
    for (std::size_t k = 0; k < finer.pins().list.size(); ++k) {
      const auto where = [k](const World<float>& world) {
        return world.model().rest_positions[static_cast<std::size_t>(world.pins().list[k].centre)];
      };
      CHECK((where(finer) - where(as_built)).norm() < 0.05);
    }
  }
}

TEST_CASE("the default scene hangs by six particles, three at each upper corner") {
  const World<float> world(make_scene("default"));
  std::vector<Index> held;
  for (const Pin& pin : world.pins().list)
    held.insert(held.end(), pin.particles.begin(), pin.particles.end());
  CHECK(held == std::vector<Index>{0, 30, 60, 17 * 30, 18 * 30, 19 * 30});
}

TEST_CASE("a disc clamps each line that its circle crosses, at the circle") {
  constexpr int kSide = 21;
  constexpr double kCell = 0.02;
  const double radius = GENERATE(0.0601, 0.0777, 0.095);
  ClothDef cloth = test::flat_cloth(kSide, kSide, kCell * (kSide - 1), kCell * (kSide - 1));
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-5;
  ClothModel<double> model = build_cloth<double>(cloth);
  Pins pins = make_pins(model);
  ClothState<double> state = initial_state(model);
  const PinId id = add_pin(model, {MaterialPoint{0.5, 0.5}, radius, ""}, pins, state);
  CHECK(set_clamps(clamps_of(pins), model) == std::vector<std::size_t>{0});
  const GridCells& cells = model.parts[0].cells;
  const std::vector<Index>& held = pins.list[0].particles;
  const auto is_held = [&](int r, int c) {
    return std::binary_search(held.begin(), held.end(), Index(r * kSide + c));
  };
  int clamped = 0;
  for (int r = 1; r + 1 < kSide; ++r) {
    for (int c = 1; c + 1 < kSide; ++c) {
      const double u = kCell * (c - kSide / 2), v = kCell * (r - kSide / 2);
      if (std::hypot(u, v) < radius) CHECK(is_held(r, c));
      CHECK(cells.stiffening_along_u(r, c) == Approx(cells.stiffening_along_v(c, r)));
      const double factor = cells.stiffening_along_u(r, c);
      CHECK(factor <= kMostStiffening);
      const int outwards = u < 0 ? c - 1 : c + 1;
      if (u == 0 || !is_held(r, c) || is_held(r, outwards) || std::abs(v) > radius) {
        CHECK(factor == 1);
        continue;
      }
      // From the circle to the middle of the first free cell.
      const double bends = std::abs(u) + kCell / 2 - std::sqrt(radius * radius - v * v);
      if (bends > 1.5 * kCell) continue;  // the line only just crosses it
      CHECK(factor * bends == Approx(kCell).epsilon(1e-3));
      ++clamped;
    }
  }
  CHECK(clamped >= 10);
  remove_pin(model, id, pins, state);
  CHECK(set_clamps(clamps_of(pins), model) == std::vector<std::size_t>{0});
  CHECK(cells.site_stiffening.empty());
}

TEST_CASE("a disc of less than three cells holds the particles within it alone") {
  ClothDef cloth = test::flat_cloth(21, 21, 0.4, 0.4);
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-5;
  const ClothModel<double> model = build_cloth<double>(cloth);
  const PinnedParticles held = find_pinned(model, {MaterialPoint{0.5, 0.5}, 0.059, ""});
  CHECK_FALSE(held.disc);
  CHECK(held.particles == particles_in_disc(model, held.centre, 0.059));
}

TEST_CASE("pins that are released together leave what they leave one by one, moving ones too") {
  WorldDef def;
  def.cloths[0] = test::flat_cloth(21, 17);
  def.cloths[0].fabric.bending_warp = def.cloths[0].fabric.bending_weft = 1e-4;
  for (const double u : {0.1, 0.3, 0.5, 0.7}) def.pins.push_back({MaterialPoint{u, 0.4}, 0.25, {}});
  def.pins.push_back({EdgeStrip{Side::top, 0.1}, 0, {}});
  const auto left = [&](bool together) {
    World<float> world(def);
    PinMove move;
    move.target = Vec3d(0, 3, 0);
    world.move_pin(world.pins().list[1].id, move);
    world.step();
    const std::vector<PinId> ids = {world.pins().list[0].id, world.pins().list[1].id,
                                    world.pins().list[4].id};
    if (together)
      world.unpin(ids);
    else
      for (const PinId id : ids) CHECK(world.unpin(id));
    CHECK(world.pins().list.size() == 2);
    for (int t = 0; t < 5; ++t) world.step();
    return world.hash();
  };
  CHECK(left(true) == left(false));
}

TEST_CASE("a particle is free once no pin that rests holds it, whatever moves, stops and goes") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(5, 5));
  ClothState<double> state = initial_state(model);
  Pins pins = make_pins(model);
  const PinId a = add_pin(model, {12, 10.0, {}}, pins, state),
              b = add_pin(model, {12, 0.0, {}}, pins, state);
  CHECK(pins.held == 26);
  const auto is_free = [&](std::size_t i) { return state.inverse_mass[i] > 0; };
  CHECK_FALSE(is_free(3));
  move_pin(model, a, PinMove{}, pins, state);
  CHECK(is_free(3));
  CHECK_FALSE(is_free(12));
  move_pin(model, b, PinMove{}, pins, state);
  CHECK(is_free(12));
  stop_pin(b, pins, state);
  CHECK_FALSE(is_free(12));
  remove_pin(model, b, pins, state);
  CHECK(is_free(12));
  stop_pin(a, pins, state);
  CHECK_FALSE(is_free(12));
  remove_pin(model, a, pins, state);
  CHECK(is_free(3));
  CHECK(pins.held == 0);
}

TEST_CASE("pins together hold a bounded number of particles") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(250, 200, 2, 2));
  ClothState<double> state = initial_state(model);
  Pins pins = make_pins(model);
  for (std::size_t k = 0; k < kMostHeld / 50000; ++k) add_pin(model, {0, 100.0, {}}, pins, state);
  CHECK_THROWS_AS(add_pin(model, {0, 0.0, {}}, pins, state), DefinitionError);
  CHECK(pins.list.size() == kMostHeld / 50000);
  remove_pin(model, pins.list.front().id, pins, state);
  add_pin(model, {0, 0.0, {}}, pins, state);
}
