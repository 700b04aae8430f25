#include "server/commands/drape.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>

#include <nlohmann/json.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/measurements.h"
#include "core/scenes/textile_scenes.h"
#include "core/world/script.h"
#include "core/world/world.h"
#include "server/thread_pool.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

/// Most that a particle starts above or below its place [m].
constexpr double kStartNoise = 1e-3;
/// Specimens agree if they differ by at most this [points], or by twice their standard error.
constexpr double kAgreement = 3;

struct Specimen {
  std::string name;
  WorldDef def;
};

/// What one run ended with.
struct Run {
  double coefficient = 0;  ///< [%]
  double folds = 0;
  double speed = 0;  ///< largest [m/s]
};

/// Mean and standard error of the mean.
struct Estimate {
  double mean = 0, error = 0;
};

template <class Value>
Estimate estimate(const std::vector<Run>& runs, Value Run::*value) {
  const double count = static_cast<double>(runs.size());
  Estimate e;
  for (const Run& run : runs) e.mean += run.*value / count;
  double squares = 0;
  for (const Run& run : runs) squares += (run.*value - e.mean) * (run.*value - e.mean);
  e.error = std::sqrt(squares / (count - 1) / count);
  return e;
}

std::vector<Specimen> specimens_of(const FabricDef& fabric) {
  std::vector<Specimen> specimens;
  for (const int side : {41, 61, 81})
    specimens.push_back({"grid of " + std::to_string(side) + " x " + std::to_string(side),
                         drape_test_on_grid(fabric, side)});
  specimens.push_back({"mesh of rings", drape_test_on_rings(fabric, 10)});
  return specimens;
}

/// @param start  which noise it starts with
Run run_test(const WorldDef& specimen, int start, double seconds) {
  World<float> world(specimen);
  auto& state = world.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.inverse_mass[i] > 0)
      state.x[i].y() +=
          static_cast<float>(kStartNoise * noise_at(static_cast<std::uint64_t>(start), i, 1));
  }
  world.accept_state();
  const int ticks = static_cast<int>(std::ceil(seconds / world.tick_seconds()));
  for (int tick = 0; tick < ticks; ++tick) {
    const TickReport& report = world.step();
    if (report.divergence) throw std::runtime_error(describe(*report.divergence));
  }
  Run run;
  for (const NamedNumber& number : world.measurements()) {
    if (number.name == "drape_coefficient_percent") run.coefficient = number.value;
    if (number.name == "folds") run.folds = number.value;
    if (number.name == "largest_speed_m_s") run.speed = number.value;
  }
  return run;
}

/// The runs of each specimen, in order, whichever thread did them.
std::vector<std::vector<Run>> run_all(const std::vector<Specimen>& specimens,
                                      const DrapeOptions& options) {
  const auto starts = static_cast<std::size_t>(options.starts);
  std::vector<std::vector<Run>> runs(specimens.size(), std::vector<Run>(starts));
  std::vector<std::exception_ptr> failures(specimens.size() * starts);
  ThreadPool threads(options.threads);
  run_chunks(&threads, static_cast<int>(failures.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    try {
      runs[k / starts][k % starts] =
          run_test(specimens[k / starts].def, static_cast<int>(k % starts), options.seconds);
    } catch (...) {
      failures[k] = std::current_exception();  // must not leave a thread of the pool
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return runs;
}

Json json_of(const Estimate& e) {
  return {{"mean", e.mean}, {"standard_error", e.error}};
}

Json result_of(const std::string& name, const std::vector<Run>& runs) {
  const auto by_coefficient = [](const Run& a, const Run& b) {
    return a.coefficient < b.coefficient;
  };
  const auto [least, most] = std::minmax_element(runs.begin(), runs.end(), by_coefficient);
  double speed = 0;
  for (const Run& run : runs) speed = std::max(speed, run.speed);
  return {{"specimen", name},
          {"runs", runs.size()},
          {"coefficient_percent", json_of(estimate(runs, &Run::coefficient))},
          {"least_percent", least->coefficient},
          {"most_percent", most->coefficient},
          {"folds", json_of(estimate(runs, &Run::folds))},
          {"largest_speed_m_s", speed}};
}

/// Whether the means of any two specimens are as near as starts and fineness allow.
bool agree(const std::vector<std::vector<Run>>& runs) {
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Estimate first = estimate(runs[a], &Run::coefficient),
                     second = estimate(runs[b], &Run::coefficient);
      const double error = std::hypot(first.error, second.error);
      if (std::abs(first.mean - second.mean) > std::max(kAgreement, 2 * error)) return false;
    }
  }
  return true;
}

void print(const Json& result) {
  const Json& coefficient = result["coefficient_percent"];
  std::printf("%-18s %5.1f %% +- %.1f (%.1f to %.1f), %.1f folds, still moves at %.1f mm/s\n",
              result["specimen"].get_ref<const std::string&>().c_str(),
              coefficient["mean"].get<double>(), coefficient["standard_error"].get<double>(),
              result["least_percent"].get<double>(), result["most_percent"].get<double>(),
              result["folds"]["mean"].get<double>(),
              result["largest_speed_m_s"].get<double>() * 1000);
}

}  // namespace

int predict_drape(const DrapeOptions& options) {
  check_range("--starts", options.starts, kDrapeStarts);
  check_range("--seconds", options.seconds, kDrapeSeconds);
  WorldDef holder;
  holder.cloths.front().fabric = make_fabric(options.fabric);
  for (const auto& [key, value] : options.settings) {
    if (!key.starts_with("fabric."))
      throw OptionError("--set", key, "a value of the fabric, e.g. fabric.bending_warp=1e-5");
    set_field(holder, key, value);
  }
  const std::vector<Specimen> specimens = specimens_of(holder.cloths.front().fabric);
  const std::vector<std::vector<Run>> runs = run_all(specimens, options);
  std::vector<Run> all;
  Json out{{"fabric", fabric_name(holder.cloths.front().fabric)}, {"specimens", Json::array()}};
  for (std::size_t k = 0; k < specimens.size(); ++k) {
    out["specimens"].push_back(result_of(specimens[k].name, runs[k]));
    all.insert(all.end(), runs[k].begin(), runs[k].end());
  }
  out["all"] = result_of("all", all);
  out["specimens_agree"] = agree(runs);
  const DrapeBand band = published_drape(holder.cloths.front().fabric);
  if (band.high > 0) out["published_percent"] = {band.low, band.high};
  if (options.json) {
    std::printf("%s\n", out.dump(2).c_str());
    return 0;
  }
  std::printf("drape of %s, %d starts of each specimen, +- one standard error of the mean\n",
              out["fabric"].get_ref<const std::string&>().c_str(), options.starts);
  for (const Json& result : out["specimens"]) print(result);
  print(out["all"]);
  std::printf("the specimens %s within %g points or twice their standard error\n",
              out["specimens_agree"].get<bool>() ? "agree" : "do not agree", kAgreement);
  if (band.high > 0) std::printf("published: %g to %g %%\n", band.low, band.high);
  return 0;
}

}  // namespace weft::server
