#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// Strips that move and bend in one plane alone, against what is known of chains and of elastic
// rods.

using namespace weft;

namespace {

constexpr double kPi = 3.14159265358979323846, kGravity = 9.81;

/// A strip along u of `segments` cells and one metre with `lines` lines of particles beside each
/// other, at -z from the x axis.
ClothDef strip(int segments, int lines, double rigidity, double stretch) {
  ClothDef cloth;
  cloth.columns = segments + 1;
  cloth.rows = lines;
  cloth.width = 1;
  cloth.height = (lines - 1.0) / segments;
  cloth.v = -Vec3d::UnitZ();
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = stretch;
  cloth.fabric.shear = 0;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = rigidity;
  return cloth;
}

/// Lays the strip along a curve in the plane z = const, each segment at its angle from the x axis.
void lay(World<double>& world, const std::function<double(int)>& angle) {
  const ClothPart<double>& part = world.model().parts[0];
  Vec3d at = Vec3d::Zero();
  for (int c = 0; c < part.columns; ++c) {
    for (int r = 0; r < part.rows; ++r) {
      Vec3d& x = world.state().x[static_cast<std::size_t>(r * part.columns + c)];
      x = Vec3d(at[0], at[1], x[2]);
    }
    at += part.cell_u * Vec3d(std::cos(angle(c)), std::sin(angle(c)), 0);
  }
  world.accept_state();
}

/// Turning angle from segment to segment of a polygonal arc of n equal segments whose ends are
/// `chord` of its length apart.
double turning_angle(int n, double chord) {
  double low = 1e-6, high = 2 * kPi / n;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    const double reach = std::sin(n * middle / 2) / (n * std::sin(middle / 2));
    (reach > chord ? low : high) = middle;
  }
  return low;
}

void lay_arc(World<double>& world, double chord, double side) {
  const int n = world.model().parts[0].columns - 1;
  const double turn = turning_angle(n, chord);
  lay(world, [&](int k) { return side * turn * (0.5 * (n - 1) - k); });
}

void pin_ends(World<double>& world, int columns_each) {
  const ClothPart<double>& part = world.model().parts[0];
  for (int r = 0; r < part.rows; ++r) {
    for (int k = 0; k < columns_each; ++k) {
      world.pin({r * part.columns + k, 0});
      world.pin({(r + 1) * part.columns - 1 - k, 0});
    }
  }
}

/// XPBD with as few sweeps as it takes.
void use_xpbd(WorldDef& def, int substeps) {
  def.cloths[0].fabric.damping_ratio = 0;
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.compliance = 1;
  def.relaxation.substeps = substeps;
  def.relaxation.sweeps = 1;
  def.relaxation.damping = 0;
}

/// J_0 by its power series.
double bessel_j0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; k < 30; ++k) {
    term *= -x * x / (4.0 * k * k);
    sum += term;
  }
  return sum;
}

}  // namespace

TEST_CASE("a row hung by its ends is the discrete catenary, to 1e-4 of its length") {
  // catenary.table: distance of the ends, segments and sag, each over the length.
  const auto [distance, segments, sag] =
      GENERATE(table<double, int, double>({{0.5, 10, 0.40218549914561463},
                                           {0.5, 20, 0.3991365544578199},
                                           {0.9, 10, 0.1916602718605384},
                                           {0.9, 20, 0.19094553844279769}}));
  WorldDef def = test::empty_world(strip(segments, 2, 0, 5e5));
  def.solver.kind = GENERATE(SolverKind::verlet, SolverKind::implicit);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  World<double> world(def);
  lay_arc(world, distance, -1);
  pin_ends(world, 1);
  REQUIRE(test::settle(world, 10, 12) < 1e-5);
  const Vec3d end = world.state().x[0],
              middle = world.state().x[static_cast<std::size_t>(segments / 2)];
  CHECK(end[1] - middle[1] == Approx(sag).margin(1e-4));
  CHECK(world.report().largest_strain < 1e-4);
}

TEST_CASE("a hanging sheet swings in its first mode with T = 5.2293 sqrt(L/g), to 0.3 %") {
  const SolverKind solver =
      GENERATE(SolverKind::verlet, SolverKind::relaxation, SolverKind::implicit);
  CAPTURE(solver);
  // pendulum.hanging_sheet_small_modes, 20 segments; continuous 5.22548.
  constexpr int kSegments = 20;
  WorldDef def = test::empty_world(strip(kSegments, 3, 0, 4000));
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  def.cloths[0].u = -Vec3d::UnitY();
  def.tick_rate = 1000;
  def.solver.kind = solver;
  if (solver == SolverKind::relaxation) use_xpbd(def, 20);
  World<double> world(def);
  for (int r = 0; r < 3; ++r) world.pin({r * (kSegments + 1), 0});
  REQUIRE(test::settle(world, 20, 3) < 1e-6);
  // The mode's shape is J_0(2.4048 sqrt(height over the hem)).
  for (int r = 0; r < 3; ++r) {
    for (int c = 1; c <= kSegments; ++c) {
      const double height = 1 - static_cast<double>(c) / kSegments;
      world.state().x[static_cast<std::size_t>(r * (kSegments + 1) + c)][0] +=
          0.004 * bessel_j0(2.404825557695773 * std::sqrt(height));
    }
  }
  EnvironmentDef free = world.environment();
  free.damping = 0;
  world.set_environment(free);
  world.accept_state();
  const double origin = world.state().x[0][0], start = world.report().time;
  std::vector<double> crossings;
  double last = 1;
  for (int tick = 0; tick < 9000; ++tick) {
    world.step();
    const double now = world.state().x[kSegments][0] - origin;
    if (last * now < 0)
      crossings.push_back(world.report().time - start - 1e-3 * now / (now - last));
    last = now;
  }
  REQUIRE(crossings.size() >= 9);
  const double period = (crossings[8] - crossings[0]) / 4;
  CHECK(period / std::sqrt(1 / kGravity) == Approx(5.229349692200162).epsilon(0.003));
}

TEST_CASE("a strip pushed together at its ends buckles to the elastica's height, to 0.5 %") {
  // buckled_strip_hinged: shortening and deflection of the middle, over the length.
  const auto [shortening, deflection] =
      GENERATE(table<double, double>({{0.05, 0.14011060601024403}, {0.2, 0.2663185880056361}}));
  const BendingModel bending = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  const SolverKind solver = GENERATE(SolverKind::verlet, SolverKind::implicit);
  constexpr int kSegments = 40;
  ClothDef cloth = strip(kSegments, 3, 0.02, 2e4);
  cloth.bending_model = bending;
  cloth.fabric.shear = 1000;  // without it the cells fold up sideways under the thrust
  WorldDef def = test::empty_world(cloth);
  def.solver.kind = solver;
  World<double> world(def);
  lay_arc(world, 1 - shortening, 1);
  pin_ends(world, 1);
  REQUIRE(test::settle(world, 6, 12) < 1e-4);
  const Vec3d end = world.state().x[0], middle = world.state().x[kSegments / 2];
  CHECK(middle[1] - end[1] == Approx(deflection).epsilon(0.005));
}

TEST_CASE("a clamped strip pushed together buckles as high as a hinged one, to 0.5 %") {
  constexpr int kSegments = 41;  // clamped half a cell from either end
  ClothDef cloth = strip(kSegments, 3, 0.02, 2e4);
  cloth.fabric.shear = 1000;
  World<double> world(test::empty_world(cloth));
  constexpr double kShortening = 0.2, kCell = 1.0 / kSegments, kLength = 1 - kCell;
  // A wave of cosine slope, with the first and the last segment level.
  const auto reach = [&](double height) {
    double sum = 0;
    for (int k = 0; k < kSegments; ++k)
      sum += std::cos(height * std::sin(2 * kPi * k / (kSegments - 1.0)));
    return sum * kCell;
  };
  double low = 0, high = 2;
  for (int k = 0; k < 60; ++k)
    (reach(0.5 * (low + high)) > kCell + kLength * (1 - kShortening) ? low : high) =
        0.5 * (low + high);
  lay(world, [&](int k) { return low * std::sin(2 * kPi * k / (kSegments - 1.0)); });
  pin_ends(world, 2);
  REQUIRE(test::settle(world, 12, 8) < 1e-4);
  const Vec3d end = world.state().x[0];
  const double middle =
      0.5 * (world.state().x[kSegments / 2][1] + world.state().x[kSegments / 2 + 1][1]);
  CHECK((middle - end[1]) / kLength == Approx(0.2663185880056361).epsilon(0.005));
}

TEST_CASE("a cloth spun at one turn a second keeps its spin to 1e-11 over ten turns") {
  // backward_euler_spin_loss: projections lose a third of it in the first second.
  World<double> world(test::empty_world(test::flat_cloth(9, 9)));
  const Vec3d centre = test::centre_of_mass(world), spin(0, 2 * kPi, 0);
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < world.state().x.size(); ++i)
      sum += world.model().mass[i] * (world.state().x[i] - centre).cross(world.state().v[i]);
    return sum;
  };
  for (std::size_t i = 0; i < world.state().x.size(); ++i)
    world.state().v[i] = spin.cross(world.state().x[i] - centre);
  world.accept_state();
  const Vec3d before = momentum();
  const double energy = world.report().energies.kinetic;
  test::advance(world, 10);
  CHECK((momentum() - before).norm() < 1e-11 * before.norm());
  CHECK(before.norm() == Approx(0.2 / 6 * 2 * kPi).epsilon(0.05));
  CHECK(world.report().energies.kinetic + world.report().energies.stretch > 0.9 * energy);
}
