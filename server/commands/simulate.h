#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/options.h"

namespace weft::server {

/// All options of `weft simulate`.
struct SimulateOptions {
  std::string scene = "default";  ///< a name, or a file that ends in .json
  std::string scenes;             ///< directory with further scenes and meshes; empty: none
  int ticks = 600;                ///< 1 to 10,000,000
  std::vector<std::pair<std::string, std::string>> settings;  ///< `--set`, in order
  std::string out;         ///< file for the cloth at the end, .obj or .ply; empty: none
  std::string start;       ///< .npy file with where particles begin (start_file.h); empty: none
  std::string series;      ///< .npy file for what happens (series.h); empty: none
  int series_every = 1;    ///< ticks between two of its records, 1 to 10,000,000
  bool balance = false;    ///< measures the work of all that acts; a run then takes longer
  bool error = false;      ///< repeats the run beside itself and tells its error (run_error.h)
  bool in_double = false;  ///< the state and all that follows from it in double precision
  bool json = false;       ///< summary as one JSON object instead of a table
  int threads = 1;         ///< 1 to 64
  /// Crossings and penetrations are checked every so many ticks, and after the last, 1 to
  /// 10,000,000. The times exclude the checks, but a check evicts the next step's data from the
  /// caches.
  int check_every = 1;
  double tick_limit = kUsualTickLimit;  ///< of CPU for a tick, 0 to 3600 [s]; 0: no bound
  bool any_cost = false;                ///< takes scenes whatever a tick is estimated to cost
};

/// Runs a scene without a clock and prints a summary.
/// @return exit code: 3 if anything crossed after the scene's grace time (its verdict's
///         `clear_after`), other than cloth that started so and was led out, 4 if a tick exceeded
///         its limit and was given up; both are reported on standard error too; else 0
/// Throws OptionError or DefinitionError if an input is invalid or too costly, OutputError if the
/// file cannot be written.
int simulate(const SimulateOptions& options);

}  // namespace weft::server
