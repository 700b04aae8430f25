#pragma once

#include <string>
#include <utility>
#include <vector>

namespace weft::server {

/// What `weft simulate` can be told.
struct SimulateOptions {
  std::string scene = "default";
  int ticks = 600;                                            ///< 1 to 10,000,000
  std::vector<std::pair<std::string, std::string>> settings;  ///< `--set`, in order
  std::string out;    ///< file for the cloth at the end, .obj or .ply; empty: none
  bool json = false;  ///< summary as one JSON object instead of a table
  int threads = 1;    ///< 1 to 64
};

/// Runs a scene without a clock and prints a summary.
/// @return exit code
/// Throws OptionError or DefinitionError if something cannot be accepted.
int simulate(const SimulateOptions& options);

/// Prints the built-in scenes.
int list_scenes(bool json);

}  // namespace weft::server
