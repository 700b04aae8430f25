#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A strip of `rows` particles down and `columns` across, hanging along -y, with its top row
/// pinned.
WorldDef hanging_strip(int rows, int columns, double width, double length) {
  ClothDef cloth;
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.width = width;
  cloth.height = length;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  WorldDef def = test::empty_world(cloth);
  for (Index i = 0; i < columns; ++i) def.pins.push_back({i, 0});
  return def;
}

}  // namespace

TEST_CASE("a hanging strip stretches by sigma g L^2 / 2k, exactly for any number of rows") {
  // hanging_strip.table: sigma 0.2, L 1, k 50: 0.01962 m; k 1000: 0.000981 m.
  const auto [rows, k, expected] = GENERATE(table<int, double, double>(
      {{6, 50, 0.01962}, {11, 50, 0.01962}, {24, 50, 0.01962}, {11, 1000, 0.000981}}));
  WorldDef def = hanging_strip(rows, 3, 0.2, 1);
  def.cloths[0].fabric.stretch_warp = def.cloths[0].fabric.stretch_weft = k;
  def.cloths[0].fabric.shear = 0;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.kind = GENERATE(SolverKind::verlet, SolverKind::implicit);
  World<double> world(def);
  const double rest = test::settle(world, 30, 8);
  REQUIRE(rest < 1e-9);
  const Index tip = static_cast<Index>(world.state().x.size()) - 2;
  const double stretch = -1 - world.state().x[static_cast<std::size_t>(tip)][1];
  CHECK(stretch == Approx(expected).epsilon(1e-6));
}

TEST_CASE("pulled along the warp the modulus is Y_w - G^2 / Y_f away from the clamps, to 0.5 %") {
  const auto [columns, rows] = GENERATE(table<int, int>({{25, 13}, {25, 7}}));  // 1:1 and 1:2 cells
  ClothDef cloth = test::flat_cloth(rows, columns, 2.4, 1.2);
  cloth.fabric.stretch_warp = 500;
  cloth.fabric.stretch_weft = 300;
  cloth.fabric.shear = 60;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  World<double> world(test::empty_world(cloth));
  for (Index r = 0; r < rows; ++r) {
    world.pin({r * columns, 0});
    world.pin({r * columns + columns - 1, 0});
  }
  constexpr double kStrain = 1e-4;  // small, so that the springs' own geometry does not matter
  for (std::size_t i = 0; i < world.state().x.size(); ++i) world.state().x[i][0] *= 1 + kStrain;
  world.accept_state();
  REQUIRE(test::settle(world, 20, 6) < 1e-10);
  // Force through the cut between the two middle columns, and the strain there.
  const auto& model = world.model();
  const auto& x = world.state().x;
  const int cut = columns / 2;
  double force = 0;
  for (const auto& s : model.springs) {
    const int ci = s.i % columns, cj = s.j % columns;
    if (std::min(ci, cj) != cut || ci == cj) continue;
    const Vec3d d = x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)];
    force += s.stiffness * (d.norm() - s.rest_length) * std::abs(d[0]) / d.norm();
  }
  const auto at = [&, n = columns](int r, int c) { return x[static_cast<std::size_t>(r * n + c)]; };
  const int middle = rows / 2;
  const double strain = (at(middle, cut + 1) - at(middle, cut)).norm() / model.parts[0].cell_u - 1;
  CHECK(force / 1.2 / strain == Approx(500 - 60.0 * 60.0 / 300).epsilon(5e-3));
}

TEST_CASE("a pinned row carries the whole weight, before and after a hand has pulled") {
  WorldDef def = hanging_strip(8, 5, 0.4, 0.7);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  World<double> world(def);
  REQUIRE(test::settle(world, 20, 5) < 1e-9);
  const auto pull_of_springs = [&] {
    double pull = 0;
    for (const auto& s : world.model().springs) {
      if (s.i >= 5 || s.j < 5) continue;  // springs between the pinned row and the next
      const Vec3d d = world.state().x[static_cast<std::size_t>(s.j)] -
                      world.state().x[static_cast<std::size_t>(s.i)];
      pull += -s.stiffness * (1 - s.rest_length / d.norm()) * d[1];
    }
    return pull;
  };
  double below = 0;
  for (std::size_t i = 5; i < world.model().mass.size(); ++i) below += world.model().mass[i];
  CHECK(pull_of_springs() == Approx(below * 9.81).epsilon(1e-8));
  const GrabId hand = world.grab({20, {0.2, 0.3, 0.5}, 0.1, 100, 50, Vec3d(0.5, -1.5, 0.3)});
  test::advance(world, 1);
  REQUIRE(world.release(hand));
  REQUIRE(test::settle(world, 10, 16) < 1e-8);
  CHECK(pull_of_springs() == Approx(below * 9.81).epsilon(1e-7));
}

TEST_CASE("a hand in equilibrium pulls with stiffness times the distance to its target") {
  WorldDef def = hanging_strip(8, 5, 0.4, 0.7);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  World<double> world(def);
  const std::size_t corner = world.state().x.size() - 1;
  const Vec3d target = world.state().x[corner] + Vec3d(0.02, -0.05, 0.01);
  const auto hit = world.model().triangles.size() - 1;
  world.grab({static_cast<Index>(hit), {1.0 / 3, 1.0 / 3, 1.0 / 3}, 0, 80, 50, target});
  REQUIRE(test::settle(world, 10, 16) < 1e-8);
  const Grab<double>& grab = world.grabs().list[0];
  const Vec3d expected = (target - held_point(grab, world.state().x)) * 80.0;
  CHECK((grab.force - expected).norm() < 1e-7);
  CHECK(grab.force.norm() > 0.1);
}

TEST_CASE("a hand never pulls harder than its limit") {
  WorldDef def = hanging_strip(8, 5, 0.4, 0.7);
  World<double> world(def);
  world.grab({10, {0.5, 0.25, 0.25}, 0.1, 1000, 3, Vec3d(40, 30, -20)});
  for (int tick = 0; tick < 120; ++tick) {
    world.step();
    CHECK(world.grabs().list[0].force.norm() <= 3 * (1 + 1e-12));
  }
}
