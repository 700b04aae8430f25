#include "core/solver/grid_relaxation.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/attachments/clamp_line.h"
#include "core/forces/force_pass.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/targets.h"
#include "tests/support/worlds.h"

// The row-wise form of XPBD against the one spring by spring.

using namespace weft;
using namespace weft::test;

namespace {

ClothDef soft_cloth(int rows, int columns) {
  ClothDef cloth = flat_cloth(rows, columns, 0.1 * (columns - 1), 0.12 * (rows - 1));
  cloth.fabric.stretch_warp = 220;
  cloth.fabric.stretch_weft = 300;
  cloth.fabric.shear = 20;
  cloth.fabric.bending_warp = 2e-4;
  cloth.fabric.bending_weft = 5e-4;
  return cloth;
}

WorldDef xpbd_world(const ClothDef& cloth, int substeps, int sweeps) {
  WorldDef def = empty_world(cloth);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.compliance = 1;
  def.relaxation.damping = 0;
  def.relaxation.substeps = substeps;
  def.relaxation.sweeps = sweeps;
  def.environment.gravity = Vec3d(0.3, -9.81, 0.2);
  return def;
}

/// The farthest that two worlds of the same cloth are apart [m].
template <class A, class B>
double apart(const World<A>& a, const World<B>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.state().x.size(); ++i)
    most = std::max(
        most,
        (a.state().x[i].template cast<double>() - b.state().x[i].template cast<double>()).norm());
  return most;
}

/// A world whose springs have nothing regular, so that they are swept one by one: one skip spring
/// kind of no force is enough.
WorldDef spring_by_spring(WorldDef def) {
  def.cloths[0].skip_stiffness = 1e-9;
  return def;
}

}  // namespace

TEST_CASE("a prediction bends each particle by the force of the stencils, to 1e-12") {
  const auto [rows, columns] = GENERATE(table<int, int>(
      {{2, 2}, {2, 5}, {3, 3}, {3, 4}, {4, 2}, {9, 12}, {12, 9}, {17, 33}, {5, 64}, {6, 35}}));
  CAPTURE(rows, columns);
  ClothModel<double> model = build_cloth<double>(soft_cloth(rows, columns));
  if (GENERATE(false, true)) {  // weights at clamps differ
    if (std::min(rows, columns) < 4) return;
    set_clamps(
        {{{0, Side::top, 1, 8}, {0, Side::bottom, rows - 2, 0.75}, {0, Side::left, 2, 3.5}}, {}},
        model);
  }
  SeededRandom random(3);
  const Vec3Array<double> x = shaken(model, 0.05, random);
  Vec3Array<double> force(x.size(), Vec3d::Zero()), v(x.size(), Vec3d(1, 2, 3));
  add_quadratic_bending_forces(model.parts[0], x, force);
  GridRelaxation<double> grid;
  grid.prepare(model.parts[0]);
  REQUIRE(grid.fits());
  const ClothState<double> state = initial_state(model);
  const double dt = 0.01;
  grid.set_masses(state.inverse_mass, 1 / (dt * dt));
  grid.load(x, v, dt);
  Prediction<double> step{0.75, dt * dt, Vec3d(0, -9.81, 0), true};
  const Vec3Array<double> extra(x.size(), Vec3d(0, 0, 1e-3));
  grid.load_force(extra);
  predict_grid(grid.view(), step);
  Vec3Array<double> displacement(x.size());
  grid.store_displacements(displacement);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3d expected =
        v[i] * dt * 0.75 +
        ((force[i] + extra[i]) * state.inverse_mass[i] + Vec3d(0, -9.81, 0)) * dt * dt;
    CHECK((displacement[i] - expected).norm() < 1e-12);
  }
}

namespace {

/// Moves the ends of one spring at x + displacement as XPBD says (Macklin, Mueller, Chentanez
/// 2016).
void relax_literally(const Spring<double>& spring, double softness, const Vec3Array<double>& x,
                     const std::vector<double>& w, double& lambda,
                     Vec3Array<double>& displacement) {
  const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
  if (w[i] + w[j] == 0) return;
  const Vec3d between = x[j] + displacement[j] - x[i] - displacement[i];
  const double alpha = softness / spring.stiffness, c = between.norm() - spring.rest_length;
  const double change = -(c + alpha * lambda) / (w[i] + w[j] + alpha);
  lambda += change;
  displacement[i] -= between.normalized() * w[i] * change;
  displacement[j] += between.normalized() * w[j] * change;
}

/// Springs of a grid in the order of a sweep down: along each row, even cells first, and then from
/// it to the next one straight, falling and rising. Up is not the reverse, for along the row comes
/// last.
std::vector<std::size_t> order_of_sweep(const ClothModel<double>& model, bool down) {
  const Index columns = model.parts[0].columns, rows = model.parts[0].rows;
  std::vector<std::size_t> order;
  const auto take = [&](Index i, Index j) {
    for (std::size_t n = 0; n < model.springs.size(); ++n) {
      const Spring<double>& s = model.springs[n];
      if ((s.i == i && s.j == j) || (s.i == j && s.j == i)) order.push_back(n);
    }
  };
  const auto along = [&](Index r) {
    for (const Index parity : {0, 1}) {
      for (Index c = parity; c + 1 < columns; c += 2) take(r * columns + c, r * columns + c + 1);
    }
  };
  const auto between = [&](Index r) {
    const Index here = r * columns, below = here + columns;
    for (Index c = 0; c < columns; ++c) take(here + c, below + c);
    for (Index c = 0; c + 1 < columns; ++c) take(here + c, below + c + 1);
    for (Index c = 0; c + 1 < columns; ++c) take(here + c + 1, below + c);
  };
  for (Index n = 0; n < rows; ++n) {
    const Index r = down ? n : rows - 1 - n;
    if (down) along(r);
    if (r + 1 < rows) between(r);
    if (!down) along(r);
  }
  return order;
}

}  // namespace

TEST_CASE("sweeps by rows are XPBD spring by spring in their order, to 1e-12 m") {
  const auto [rows, columns] =
      GENERATE(table<int, int>({{2, 2}, {2, 3}, {3, 2}, {6, 9}, {9, 6}, {7, 34}, {4, 65}}));
  const int sweeps = GENERATE(1, 3);
  CAPTURE(rows, columns, sweeps);
  const ClothModel<double> model = build_cloth<double>(soft_cloth(rows, columns));
  SeededRandom random(7);
  const Vec3Array<double> x = shaken(model, 0.03, random);
  ClothState<double> state = initial_state(model);
  state.inverse_mass.front() = state.inverse_mass.back() = 0;
  state.inverse_mass[1] *= 0.3;
  Vec3Array<double> v = shaken(model, 0.1, random);
  v.front().setZero();
  v.back().setZero();
  const double dt = 0.004, softness = 1 / (dt * dt);
  GridRelaxation<double> grid;
  grid.prepare(model.parts[0]);
  grid.set_masses(state.inverse_mass, softness);
  grid.load(x, v, dt);
  Vec3Array<double> displacement(x.size()), expected(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) expected[i] = v[i] * dt;
  std::vector<double> lambda(model.springs.size(), 0);
  for (int s = 0; s < sweeps; ++s) {
    sweep_grid(grid.view(), s % 2 == 0, s == 0, s + 1 == sweeps);
    const std::vector<std::size_t> order = order_of_sweep(model, s % 2 == 0);
    REQUIRE(order.size() == model.springs.size());
    for (const std::size_t n : order)
      relax_literally(model.springs[n], softness, x, state.inverse_mass, lambda[n], expected);
  }
  grid.store_displacements(displacement);
  for (std::size_t i = 0; i < x.size(); ++i)
    REQUIRE((displacement[i] - expected[i]).norm() < 1e-12);
}

TEST_CASE("sweeps by rows keep momentum to 1e-12 and leave pinned particles where they are") {
  WorldDef def = xpbd_world(soft_cloth(9, 12), 7, 3);
  def.environment.gravity.setZero();
  World<double> world(def);
  SeededRandom random(4);
  world.state().x = shaken(world.model(), 0.02, random);
  world.accept_state();
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < world.state().v.size(); ++i)
      sum += world.model().mass[i] * world.state().v[i];
    return sum;
  };
  for (int tick = 0; tick < 5; ++tick) world.step();
  CHECK(momentum().norm() < 1e-12);
  world.pin({40, 0, {}});
  const Vec3d there = world.state().x[40];
  for (int tick = 0; tick < 5; ++tick) world.step();
  CHECK(world.state().x[40] == there);
}

TEST_CASE("hands, air and contact find the same way as a tick that stays in its rows") {
  // An object far away and a hand of no stiffness do nothing but take the tick apart into substeps
  // that go back to the particles each time.
  WorldDef def = xpbd_world(soft_cloth(8, 11), 6, 2);
  def.pins = {{0, 0, {}}, {10, 0, {}}};
  WorldDef with_object = def;
  with_object.colliders = {{"far", SphereDef{Vec3d(50, 0, 0), 1}}};
  World<double> rows(def), particles(with_object);
  for (int tick = 0; tick < 30; ++tick) {
    rows.step();
    particles.step();
  }
  CHECK(apart(rows, particles) < 1e-10);
}

TEST_CASE("single precision keeps up with double at 1000 substeps, to 1e-4 of its displacement") {
  // With positions alone as the variable, velocities were quantised to the last bit of a position
  // over a substep, 37 % wrong here.
  ClothDef cloth = flat_cloth(16, 16);
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 216;
  cloth.fabric.shear = 20;
  WorldDef def = xpbd_world(cloth, GENERATE(1000, 100), 1);
  if (GENERATE(false, true)) def = spring_by_spring(def);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 5;
  for (Index i = 0; i < 16; ++i) def.pins.push_back({i, 0, {}});
  World<float> single(def);
  World<double> twice(def);
  for (int tick = 0; tick < 20; ++tick) {
    single.step();
    twice.step();
  }
  double displacement = 0;
  for (std::size_t i = 0; i < twice.state().x.size(); ++i)
    displacement =
        std::max(displacement, (twice.state().x[i] - twice.model().rest_positions[i]).norm());
  CHECK(displacement > 0.1);
  CHECK(apart(single, twice) < 1e-4 * displacement);
}

TEMPLATE_TEST_CASE("every instruction set relaxes a grid to the same bits", "", float, double) {
  const auto [rows, columns] =
      GENERATE(table<int, int>({{2, 2}, {2, 5}, {3, 17}, {9, 12}, {20, 33}, {6, 67}}));
  const int sweeps = GENERATE(1, 3);
  CAPTURE(rows, columns, sweeps);
  WorldDef def = xpbd_world(soft_cloth(rows, columns), 5, sweeps);
  def.environment.damping = 1;
  def.pins = {{0, 0, {}}};
  const auto hash = [&] {
    World<TestType> world(def);
    GridRelaxation<TestType> grid;
    grid.prepare(world.model().parts[0]);
    REQUIRE(grid.fits());
    Random random(9);
    world.state().x = shaken(world.model(), 0.02, random);
    world.accept_state();
    for (int tick = 0; tick < 3; ++tick) world.step();
    return world.hash();
  };
  const std::uint64_t best = hash();
  for_each_target([&] { CHECK(hash() == best); });
}
