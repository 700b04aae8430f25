#include "server/commands/simulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/cloth/cloth_meshes.h"
#include "core/diagnostics/strain.h"
#include "core/geometry/mesh_file.h"
#include "core/scenes/scenes.h"
#include "core/world/cost.h"
#include "core/world/crossing_counter.h"
#include "core/world/object_repair.h"
#include "core/world/verdict.h"
#include "core/world/world.h"
#include "server/clock.h"
#include "server/commands/error_of_run.h"
#include "server/commands/measurement.h"
#include "server/commands/series.h"
#include "server/commands/start_file.h"
#include "server/commands/table.h"
#include "server/options.h"
#include "server/output.h"
#include "server/room/guarantee_watch.h"
#include "server/room/scene_build.h"
#include "server/scene/scene_library.h"
#include "server/thread_pool.h"
#include "server/translate/translate.h"
#include "server/translate/translate_energy.h"
#include "server/work_limit.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

/// Exit code if anything crossed that contact rules out.
constexpr int kCrossed = 3;
/// Exit code if a tick exceeded its limit.
constexpr int kHalted = 4;

/// Whether cloth that started inside objects or through cloth is not out yet.
template <class Real>
bool is_led_out(const GuaranteeWatch<Real>& promise, const World<Real>& world) {
  return promise.guarantee(world).state == proto::GuaranteeState::bad_start;
}

/// Whether the scene put particles elsewhere just before the last tick, through whatever is there.
template <class Real>
bool was_gathered(const World<Real>& world) {
  const WorldDef& def = world.def();
  return std::any_of(def.disturbances.begin(), def.disturbances.end(), [&](const auto& d) {
    return d.gather > 0 &&
           std::llround(d.time * def.tick_rate) + 1 == static_cast<long long>(world.tick());
  });
}

/// A tick that is given up ends it, and the series is then not written.
/// @param error  repetitions that go along with it; null: none
template <class Real>
Measurement<Real> run(World<Real>& world, const SimulateOptions& options, ErrorOfRun* error) {
  WorkLimit limit(options.tick_limit);
  const LimitWatch watch(limit);
  Measurement<Real> m;
  m.ticks.reserve(static_cast<std::size_t>(options.ticks));
  CrossingCounter<Real> counter;
  const bool judged = world.def().verdict.strain > 0;
  GuaranteeWatch<Real> promise(0, &process_seconds);
  promise.start(world, look_ahead(world, options.tick_limit));
  std::optional<Series<Real>> series;
  if (!options.series.empty())
    series.emplace(options.series, world, options.series_every, options.ticks);
  int done = 0;
  bool led_out = is_led_out(promise, world);
  for (int i = 1; i <= options.ticks; done = i++) {
    m.halted = !measure_tick(world, limit, m);
    if (m.halted) break;
    promise.note_tick(world);
    if (series) series->note_tick(world);
    if (error) error->step();
    if (judged) m.verdict.look(world);
    led_out = led_out || was_gathered(world);
    if (i % options.check_every == 0 || i == options.ticks)
      look(world, judged, led_out, counter, m);
    // A tick that was taken back has led nothing out.
    led_out = led_out && (was_stopped(world.report()) || is_led_out(promise, world));
  }
  if (m.halted && done % options.check_every != 0) look(world, judged, led_out, counter, m);
  if (series && !m.halted) series->finish();
  if (done > 0) promise.count(world);
  m.guarantee = promise.guarantee(world);
  // What is never led out is no excuse.
  if (m.guarantee.state != proto::GuaranteeState::held)
    m.broken_promises += std::exchange(m.while_led_out, 0);
  std::sort(m.ticks.begin(), m.ticks.end());
  return m;
}

double percentile(const std::vector<double>& sorted, std::size_t percent) {
  return sorted[std::min(sorted.size() - 1, sorted.size() * percent / 100)];
}

/// Counters of the guard; null without one.
template <class Real>
Json guard_summary(const World<Real>& world) {
  if (!world.guard()) return nullptr;
  const GuardCounts& counts = world.guard()->counts();
  return {{"wanted_motion", counts.wanted},
          {"truncated_motion", counts.truncated},
          {"truncated_part", counts.wanted > 0 ? counts.truncated / counts.wanted : 0},
          {"collections", counts.collections},
          {"renewals", counts.renewals},
          {"particles_anchored", counts.anchored},
          {"steps_certified", counts.critical},
          {"open_pairs", world.guard()->open_pairs()}};
}

/// What each cause did to the cloth's energy over the run [J].
template <class Real>
Json balance_summary(const World<Real>& world) {
  const std::optional<proto::EnergyBalance> balance = balance_of(world);
  return balance ? json_of(*balance) : Json("not measured");
}

/// Result of a hard case; null for other scenes.
template <class Real>
Json verdict_summary(const World<Real>& world, const Verdict<Real>& verdict) {
  if (!(world.def().verdict.strain > 0)) return nullptr;
  const std::vector<std::string> failures = verdict.failures(world.def().verdict);
  return {
      {"passed", failures.empty()},
      {"failures", failures},
      {"ticks", verdict.ticks},
      {"crossings", verdict.crossings},
      {"ticks_with_crossings", verdict.crossed_ticks},
      {"crossings_before", verdict.early_crossings},
      {"deepest_penetration", verdict.deepest},
      {"smallest_gap", std::isfinite(verdict.smallest_gap) ? Json(verdict.smallest_gap) : Json()},
      {"largest_strain", verdict.largest_strain},
      {"energy_excess", verdict.energy_excess},
      {"rest_error", std::isfinite(verdict.rest_error) ? Json(verdict.rest_error) : Json()},
      {"height_error", std::isfinite(verdict.height_error) ? Json(verdict.height_error) : Json()},
      {"hands_lag", verdict.hands_lag},
      {"lost_motion", verdict.lost_motion},
      {"recoveries", verdict.recoveries},
      {"allowed",
       {{"strain", world.def().verdict.strain},
        {"lost_motion", world.def().verdict.lost_motion},
        {"clear_after", world.def().verdict.clear_after},
        {"heights", world.def().verdict.heights},
        {"hands_lag", world.def().verdict.hands_lag}}}};
}

template <class Real>
Json summary(const SimulateOptions& options, const World<Real>& world, const Measurement<Real>& m,
             const std::vector<std::string>& notices, const ErrorOfRun* error) {
  const double simulated = options.ticks * world.tick_seconds();
  std::vector<Real> scratch;
  const StrainStatistics strain = strain_statistics(world.model(), world.state().x, scratch);
  const Energies& energy = world.report().energies;
  Json measured = Json::object();
  for (const NamedNumber& number : world.measurements()) measured[number.name] = number.value;
  Json stages = Json::object();
  for (std::size_t i = 0; i < kStageCount; ++i) {
    stages[kStageNames[i]] = {{"milliseconds", m.stages.stages[i].seconds * 1000},
                              {"work", m.stages.stages[i].work}};
  }
  return {
      {"scene", options.scene},
      {"particles", world.model().mass.size()},
      {"triangles", world.model().triangles.size()},
      {"ticks", options.ticks},
      {"tick_rate", world.def().tick_rate},
      {"threads", options.threads},
      {"precision", options.in_double ? "double" : "single"},
      {"simulated_seconds", simulated},
      {"cpu_seconds", m.cpu},
      {"wall_seconds", m.wall},
      {"real_time_factor", m.cpu > 0 ? simulated / m.cpu : 0},
      {"tick_milliseconds",
       {{"median", percentile(m.ticks, 50) * 1000}, {"p95", percentile(m.ticks, 95) * 1000}}},
      {"stages", stages},
      {"energy",
       {{"kinetic", energy.kinetic},
        {"stretch", energy.stretch},
        {"bending", energy.bending},
        {"gravity", energy.gravity},
        {"total", energy.total()}}},
      {"balance", balance_summary(world)},
      {"error", error ? error->summary() : Json("not measured")},
      {"strain",
       {{"largest", strain.largest}, {"p99", strain.p99}, {"largest_of_run", m.largest_strain}}},
      {"measurements", measured},
      {"deepest_penetration", m.deepest},
      {"crossings",
       {{"cloth_with_cloth", m.cloth_crossings},
        {"cloth_with_object", m.object_crossings},
        {"ticks_looked_at", m.checks},
        {"ticks_with_any", m.crossed_ticks},
        {"first_tick", m.first_crossed > 0 ? Json(m.first_crossed) : Json()},
        {"while_led_out", m.while_led_out}}},
      {"guarantee",
       {{"state", proto::name_of(m.guarantee.state)},
        {"covers", m.guarantee.covers},
        {"pairs", m.guarantee.pairs},
        {"reasons", m.guarantee.reasons}}},
      {"guard", guard_summary(world)},
      {"verdict", verdict_summary(world, m.verdict)},
      {"hash", proto::hash_text(world.hash())},
      {"solver", solver_name(world.def())},
      {"substeps", world.report().substeps},
      {"substeps_of_run", {m.least_substeps, m.most_substeps}},
      {"divergences", m.divergences},
      {"damped_substeps", m.damped_substeps},
      {"notices", notices}};
}

/// Reports crossings on standard error.
/// @return exit code: failure if any came after the scene's grace time
template <class Real>
int warn_of_crossings(const Measurement<Real>& m) {
  if (m.crossed_ticks == 0) return 0;
  std::fprintf(stderr,
               "weft: %zu crossings of cloth with cloth and %zu with objects in %d of %d ticks, "
               "from tick %d on%s\n",
               m.cloth_crossings, m.object_crossings, m.crossed_ticks, m.checks, m.first_crossed,
               m.broken_promises > 0 ? ""
               : m.while_led_out > 0
                   ? ", of cloth that started or was gathered there and was led out"
               : m.late_crossings > 0 ? ", about which its contact promises nothing"
                                      : ", none after the scene's grace time");
  return m.broken_promises > 0 ? kCrossed : 0;
}

/// Reports on standard error ticks in which the cloth stood still because they could not be
/// computed.
template <class Real>
void warn_of_stops(const Measurement<Real>& m) {
  if (m.stopped == 0) return;
  std::fprintf(
      stderr,
      "weft: in %d of %zu ticks the cloth went back to its last good state and was stopped, "
      "as no number of substeps that was tried could compute them\n",
      m.stopped, m.ticks.size());
}

/// Reports a tick that was given up, and what was found in those before it.
template <class Real>
int tell_halt(const SimulateOptions& options, const World<Real>& world,
              const Measurement<Real>& m) {
  std::fprintf(stderr,
               "weft: tick %llu of scene %s took more than %g s of CPU and was given up; take "
               "fewer particles or substeps, or raise --tick-limit\n",
               static_cast<unsigned long long>(world.tick() + 1), options.scene.c_str(),
               options.tick_limit);
  warn_of_stops(m);
  warn_of_crossings(m);
  if (m.guarantee.reasons.empty()) return kHalted;
  std::string told = proto::name_of(m.guarantee.state);
  for (const std::string& reason : m.guarantee.reasons) told += "; " + reason;
  std::fprintf(stderr, "weft: guarantee %s\n", told.c_str());
  return kHalted;
}

/// Checks the path of an output before minutes are spent.
/// @param name  of the option
void check_out(const char* name, const std::string& path, bool ending, const char* endings) {
  if (path.empty()) return;
  if (!ending) throw OptionError(name, path, std::string("a file that ends in ") + endings);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw OptionError(name, path, "a file, and this is a folder");
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    throw OptionError(name, path, "a file in a folder that exists");
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK) != 0)
    throw OptionError(name, path, "a file in a folder that may be written to");
}

void check_options(const SimulateOptions& o) {
  check_range("--ticks", o.ticks, kTickCounts);
  check_range("--threads", o.threads, kThreadCounts);
  check_range("--check-every", o.check_every, kTickCounts);
  check_range("--series-every", o.series_every, kTickCounts);
  check_range("--tick-limit", o.tick_limit, kTickLimits);
  check_out("--out", o.out, o.out.ends_with(".obj") || o.out.ends_with(".ply"), ".obj or .ply");
  check_out("--series", o.series, o.series.ends_with(".npy"), ".npy");
}

WorldDef definition_of(const SimulateOptions& options) {
  WorldDef def = SceneLibrary(beside_program("meshes"), options.scenes).opened(options.scene);
  for (const auto& [key, value] : options.settings) set_field(def, key, value);
  if (!options.start.empty()) def.start = read_start(options.start);
  return def;
}

/// Throws CostError, which tells how to lift the bound.
template <class Real>
void bound_cost(const SimulateOptions& options, const World<Real>& world) {
  if (options.any_cost) return;
  try {
    check_cost(world.cost_in(world.environment()), "scene", world.def().name);
  } catch (const CostError& error) {
    throw CostError(error.field, error.value, error.limit,
                    error.hint + ", or allow it by --any-cost");
  }
}

/// @param Real  of the state
template <class Real>
int simulate_in(const SimulateOptions& options) {
  WorldDef def = definition_of(options);
  check_size(def);
  const std::vector<std::string> repairs = repair_objects(def);
  ThreadPool pool(options.threads);
  World<Real> world(def, {options.threads > 1 ? &pool : nullptr, &process_seconds});
  bound_cost(options, world);
  world.measure_energy(options.balance);
  std::vector<std::string> notices;
  for (const SceneNotice& notice : notices_of(world, repairs)) {
    notices.push_back(notice.message);
    if (notice.warns) std::fprintf(stderr, "weft: %s\n", notice.message.c_str());
  }
  std::optional<ErrorOfRun> error;
  if (options.error) {
    error.emplace(def, Runtime{options.threads > 1 ? &pool : nullptr, nullptr});
    const TickCost cost = world.cost_in(world.environment());
    std::fprintf(stderr, "weft: %s\n", error->cost_told_before(cost).c_str());
  }
  const Measurement<Real> measurement = run(world, options, error ? &*error : nullptr);
  if (measurement.halted) return tell_halt(options, world, measurement);
  const Json result = summary(options, world, measurement, notices, error ? &*error : nullptr);
  if (options.json)
    std::printf("%s\n", result.dump(2).c_str());
  else
    print_table(result, "");
  // The summary is printed even if the file cannot be written.
  if (!options.out.empty())
    write_file(options.out,
               encode_meshes(cloth_meshes(world.model(), world.state().x), options.out));
  warn_of_stops(measurement);
  return warn_of_crossings(measurement);
}

}  // namespace

int simulate(const SimulateOptions& options) {
  check_options(options);
  return options.in_double ? simulate_in<double>(options) : simulate_in<float>(options);
}

}  // namespace weft::server
