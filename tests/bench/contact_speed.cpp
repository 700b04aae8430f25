#include "tests/bench/contact_speed.h"

#include <array>
#include <cstdio>
#include <iostream>

#include "core/diagnostics/crossings.h"
#include "tests/bench/contact_states.h"
#include "tests/bench/measures.h"

namespace weft::bench {
namespace {

constexpr int kRuns = 5;

/// Ticks of large sheets are measured in tenths: at ten times the rate, with as long substeps.
constexpr int kLarge = 200, kParts = 10;

/// Ticks that a state has before it is measured, in which layers come to lie on each other.
constexpr int kTicksBefore = 6, kLargeTicksBefore = 2;

/// A state is not measured where one of its ticks takes more CPU time [s].
constexpr double kLongestTick = 40;

/// A world in a state, timed in turn with another one.
struct Timed {
  World<float> world;
  std::vector<double> tick{};
  std::array<std::vector<double>, kStageCount> stages{};
  std::vector<double> pairs{}, rows{};

  explicit Timed(const ContactState& state) : world(state.def, {nullptr, cpu_seconds}) {
    take_state(state, world);
  }
  /// CPU seconds of its next tick.
  double look_ahead() {
    const double start = cpu_seconds();
    world.step();
    return cpu_seconds() - start;
  }
  /// @param parts  of a tick is each of the steps
  void run(int steps, int parts) {
    std::array<double, kStageCount> sums{};
    const double start = cpu_seconds(), to_tick = 1e3 * parts / steps;
    for (int k = 0; k < steps; ++k) {
      const Profile& profile = world.step().profile;
      for (std::size_t s = 0; s < kStageCount; ++s) sums[s] += profile.stages[s].seconds;
    }
    tick.push_back(to_tick * (cpu_seconds() - start));
    for (std::size_t s = 0; s < kStageCount; ++s) stages[s].push_back(to_tick * sums[s]);
    std::size_t present = 0;
    for (const GuardedPair<float>& pair : world.guard()->pairs()) present += pair.gone ? 0 : 1;
    pairs.push_back(static_cast<double>(present));
    rows.push_back(static_cast<double>(world.guard()->rows().size()));
  }
  double of(Stage stage) const { return median(stages[static_cast<std::size_t>(stage)]); }
};

/// The state with ticks in parts, with friction or without.
ContactState variant(ContactState state, int parts, bool friction) {
  state.def.tick_rate *= parts;
  if (!friction) state.def.cloths[0].fabric.friction = 0;
  return state;
}

std::string too_long(double seconds) {
  char text[80];
  std::snprintf(text, sizeof text, "one tick takes %.1f CPU s, more than %.0f", seconds,
                kLongestTick);
  return text;
}

ContactSpeed measure(const ContactState& state, int n) {
  ContactSpeed figure;
  figure.state = state.name;
  figure.how = state.how;
  figure.n = n;
  const int parts = n > kLarge ? kParts : 1, before = n > kLarge ? kLargeTicksBefore : kTicksBefore;
  Timed rough(variant(state, parts, true)), smooth(variant(state, parts, false));
  for (int k = 0; k < before * parts; ++k) {
    const double seconds = parts * std::max(rough.look_ahead(), smooth.look_ahead());
    if (seconds <= kLongestTick) continue;
    figure.missing = too_long(seconds);
    return figure;
  }
  constexpr int kSteps = 2;
  figure.ticks = static_cast<double>(kSteps) / parts;
  figure.runs = kRuns;
  for (int k = 0; k < kRuns; ++k) {
    rough.run(kSteps, parts);
    smooth.run(kSteps, parts);
  }
  figure.substeps = parts * rough.world.report().substeps;
  figure.pairs = median(rough.pairs);
  figure.rows = median(rough.rows);
  figure.tick = median(rough.tick);
  figure.broad_phase = rough.of(Stage::broad_phase);
  figure.pair_tests = rough.of(Stage::pairs);
  figure.regions = rough.of(Stage::regions);
  figure.row_making = rough.of(Stage::narrow_phase);
  figure.friction = rough.of(Stage::contact) - smooth.of(Stage::contact);
  figure.repulsion = smooth.of(Stage::contact);
  for (const Stage stage : {Stage::stretch, Stage::bending, Stage::integration, Stage::diagnostics})
    figure.elastic += rough.of(stage);
  const ClothModel<float>& model = rough.world.model();
  const Crossings found = count_self_crossings(rough.world.state().x, model.edges, model.triangles);
  figure.crossings = static_cast<double>(found.proper + found.touching);
  return figure;
}

}  // namespace

std::vector<ContactSpeed> measure_contact_speed(bool quick) {
  std::vector<ContactSpeed> figures;
  for (const int n : quick ? std::vector<int>{33} : std::vector<int>{129, 257}) {
    for (const ContactState& state : contact_states(n)) {
      std::cerr << "bench: contact, " << state.name << ", " << n << std::endl;
      figures.push_back(measure(state, n));
    }
  }
  return figures;
}

}  // namespace weft::bench
