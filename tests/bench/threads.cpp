#include "tests/bench/threads.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "server/thread_pool.h"
#include "tests/bench/cases.h"
#include "tests/bench/measures.h"

namespace weft::bench {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CPU seconds of all threads.
double process_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Works through the chunks alone and tells how long that took.
class TimedExecutor : public Executor {
 public:
  void run(int chunks, void (*work)(void* context, int chunk), void* context) override {
    const double start = wall_seconds();
    for (int chunk = 0; chunk < chunks; ++chunk) work(context, chunk);
    seconds_ += wall_seconds() - start;
  }
  double seconds() const { return seconds_; }

 private:
  double seconds_ = 0;
};

struct Run {
  double wall = 0, cpu = 0;
  std::uint64_t hash = 0;
};

Run run(const WorldDef& def, int ticks, Executor* executor) {
  World<float> world(def, {executor, nullptr});
  const double wall = wall_seconds(), cpu = process_seconds();
  for (int k = 0; k < ticks; ++k) world.step();
  return {wall_seconds() - wall, process_seconds() - cpu, world.hash()};
}

ThreadFigure compare(const std::string& name, const WorldDef& def, int ticks, int runs) {
  server::ThreadPool two(2);
  std::vector<double> walls, wall_ratios, cpu_ratios, offered;
  ThreadFigure figure;
  figure.scene = name;
  figure.ticks = ticks;
  figure.runs = runs;
  figure.same_bits = true;
  for (int k = 0; k < runs; ++k) {
    const Run one = run(def, ticks, nullptr), other = run(def, ticks, &two);
    TimedExecutor timed;
    const Run chunked = run(def, ticks, &timed);
    walls.push_back(one.wall);
    wall_ratios.push_back(other.wall / one.wall);
    cpu_ratios.push_back(other.cpu / one.cpu);
    offered.push_back(timed.seconds() / chunked.wall);
    figure.same_bits = figure.same_bits && one.hash == other.hash && one.hash == chunked.hash;
  }
  figure.wall_one = median(walls);
  figure.wall_ratio = median(wall_ratios);
  figure.cpu_ratio = median(cpu_ratios);
  figure.offered = median(offered);
  return figure;
}

}  // namespace

std::vector<ThreadFigure> measure_threads(bool quick, const std::string& mesh_directory) {
  const int runs = quick ? 3 : 5, ticks = quick ? 30 : 60;
  std::vector<ThreadFigure> figures;
  for (const char* name : {"default", "drape-sphere", "table", "gripper", "flag"})
    figures.push_back(compare(name, make_scene(name, {}), ticks, runs));
  if (std::filesystem::exists(mesh_directory + "/bunny.ply"))
    figures.push_back(
        compare("drop-on-bunny", make_scene("drop-on-bunny", mesh_directory), ticks, runs));
  const auto add = [&](const std::string& name, int side, int count) {
    const auto scene = std::find_if(bench_scenes().begin(), bench_scenes().end(),
                                    [&](const BenchScene& s) { return s.name == name; });
    const std::string size = std::to_string(side) + " x " + std::to_string(side);
    figures.push_back(compare(name + ", cotton, " + size,
                              scene->make(side, bench_fabrics().back().fabric), count, runs));
  };
  const int n = quick ? 64 : 128;
  add("drape", n, 2 * ticks);  // long enough to lie there
  for (const int side : {n / 2, n}) add("swing", side, ticks / 2);
  add("swing", 2 * n, ticks / 6);
  return figures;
}

}  // namespace weft::bench
