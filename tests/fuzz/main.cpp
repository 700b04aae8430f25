#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <deque>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <sys/mman.h>
#include <thread>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "server/clock.h"
#include "server/thread_pool.h"
#include "tests/fuzz/apart.h"
#include "tests/fuzz/run.h"
#include "tests/fuzz/script_draw.h"
#include "tests/fuzz/table.h"

// Random legal scenes and commands through the whole room, each in a process of its own.

#ifdef __SANITIZE_ADDRESS__
// Children end without looking for leaks; too much memory is a finding and not the machine's end.
extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "detect_leaks=0:hard_rss_limit_mb=3000:allocator_may_return_null=0:detect_stack_use_after_"
         "return=0";
}
#endif

namespace weft::fuzz {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr double kSlower = 5;  // than without sanitizers, as bounds of time take it
#else
constexpr double kSlower = 1;
#endif

// CPU time of one scene [s]: 30 minutes on two cores, with sanitizers, then open more than 2,000
// scenes, beside those that are refused. More seconds show more of each and fewer of them.
constexpr double kSceneSeconds = 0.15;

struct Options {
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> scene;
  double seconds = 60;
  std::uint64_t scenes = 0;
  int jobs = 1;
  double tick_limit = 2;
  bool small = false, print = false;
  std::string found, script;
};

/// An Outcome that a process and its children share.
class SharedOutcome {
 public:
  SharedOutcome()
      : outcome_(static_cast<Outcome*>(::mmap(nullptr, sizeof(Outcome), PROT_READ | PROT_WRITE,
                                              MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
  ~SharedOutcome() { ::munmap(outcome_, sizeof(Outcome)); }
  SharedOutcome(const SharedOutcome&) = delete;
  SharedOutcome& operator=(const SharedOutcome&) = delete;
  Outcome& operator*() { return *outcome_; }

 private:
  Outcome* outcome_;  // zero, as new pages are
};

struct Job {
  std::string name;
  SharedOutcome outcome;
  std::unique_ptr<Apart> process;
};

class Driver {
 public:
  explicit Driver(const Options& options) : options_(options) {
    limits_.tick = options.tick_limit * kSlower;
    limits_.grace *= kSlower;
    limits_.wait *= kSlower;
    limits_.build *= kSlower;
    limits_.hang = 2 * limits_.build;
    limits_.scene = options.scene || !options.script.empty()
                        ? 1e9
                        : kSlower * (options.small ? 0.5 : kSceneSeconds);
    if (options.small) size_ = {7, 12, 8};
  }

  int run() {
    run_found();
    if (!options_.script.empty()) {
      std::ifstream file(options_.script == "-" ? "/dev/stdin" : options_.script);
      start("--script " + options_.script, script_of(nlohmann::ordered_json::parse(file)),
            Again::no);
    } else if (options_.scene) {
      start_scene(*options_.scene);
    } else {
      run_many();
    }
    while (!jobs_.empty()) finish_one();
    std::fputs(table_.text().c_str(), stdout);
    return table_.good() ? 0 : 1;
  }

 private:
  /// Reduced cases that once failed, one a line, behind lines that begin with # and say why.
  void run_found() {
    if (options_.found.empty()) return;
    std::ifstream file(options_.found);
    if (!file) throw std::runtime_error("no file " + options_.found);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      if (line.empty() || line[0] == '#') continue;
      start("--script <(sed -n " + std::to_string(number) + "p " + options_.found + ")",
            script_of(nlohmann::ordered_json::parse(line)), Again::once);
    }
  }

  void run_many() {
    const double end = server::process_seconds() + options_.seconds;
    for (std::uint64_t scene = 0;; ++scene) {
      const bool more =
          options_.scenes > 0 ? scene < options_.scenes : server::process_seconds() < end;
      if (!more) return;
      start_scene(scene);
    }
  }

  void start_scene(std::uint64_t scene) {
    // Every eighth runs twice, and every eighth a second time on two threads.
    constexpr std::uint64_t kRepeated = 8;
    const std::string name = "--seed " + std::to_string(options_.seed) +
                             (options_.small ? " --small" : "") + " --scene " +
                             std::to_string(scene);
    ScriptSize size = size_;
    const bool threads = scene % kRepeated == kRepeated / 2;
    if (threads) size.within = false;  // threads meet fewer stop points
    const Again again = threads                  ? Again::on_threads
                        : scene % kRepeated == 0 ? Again::once
                                                 : Again::no;
    start(name, draw_script(Dice(options_.seed, scene), size), again);
  }

  /// Whether a second run, with a thread more or not, shall lead to the same hash.
  enum class Again { no, once, on_threads };

  void start(const std::string& name, const Script& script, Again again) {
    if (options_.print) std::cout << json_of(script).dump() << std::endl;
    while (jobs_.size() >= static_cast<std::size_t>(options_.jobs)) finish_one();
    auto job = std::make_unique<Job>();
    job->name = name;
    Outcome& outcome = *job->outcome;
    const auto work = [&] {
      // Not through the parent's pattern of colours, and to the child's own words.
      spdlog::set_default_logger(spdlog::stderr_logger_st("fuzz"));
      spdlog::set_level(spdlog::level::err);
      run_script(script, library_, limits_, ~std::uint64_t{0}, outcome);
      if (again != Again::no && outcome.ended && outcome.halts == 0 && outcome.cpu < limits_.scene)
        run_again(script, again, outcome);
    };
    job->process = std::make_unique<Apart>(work, kPatience * limits_.hang);
    jobs_.push_back(std::move(job));
  }

  void run_again(const Script& script, Again again, Outcome& outcome) {
    Outcome second{};
    server::ThreadPool pool(again == Again::on_threads ? 2 : 1);
    run_script(script, library_, limits_, outcome.steps, second,
               again == Again::on_threads ? &pool : nullptr);
    outcome.problems += second.problems;
    if (second.problems > 0) std::memcpy(outcome.problem, second.problem, sizeof outcome.problem);
    if (!second.ended || second.halts > 0 || second.cpu > limits_.scene ||
        second.hash == outcome.hash)
      return;
    ++outcome.problems;
    std::snprintf(outcome.problem, sizeof outcome.problem, "%s",
                  again == Again::on_threads ? "on two threads it ends with another hash"
                                             : "a second run ends with another hash");
  }

  void finish_one() {
    while (true) {
      for (auto job = jobs_.begin(); job != jobs_.end(); ++job) {
        if (!(*job)->process->ended()) continue;
        const Ending ending = (*job)->process->ending();
        if (ending.kind != Ending::Kind::well && (options_.scene || !options_.script.empty()))
          std::fputs(ending.words.c_str(), stderr);
        table_.add((*job)->name, *(*job)->outcome, ending);
        jobs_.erase(job);
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  static constexpr double kPatience =
      20;  // of wall time, per CPU time of a step, on a loaded machine

  Options options_;
  Limits limits_;
  ScriptSize size_;
  const server::SceneLibrary library_{server::beside_program("meshes")};
  std::deque<std::unique_ptr<Job>> jobs_;
  Table table_;
};

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Random legal scenes and commands through the whole room");
  const auto* seed =
      app.add_option("--seed", options.seed, "of all scenes; else by the time of day");
  app.add_option("--scene", options.scene, "this one alone");
  app.add_option("seconds", options.seconds, "how long new scenes are begun");
  app.add_option("--scenes", options.scenes, "how many instead");
  app.add_option("--jobs", options.jobs, "scenes at a time")->check(CLI::Range(1, 64));
  app.add_option("--tick-limit", options.tick_limit, "of CPU time [s]; with sanitizers five times");
  app.add_flag("--small", options.small, "small cloths and few steps");
  app.add_flag("--print", options.print, "print what is run as one line of JSON");
  app.add_option("--found", options.found, "file with cases to run first");
  app.add_option("--script", options.script, "file with one case to run alone");
  bool for_dev = false;
  app.add_flag("--no-sanitize", for_dev, "for ./dev, which chooses the build by it");
  CLI11_PARSE(app, argc, argv);
  if (seed->empty()) options.seed = static_cast<std::uint64_t>(std::time(nullptr));
  return Driver(options).run();
}

}  // namespace
}  // namespace weft::fuzz

int main(int argc, char** argv) {
  try {
    return weft::fuzz::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft_fuzz: %s\n", error.what());
    return 2;
  }
}
