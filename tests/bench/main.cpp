#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>

#include <CLI/CLI.hpp>

#include "tests/bench/tables.h"

// Measures speed against error and writes tables; report.py makes the report of them.

namespace {

using namespace weft::bench;

struct Options {
  std::string out, commit = "unknown", meshes;
  std::vector<std::string> parts, scenes, fabrics;
  std::vector<int> sizes = {32, 64, 128, 256};
  Effort effort;
};

bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// Above so many particles a side only the swings of cotton are measured, unless scenes are named.
constexpr int kDear = 129;

bool left_out(const Options& options, const std::string& scene, const std::string& fabric, int n) {
  if (n < kDear || !options.scenes.empty()) return false;
  return scene.rfind("swing", 0) != 0 || fabric != "cotton";
}

/// Measures the cases with more or fewer particles a side than a bound.
/// @param before  by scene and fabric, the case with the most particles that was measured so far
void measure_sizes(const Options& options, int from, int to, Tables& tables,
                   std::map<std::string, CaseResult>& before) {
  for (const BenchScene& scene : bench_scenes()) {
    if (!wanted(options.scenes, scene.name)) continue;
    for (const BenchFabric& fabric : bench_fabrics()) {
      if (!wanted(options.fabrics, fabric.name)) continue;
      for (const int n : options.sizes) {
        if (n < from || n >= to || left_out(options, scene.name, fabric.name, n)) continue;
        std::cerr << "bench: " << scene.name << ", " << fabric.name << ", " << n << std::endl;
        CaseResult result = run_case(scene, fabric, n, options.effort);
        tables.add_case(result);
        CaseResult& coarse = before[std::string(scene.name) + " " + fabric.name];
        if (2 * coarse.n == n) tables.add_spatial(coarse, result);
        coarse = std::move(result);
      }
    }
  }
}

/// The dearest cases last, so that a run that is cut has all others.
void measure_accuracy(const Options& options, Tables& tables) {
  std::map<std::string, CaseResult> before;
  measure_sizes(options, 0, kDear, tables, before);
  measure_sizes(options, kDear, std::numeric_limits<int>::max(), tables, before);
}

int measure(const Options& options) {
  std::filesystem::create_directories(options.out);
  Tables tables(options.out, options.commit);
  const std::string load = load_average();
  const bool accuracy = wanted(options.parts, "accuracy");
  if (accuracy) tables.write_machine(load, 0);
  const bool quick = options.effort.quick;
  if (wanted(options.parts, "kernels")) {
    std::cerr << "bench: kernels" << std::endl;
    tables.write_kernels(measure_kernels(quick));
  }
  if (wanted(options.parts, "parts")) {
    std::cerr << "bench: parts of the built-in scenes" << std::endl;
    tables.write_parts(measure_parts(quick, options.meshes));
  }
  if (wanted(options.parts, "real-time")) {
    std::cerr << "bench: what runs in real time" << std::endl;
    tables.write_real_time(measure_real_time(quick, options.effort.timed_runs, options.meshes));
  }
  if (wanted(options.parts, "threads")) {
    std::cerr << "bench: threads" << std::endl;
    tables.write_threads(measure_threads(quick, options.meshes));
  }
  if (wanted(options.parts, "shaking")) {
    std::cerr << "bench: hard shaking" << std::endl;
    tables.write_shaking(measure_shaking(quick));
  }
  if (wanted(options.parts, "contact-cases"))
    tables.write_contact_cases(measure_contact_cases(quick));
  if (wanted(options.parts, "contact")) tables.write_contact(measure_contact_speed(quick));
  if (!accuracy) return 0;
  measure_accuracy(options, tables);
  tables.write_machine(load, cpu_seconds());
  return 0;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Measures speed against error of Weft's solvers, in CPU time of one thread");
  app.add_option("--out", options.out, "directory for the tables");
  bool list = false;
  app.add_flag("--list-settings", list, "print all settings of the accuracy, one a line");
  int fewest = 1;
  app.add_option("--fewest", fewest, "with --list-settings: substeps a tick that bending asks for")
      ->check(CLI::Range(1, 100000));
  app.add_option("--commit", options.commit, "written into each row");
  app.add_option("--meshes", options.meshes, "directory of installed meshes");
  app.add_option("--parts", options.parts,
                 "kernels, parts, real-time, threads, shaking, contact-cases, contact, accuracy; "
                 "default: all");
  app.add_option("--scenes", options.scenes, "of the accuracy; default: all");
  app.add_option("--fabrics", options.fabrics, "soft, stiff, cotton; default: all");
  app.add_option("--sizes", options.sizes, "particles a side, ascending");
  app.add_option("--runs", options.effort.timed_runs, "runs whose median is taken")
      ->check(CLI::Range(1, 99));
  app.add_option("--budget", options.effort.budget_factor, "times the CPU budget of each cell")
      ->check(CLI::Range(0.0, 1e3));
  const std::map<std::string, ReferenceMethod> methods = {
      {"cheapest", ReferenceMethod::cheapest_that_fits},
      {"runge-kutta", ReferenceMethod::runge_kutta},
      {"extrapolation", ReferenceMethod::extrapolation}};
  app.add_option("--reference", options.effort.reference, "method of the references")
      ->transform(CLI::CheckedTransformer(methods));
  app.add_flag("--quick", options.effort.quick, "fewer settings, shorter runs");
  CLI11_PARSE(app, argc, argv);
  if (list) {
    for (const Setting& s : settings(options.effort.quick, fewest))
      std::cout << s.solver << ' ' << s.name << '\n';
    return 0;
  }
  if (options.out.empty()) throw std::runtime_error("--out is missing");
  return measure(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "weft_bench: " << error.what() << std::endl;
    return 1;
  }
}
