#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/run_error.h"
#include "core/world/world.h"

// The error that a run of a built-in scene tells of itself, with wind, contact and grippers.

using namespace weft;

namespace {

/// Largest differences of positions (rms), strain and energy so far.
using Differences = std::array<double, 3>;

void note(const World<double>& run, const World<double>& exact, Differences& largest) {
  double sum = 0;
  for (std::size_t i = 0; i < run.state().x.size(); ++i)
    sum += (run.state().x[i] - exact.state().x[i]).squaredNorm();
  const TickReport &a = run.report(), &b = exact.report();
  const Differences now = {std::sqrt(sum / static_cast<double>(run.state().x.size())),
                           std::abs(a.largest_strain - b.largest_strain),
                           std::abs(a.energies.total() - b.energies.total())};
  for (std::size_t k = 0; k < now.size(); ++k) largest[k] = std::max(largest[k], now[k]);
}

}  // namespace

TEST_CASE("scenes tell their error in time to a factor of two, up to the moment that is named") {
  // The flag flutters: its positions, told to some micrometres, are noise after two ticks.
  const auto [scene, ticks, named] = GENERATE(table<std::string, int, double>(
      {{"table", 9, 0.1}, {"gripper", 9, 0.1}, {"drape-sphere", 12, 0.1}, {"flag", 9, 0.03}}));
  const WorldDef def = make_scene(scene);
  World<double> run(def), exact(def);
  RunError<double> error(def, {}, run);
  exact.refine_substeps(16);
  std::vector<Differences> truth;
  for (int tick = 0; tick < ticks; ++tick) {
    run.step();
    exact.step();
    error.note_tick(run);
    truth.push_back(truth.empty() ? Differences{} : truth.back());
    note(run, exact, truth.back());
  }
  const std::vector<QuantityError> told = error.in_time();
  REQUIRE(told.size() == 3);
  for (std::size_t k = 0; k < told.size(); ++k) {
    const auto& figure = told[k].figure;
    CHECK(figure.until > named);
    const auto last = static_cast<std::size_t>(std::lround(figure.until / run.tick_seconds())) - 1;
    const double exactly = truth.at(last)[k];
    std::cout << scene << ", " << told[k].name << ": told " << figure.estimate.error << ", true "
              << exactly << " until " << figure.until << " s" << std::endl;
    CHECK(figure.estimate.error < 2 * exactly);
    CHECK(figure.estimate.error > exactly / 2);
  }
}
