#include "tests/bench/cells.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace weft::bench {
namespace {

std::string text(const char* format, double a, double b) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

/// What one run needs to be timed and compared.
struct Run {
  Cell cell;
  WorldDef def;
  int timed_ticks = 0;
  std::vector<double> seconds;  ///< CPU time of the timed ticks, one entry a run
};

/// Cost of a whole run, from its second tick on [CPU s].
/// @param substeps  of its first tick
double expected_seconds(const WorldDef& def, int ticks, int& substeps) {
  World<float> world(def);
  substeps = world.step().substeps;
  const double start = cpu_seconds();
  world.step();
  return (cpu_seconds() - start) * ticks;
}

/// Why a run that came to its end counts as failed; empty if it does not. Farther off than the
/// cloth has moved in positions or in its mean shape, or by more energy than the fall from its own
/// length brings, it tells nothing of the cloth any more.
std::string why_failed(const ErrorVector& error, const Compared& compared) {
  const double energy = compared.energies < compared.first ? 0 : error.energy;
  const std::pair<const char*, double> figures[] = {
      {"positions", error.position}, {"mean shape", error.mean_shape}, {"energy", energy}};
  for (const auto& [what, value] : figures) {
    if (!std::isfinite(value)) return std::string(what) + " off by no finite number";
    if (value > 1) return what + text(" off by %.0f %%", 100 * value, 0);
  }
  return {};
}

/// Follows one run to its end.
void run_once(const CaseResult& result, Run& run) {
  const BenchScene& scene = *result.scene;
  World<float> world(run.def);
  Path path;
  path.samples.push_back(snapshot(world.state()));
  double seconds = 0;
  run.cell.outcome = Outcome::ran;
  for (int tick = 1; tick <= scene.ticks; ++tick) {
    const double start = cpu_seconds();
    const TickReport& report = world.step();
    seconds += cpu_seconds() - start;
    if (tick == run.timed_ticks) run.seconds.push_back(seconds);
    run.cell.substeps = std::max(run.cell.substeps, report.substeps);
    if (report.divergence) {
      run.cell.outcome = Outcome::failed;
      run.cell.reason = describe(*report.divergence);
      run.cell.cpu_per_second = seconds / (tick * world.tick_seconds());
      return;
    }
    if (tick % scene.sample_every != 0) continue;
    path.samples.push_back(snapshot(world.state()));
    path.deepest = std::max(path.deepest, world.deepest_penetration());
  }
  const World<double> reference(without_dashpots(result.def));
  const Path& right = result.reference.path;
  run.cell.error = worst_error(
      errors(reference.model(), result.def.cloths[0], result.def.environment.gravity, path, right),
      result.reference.compared, path, right);
  run.cell.reason = why_failed(run.cell.error, result.reference.compared);
  if (!run.cell.reason.empty()) run.cell.outcome = Outcome::failed;
}

void time_again(Run& run) {
  World<float> world(run.def);
  const double start = cpu_seconds();
  for (int tick = 0; tick < run.timed_ticks; ++tick) world.step();
  run.seconds.push_back(cpu_seconds() - start);
}

/// Decides whether a run fits the budget, and how many of its ticks are timed.
void plan(const CaseResult& result, const Effort& effort, Run& run) {
  const BenchScene& scene = *result.scene;
  run.cell.scene = scene.name;
  run.cell.fabric = result.fabric;
  run.cell.n = result.n;
  if (!result.reference.missing.empty()) {
    run.cell.reason = result.reference.missing;
    return;
  }
  const double seconds = expected_seconds(run.def, scene.ticks, run.cell.substeps);
  const double budget = run_budget(scene, result.n) * effort.budget_factor;
  if (seconds > budget) {
    run.cell.reason = text("one run would take %.1f CPU s, more than %.1f", seconds, budget);
    return;
  }
  run.timed_ticks = scene.ticks;
  // Where nothing is met, each tick costs the same.
  if (scene.forces_alone && seconds > effort.timed_seconds)
    run.timed_ticks =
        std::clamp(static_cast<int>(effort.timed_seconds / seconds * scene.ticks), 2, scene.ticks);
  run.cell.outcome = Outcome::ran;
}

}  // namespace

CaseResult run_case(const BenchScene& scene, const BenchFabric& fabric, int n,
                    const Effort& effort) {
  CaseResult result;
  result.scene = &scene;
  result.fabric = fabric.name;
  result.n = n;
  result.def = scene.make(n, fabric.fabric);
  BenchScene within = scene;
  within.reference_budget *= effort.budget_factor;
  result.reference = make_reference(within, result.def, effort.reference);
  World<float> probe(result.def);
  const int stable = probe.step().substeps;
  std::vector<Run> runs;
  for (const Setting& setting : settings(effort.quick, fewest_relaxing_substeps(result.def))) {
    Run run;
    run.cell.setting = setting;
    run.def = with_setting(result.def, setting, stable);
    plan(result, effort, run);
    if (run.cell.outcome == Outcome::ran) run_once(result, run);
    runs.push_back(std::move(run));
  }
  for (int k = 1; k < effort.timed_runs; ++k) {
    for (Run& run : runs) {
      if (run.cell.outcome == Outcome::ran) time_again(run);
    }
  }
  for (Run& run : runs) {
    const bool told = run.cell.cpu_per_second > 0;  // by a run that blew up
    if (!run.seconds.empty() && !told) {
      run.cell.timed_runs = static_cast<int>(run.seconds.size());
      run.cell.cpu_per_second = median(run.seconds) / (run.timed_ticks * probe.tick_seconds());
    }
    result.cells.push_back(run.cell);
  }
  return result;
}

}  // namespace weft::bench
