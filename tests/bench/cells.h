#pragma once

#include <string>
#include <vector>

#include "tests/bench/reference.h"

namespace weft::bench {

enum class Outcome { ran, failed, not_run };

/// One point of the report: a case, a solver's setting, what it costs and how wrong it is.
struct Cell {
  std::string scene, fabric;
  int n = 0;
  Setting setting;
  Outcome outcome = Outcome::not_run;
  std::string reason;         ///< why it failed or was not run
  int substeps = 0;           ///< a tick
  double cpu_per_second = 0;  ///< CPU seconds a simulated second, median of the runs
  int timed_runs = 0;
  ErrorVector error;
};

/// A case: its reference and its cells.
struct CaseResult {
  const BenchScene* scene = nullptr;
  std::string fabric;
  int n = 0;
  WorldDef def;
  Reference reference;
  std::vector<Cell> cells;
};

/// How much is measured.
struct Effort {
  bool quick = false;  ///< fewer settings
  int timed_runs = 3;
  double timed_seconds = 0.05;  ///< CPU seconds of one timed run where each tick costs the same
  double budget_factor = 1;     ///< of the scenes' budgets
  ReferenceMethod reference = ReferenceMethod::cheapest_that_fits;
};

/// Runs all settings of a case, each once against the reference, and then times them in turn.
/// Runs that blow up are recorded as failed, those above the budget as not run.
CaseResult run_case(const BenchScene& scene, const BenchFabric& fabric, int n,
                    const Effort& effort);

}  // namespace weft::bench
