#include <functional>

#include <catch2/catch.hpp>

#include "core/forces/air/air_force.h"
#include "core/forces/energy_pass.h"
#include "core/forces/force_pass.h"
#include "core/forces/grid_pass.h"
#include "core/forces/hinge.h"
#include "core/forces/spring.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

using namespace weft;
using test::SeededRandom;

namespace {

using ForceFunction = std::function<void(const Vec3Array<double>&, Vec3Array<double>&)>;
using EnergyFunction = std::function<double(const Vec3Array<double>&)>;

/// Largest difference between the force and minus the central difference of the energy, relative to
/// the largest force.
double gradient_error(const Vec3Array<double>& x, const ForceFunction& force,
                      const EnergyFunction& energy) {
  Vec3Array<double> f(x.size(), Vec3d::Zero());
  force(x, f);
  double largest = 0, error = 0;
  for (const Vec3d& value : f) largest = std::max(largest, value.norm());
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3Array<double> moved = x;
      moved[i][axis] += kStep;
      const double high = energy(moved);
      moved[i][axis] -= 2 * kStep;
      const double low = energy(moved);
      error = std::max(error, std::abs(f[i][axis] + (high - low) / (2 * kStep)));
    }
  }
  REQUIRE(largest > 0);
  return error / largest;
}

double moment_sum(const Vec3Array<double>& x, const Vec3Array<double>& f) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i].cross(f[i]);
  return sum.norm();
}

double force_sum(const Vec3Array<double>& f) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& value : f) sum += value;
  return sum.norm();
}

ClothModel<double> hinged_cloth(double rest_angle) {
  ClothDef def = test::flat_cloth(4, 5, 1, 0.5);
  def.bending_model = BendingModel::hinges;
  def.rest_angle = rest_angle;
  def.fabric.bending_warp = 2e-3;
  def.fabric.bending_weft = 1e-3;
  return build_cloth<double>(def);
}

}  // namespace

TEST_CASE("the force of the springs is minus the gradient of their energy, to 1e-6") {
  SeededRandom random(1);
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(4, 5, 1, 0.6));
  const Vec3Array<double> x = test::shaken(model, 0.05, random), rest(x.size(), Vec3d::Zero());
  const auto force = [&](const auto& at, auto& f) { add_spring_forces(model, at, rest, f); };
  const auto energy = [&](const auto& at) { return elastic_energy(model, at).stretch; };
  CHECK(gradient_error(x, force, energy) < 1e-6);
}

TEST_CASE("a spring's dashpot pulls with its coefficient times the rate of the spring's length") {
  SeededRandom random(1);
  Spring<double> dashpot;
  dashpot.damping = 0.7;
  for (int run = 0; run < 20; ++run) {
    constexpr double kSeconds = 1e-6;
    const Vec3d d = random.vector(0.05), dv = random.vector(3);
    const double rate = ((d + dv * kSeconds).norm() - (d - dv * kSeconds).norm()) / (2 * kSeconds);
    const Vec3d force = spring_force(dashpot, d, dv);
    CHECK((force - 0.7 * rate * d.normalized()).norm() < 1e-5);
  }
}

TEST_CASE("the force of the hinges is minus the gradient of their energy, to 1e-6") {
  for (const double rest_angle : {0.0, 0.26, -1.0}) {
    SeededRandom random(2);
    const ClothModel<double> model = hinged_cloth(rest_angle);
    const Vec3Array<double> x = test::shaken(model, 0.05, random), rest(x.size(), Vec3d::Zero());
    const auto force = [&](const auto& at, auto& f) { add_hinge_forces(model, at, rest, f); };
    const auto energy = [&](const auto& at) { return elastic_energy(model, at).bending; };
    CHECK(gradient_error(x, force, energy) < 1e-6);
  }
}

TEST_CASE("the force of quadratic bending is minus the gradient of its energy, to 1e-6") {
  SeededRandom random(3);
  ClothDef def = test::flat_cloth(4, 5, 1, 0.6);
  def.fabric.bending_warp = 3e-4;
  const ClothModel<double> model = build_cloth<double>(def);
  REQUIRE(quadratic_stencil_count(model.parts[0]) > 0);
  const Vec3Array<double> x = test::shaken(model, 0.05, random);
  const auto force = [&](const auto& at, auto& f) { add_quadratic_bending_forces(model, at, f); };
  const auto energy = [&](const auto& at) { return elastic_energy(model, at).bending; };
  CHECK(gradient_error(x, force, energy) < 1e-6);
}

TEST_CASE("elastic and damping forces add up to no force and no moment, to 1e-12") {
  SeededRandom random(4);
  ClothDef def = test::flat_cloth(5, 4, 1, 0.6);
  def.fabric.bending_warp = 1e-2;
  def.fabric.bending_damping = 0.05;
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  const ClothModel<double> model = build_cloth<double>(def);
  REQUIRE(model.hinges.empty() == (def.bending_model == BendingModel::quadratic));
  const Vec3Array<double> x = test::shaken(model, 0.1, random);
  const Vec3Array<double> v = test::random_velocities(model, 3, random);
  Vec3Array<double> f(x.size(), Vec3d::Zero());
  add_spring_forces(model, x, v, f);
  add_hinge_forces(model, x, v, f);
  add_quadratic_bending_forces(model, x, f);
  double scale = 0;
  for (const Vec3d& value : f) scale += value.norm();
  CHECK(force_sum(f) < 1e-12 * scale);
  CHECK(moment_sum(x, f) < 1e-12 * scale);
}

TEST_CASE("a cloth moved and turning as a rigid body feels no force, to 1e-9 of a unit strain") {
  ClothDef def = test::flat_cloth(5, 6, 1, 0.6);
  def.fabric.bending_damping = GENERATE(0.0, 0.1);
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  def.fabric.bending_warp = def.fabric.bending_weft = 1e-2;
  const ClothModel<double> model = build_cloth<double>(def);
  const Eigen::AngleAxisd turn(1.1, Vec3d(1, 2, -0.5).normalized());
  const Vec3d spin(0.5, -2, 3), drift(1, 2, 3);
  Vec3Array<double> x = model.rest_positions, v(x.size()), f(x.size(), Vec3d::Zero());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = turn * x[i] + Vec3d(3, -1, 2);
    v[i] = drift + spin.cross(x[i]);
  }
  add_spring_forces(model, x, v, f);
  add_hinge_forces(model, x, v, f);
  add_quadratic_bending_forces(model, x, f);
  for (const Vec3d& value : f) CHECK(value.norm() < 1e-9);
}

TEST_CASE("damping takes energy at every velocity") {
  SeededRandom random(5);
  ClothDef def = test::flat_cloth(5, 5);
  def.fabric.bending_damping = 0.1;
  def.bending_model = BendingModel::hinges;
  ClothModel<double> model = build_cloth<double>(def);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3Array<double> x = test::shaken(model, 0.1, random);
    const Vec3Array<double> v = test::random_velocities(model, 5, random);
    const Vec3Array<double> still(x.size(), Vec3d::Zero());
    Vec3Array<double> with(x.size(), Vec3d::Zero()), without = with;
    add_spring_forces(model, x, v, with);
    add_hinge_forces(model, x, v, with);
    add_spring_forces(model, x, still, without);
    add_hinge_forces(model, x, still, without);
    double power = 0;
    for (std::size_t i = 0; i < x.size(); ++i) power += (with[i] - without[i]).dot(v[i]);
    CHECK(power < 0);
  }
}

TEST_CASE("the force of the air on a triangle is even in its normal and pushes downwind") {
  SeededRandom random(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3d n = random.vector(0.1), u = random.vector(20);
    const Vec3d f = air_force<double>(n, u, 0.784, 0.01);
    CHECK((f - air_force<double>(-n, u, 0.784, 0.01)).norm() < 1e-12);
    CHECK(f.dot(u) > 0);
  }
  CHECK(air_force<double>(Vec3d::Zero(), Vec3d(1, 2, 3), 0.784, 0.01).norm() == 0);
}

TEST_CASE("a plate across the wind feels 1/2 rho C A u^2, one along it the skin friction alone") {
  // A = 0.5 m^2, u = 4 m/s, rho C / 2 = 0.784: 6.272 N; skin 0.01 * 0.5 * 4 = 0.02 N.
  CHECK(air_force<double>(Vec3d(0, 1, 0), Vec3d(0, 4, 0), 0.784, 0.01)[1] == Approx(6.272));
  CHECK(air_force<double>(Vec3d(0, 1, 0), Vec3d(4, 0, 0), 0.784, 0.01)[0] == Approx(0.02));
}

TEMPLATE_TEST_CASE("forces row by row equal those element by element", "", float, double) {
  using Real = TestType;
  const double tolerance = sizeof(Real) == 4 ? 2e-5 : 1e-12;
  const auto [rows, columns] = GENERATE(
      table<int, int>({{2, 2}, {2, 9}, {9, 2}, {3, 3}, {5, 8}, {17, 16}, {7, 33}, {30, 20}}));
  SeededRandom random(7);
  ClothDef def = test::flat_cloth(rows, columns, 1, 0.8);
  def.outline = GENERATE(Outline::rectangle, Outline::ellipse);
  def.fabric.stretch_warp = def.fabric.stretch_weft = 5000;
  def.fabric.shear = 0.5;
  def.fabric.bending_warp = 2e-3;
  def.fabric.bending_weft = 1e-3;
  const ClothModel<Real> model = build_cloth<Real>(def);
  const Vec3Array<Real> x = test::shaken(model, 0.02, random);
  const Vec3Array<Real> v = test::random_velocities(model, 3, random);
  const Vec3Array<Real> wind = test::random_velocities(model, 5, random);
  const Vec3<Real> zero = Vec3<Real>::Zero();
  Vec3Array<Real> elements(x.size(), zero), row_wise(x.size(), zero), air_elements(x.size(), zero),
      air_row_wise(x.size(), zero);
  add_spring_forces(model, x, v, elements);
  add_quadratic_bending_forces(model, x, elements);
  add_air_forces(model, wind, 1.225, x, v, air_elements);
  GridPass<Real> grid;
  grid.prepare(model.parts[0]);
  REQUIRE(grid.fits());
  grid.allocate_external(true);
  grid.load(x, v);
  grid.load_wind(wind);
  for (int repeat = 0; repeat < 2; ++repeat) {  // nothing may be left over from the first time
    grid.compute_internal_forces(row_wise);
    grid.compute_air_forces(1.225);
    grid.store_external(air_row_wise);
    Real scale = 0, air_scale = 0, error = 0, air_error = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      scale = std::max(scale, elements[i].norm());
      air_scale = std::max(air_scale, air_elements[i].norm());
      error = std::max(error, (elements[i] - row_wise[i]).norm());
      air_error = std::max(air_error, (air_elements[i] - air_row_wise[i]).norm());
    }
    CHECK(error <= tolerance * scale);
    CHECK(air_error <= tolerance * air_scale);
  }
  const ElasticEnergy by_elements = elastic_energy(model, x), by_rows = grid.elastic_energy();
  CHECK(by_rows.stretch == Approx(by_elements.stretch).epsilon(tolerance));
  CHECK(by_rows.bending == Approx(by_elements.bending).epsilon(tolerance));
  CHECK(by_rows.largest_strain == Approx(by_elements.largest_strain).epsilon(tolerance));
}

TEST_CASE("an energy pass tells what springs and stencils have, of rows and of hinges alike") {
  ClothDef def = test::flat_cloth(7, 21, 2, 0.6);
  def.fabric.bending_warp = 2e-3;
  def.fabric.bending_weft = 1e-3;
  def.bending_model = GENERATE(BendingModel::quadratic, BendingModel::hinges);
  const ClothModel<double> model = build_cloth<double>(def);
  EnergyPass<double> pass;
  pass.prepare(model);
  SeededRandom random(3);
  Vec3Array<double> x = model.rest_positions;
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (Vec3d& at : x)
      at += Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) / 100;
    const ElasticEnergy wanted = elastic_energy(model, x), told = pass.elastic_energy(model, x);
    REQUIRE(wanted.bending > 0);
    CHECK(told.stretch == Approx(wanted.stretch).epsilon(1e-12));
    CHECK(told.bending == Approx(wanted.bending).epsilon(1e-12));
    CHECK(told.largest_strain == Approx(wanted.largest_strain).epsilon(1e-12));
  }
}
