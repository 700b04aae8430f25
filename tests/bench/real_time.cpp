#include "tests/bench/real_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "server/thread_pool.h"
#include "tests/bench/cases.h"
#include "tests/bench/measures.h"

namespace weft::bench {
namespace {

constexpr double kMatters = 0.7;  ///< of real time: what takes less is run once

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Case {
  RealTimeFigure figure;
  WorldDef def;
  std::vector<double> dearest{}, wall_two{};
};

/// A second of a run.
struct Second {
  double seconds = 0;  ///< that it took, by the given clock
  Profile profile;     ///< its stages' times
  int substeps = 0;
};

/// The dearest of the first seconds of a world.
/// @param clock     by which they are told
/// @param profiler  clock of the stages; null for none, as looking at it takes time too
Second dearest_second(const WorldDef& def, int seconds, Executor* executor, double (*clock)(),
                      double (*profiler)() = nullptr) {
  World<float> world(def, {executor, profiler});
  const int ticks = std::max(1, static_cast<int>(std::lround(def.tick_rate)));
  Second dearest;
  for (int k = 0; k < seconds; ++k) {
    Second now;
    const double start = clock();
    for (int tick = 0; tick < ticks; ++tick) {
      const TickReport& report = world.step();
      now.substeps = std::max(now.substeps, report.substeps);
      for (std::size_t s = 0; s < kStageCount; ++s)
        now.profile.stages[s].seconds += report.profile.stages[s].seconds;
    }
    now.seconds = (clock() - start) / (ticks * world.tick_seconds());
    if (now.seconds > dearest.seconds) dearest = now;
  }
  return dearest;
}

/// Books the stages of a second by what takes them.
void share_out(const Second& second, RealTimeFigure& figure) {
  double springs = 0, air = 0, contact = 0, other = 0;
  for (std::size_t s = 0; s < kStageCount; ++s) {
    const double seconds = second.profile.stages[s].seconds;
    switch (static_cast<Stage>(s)) {
      case Stage::stretch:
      case Stage::bending:
      case Stage::integration:
      case Stage::relaxation:
        springs += seconds;
        break;
      case Stage::fans:
      case Stage::air:
        air += seconds;
        break;
      case Stage::attachments:
      case Stage::diagnostics:
        other += seconds;
        break;
      default:
        contact += seconds;
        break;
    }
  }
  const double all = springs + air + contact + other;
  figure.springs = springs / all;
  figure.air = air / all;
  figure.contact = contact / all;
  figure.other = other / all;
}

void run(Case& one) {
  const int seconds = one.figure.seconds_looked_at;
  const Second second = dearest_second(one.def, seconds, nullptr, cpu_seconds);
  one.figure.substeps = second.substeps;
  if (one.dearest.empty())
    share_out(dearest_second(one.def, seconds, nullptr, cpu_seconds, cpu_seconds), one.figure);
  one.dearest.push_back(second.seconds);
}

std::vector<Case> cases(bool quick, const std::string& mesh_directory) {
  const int seconds = quick ? 1 : 4;
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const char* kind, const WorldDef& def) {
    if (solver_of(def) != SolverKind::verlet) return;
    all.push_back({{}, def});
    all.back().figure.name = name;
    all.back().figure.kind = kind;
    all.back().figure.seconds_looked_at = seconds;
  };
  for (const SceneInfo& info : scenes()) {
    const bool hard = info.name.rfind("hard-", 0) == 0;
    const std::filesystem::path mesh = mesh_directory + "/" + info.installed + ".ply";
    if (!info.installed.empty() && !std::filesystem::exists(mesh)) continue;
    if (quick && info.name != "wall" && info.name != "hammock" && info.name != "hard-teleport")
      continue;
    add(info.name, hard ? "hard case" : "scene", make_scene(info.name, mesh_directory));
  }
  const int n = quick ? 32 : 128;
  for (const BenchScene& scene : bench_scenes()) {
    const WorldDef def = scene.make(n, bench_fabrics().back().fabric);
    const ClothDef& cloth = def.cloths[0];
    if (cloth.rows == cloth.columns)
      add("cotton at " + std::to_string(n) + "², " + scene.name, "cotton", def);
  }
  return all;
}

}  // namespace

std::vector<RealTimeFigure> measure_real_time(bool quick, int runs,
                                              const std::string& mesh_directory) {
  std::vector<Case> all = cases(quick, mesh_directory);
  server::ThreadPool two(2);
  for (int k = 0; k < (quick ? 1 : runs); ++k) {
    for (Case& one : all) {
      if (k > 0 && one.dearest.front() < kMatters) continue;
      run(one);
      if (one.dearest.front() < kMatters && !quick) continue;
      one.wall_two.push_back(
          dearest_second(one.def, one.figure.seconds_looked_at, &two, wall_seconds).seconds);
    }
  }
  std::vector<RealTimeFigure> figures;
  for (Case& one : all) {
    RealTimeFigure& figure = one.figure;
    figure.dearest = median(one.dearest);
    figure.runs = static_cast<int>(one.dearest.size());
    if (!one.wall_two.empty()) {
      figure.wall_two = median(one.wall_two);
      const auto seconds = [&](const WorldDef& def) {
        return dearest_second(def, figure.seconds_looked_at, nullptr, cpu_seconds).seconds;
      };
      WorldDef finer = one.def, other = one.def;
      finer.solver.min_substeps = std::min(2 * figure.substeps, kMostSubsteps);
      other.solver.kind = SolverKind::implicit;
      figure.twice = seconds(finer);
      figure.implicit = seconds(other);
    }
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace weft::bench
