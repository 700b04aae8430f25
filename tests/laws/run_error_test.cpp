#include "core/world/run_error.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A strip of cloth under gravity, held by one end: level at first it swings down, upright it
/// stretches.
WorldDef strip(bool level) {
  ClothDef cloth = test::flat_cloth(9, 5, 0.2, 0.4);
  if (!level) cloth.v = -Vec3d::UnitY();
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-5;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 0.2;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.solver.kind = SolverKind::verlet;
  return def;
}

double distance(const World<double>& a, const World<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.state().x.size(); ++i)
    sum += (a.state().x[i] - b.state().x[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.state().x.size()));
}

/// Largest differences from a run with 16 times the substeps, those of strain tick by tick.
struct Truth {
  double positions = 0, strain = 0, energy = 0;
  std::vector<double> strains;

  void note(const World<double>& run, const World<double>& exact) {
    positions = std::max(positions, distance(run, exact));
    strain =
        std::max(strain, std::abs(run.report().largest_strain - exact.report().largest_strain));
    strains.push_back(strain);
    energy =
        std::max(energy, std::abs(run.report().energies.total() - exact.report().energies.total()));
  }
};

void is_within_a_factor(double factor, const QuantityError& told, double truth, double until) {
  INFO(told.name << ": told " << told.figure.estimate.error << ", true " << truth << ", order "
                 << told.figure.estimate.order);
  REQUIRE(told.figure.measured);
  CHECK(told.figure.until == Approx(until));
  CHECK(told.figure.estimate.error < factor * truth);
  CHECK(told.figure.estimate.error > truth / factor);
}

/// @param smooth    factor that positions and energy are told to; the largest strain, which may
///                  change place, is told to two
/// @param strained  least part of the run to which noise lets strain be told
void tells_the_error(const WorldDef& def, int ticks, double smooth, double strained = 1) {
  World<double> run(def), exact(def);
  RunError<double> error(def, {}, run);
  exact.refine_substeps(16);
  Truth truth;
  for (int k = 0; k < ticks; ++k) {
    run.step();
    exact.step();
    error.note_tick(run);
    truth.note(run, exact);
  }
  const std::vector<QuantityError> told = error.in_time();
  const double end = run.report().time;
  is_within_a_factor(smooth, told.at(0), truth.positions, end);
  const double until = told.at(1).figure.until;
  CHECK(until >= Approx(strained * end));
  const auto last = static_cast<std::size_t>(std::lround(until / run.tick_seconds()));
  is_within_a_factor(2, told.at(1), truth.strains.at(last - 1), until);
  is_within_a_factor(smooth, told.at(2), truth.energy, end);
}

}  // namespace

TEST_CASE("a swing's error in time is that against 16 times the substeps, to a factor of two") {
  // Its most stretched element changes by chance once it has swung back.
  tells_the_error(strip(true), 75, 2, 0.8);
}

TEST_CASE("a stretching strip's error in time is told to a factor of two") {
  // Later it has sprung back and buckles, so that noise exceeds a third of the error of positions.
  tells_the_error(strip(false), 18, 2);
}

TEST_CASE("the error in time of a strip that comes to rest is told to its end, to 5 %") {
  WorldDef def = strip(false);
  def.environment.damping = 20;
  tells_the_error(def, 40, 1.05);
}

TEST_CASE("a difference that falls with any power of the step is extrapolated to its limit") {
  for (const double order : {0.6, 1.0, 2.0, 4.0}) {
    const double error = 0.03, half = error * std::pow(2, -order), quarter = half * half / error;
    const ErrorEstimate found = extrapolate({error - half, half - quarter, error - quarter, 0});
    CHECK(found.order == Approx(order));
    CHECK(found.error == Approx(error));
  }
}

TEST_CASE("runs that do not approach each other have no order and a lower bound alone") {
  const ErrorEstimate found = extrapolate({0.02, 0.019, 0.03, 0});
  CHECK(found.order == 0);
  CHECK(found.error == 0.03);
  ErrorWatch watch(1e-6);
  watch.note_steps(0.1, {0.02, 0.019, 0.03, 1e-6});
  CHECK_FALSE(watch.figure().measured);
}

TEST_CASE("a figure ends when noise exceeds a third of the error and ten times its start") {
  ErrorWatch watch(1e-6);
  watch.note_steps(1, {0.75e-6, 0.1875e-6, 0.9375e-6, 9e-6});  // below ten times its start
  CHECK_FALSE(watch.figure().chaotic);
  watch.note_steps(2, {0.75e-3, 0.1875e-3, 0.9375e-3, 3.3e-4});  // an error of 1e-3
  CHECK_FALSE(watch.figure().chaotic);
  watch.note_steps(3, {0.6e-3, 0.15e-3, 0.7e-3, 1e-5});
  CHECK(watch.figure().noise == 3.3e-4);  // the largest so far, as the error is
  CHECK(watch.figure().until == 3);
  watch.note_steps(4, {0.6e-3, 0.15e-3, 0.7e-3, 3.4e-4});
  watch.note_steps(5, {5, 1, 6, 0});
  CHECK(watch.figure().chaotic);
  CHECK(watch.figure().chaotic_at == 4);
  CHECK(watch.figure().until == 3);
  CHECK(watch.figure().estimate.error == Approx(1e-3));
}

TEST_CASE(
    "the error in space of positions is their distance from the same places of twice the rows") {
  WorldDef def = strip(false);
  def.environment.damping = 20;
  const WorldDef finer_def = with_twice_the_rows(def);
  World<double> run(def), finer(finer_def);
  RunError<double> error(def, {}, run);
  double truth = 0;
  for (int k = 0; k < 30; ++k) {
    run.step();
    finer.step();
    error.note_tick(run);
    double sum = 0;
    for (std::size_t i = 0; i < run.state().x.size(); ++i) {
      const std::size_t row = i / 5, column = i % 5;
      sum += (run.state().x[i] - finer.state().x[2 * row * 9 + 2 * column]).squaredNorm();
    }
    truth = std::max(truth, std::sqrt(sum / 45));
  }
  const QuantityError positions = error.in_space(run).at(0);
  REQUIRE(positions.figure.measured);
  CHECK(positions.figure.estimate.error == Approx(truth));
}

TEST_CASE("where more rows mean another cloth, why the error in space is not measured is told") {
  WorldDef def = strip(true);
  def.pins = {{Index(0), 0, {}}};
  World<double> run(def);
  const RunError<double> error(def, {}, run);
  CHECK(error.in_space(run).empty());
  CHECK(error.space_forbidden() == "a pin names a particle");
}
