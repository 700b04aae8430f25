#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/options.h"

// `weft drape`: what the drape test predicts of a fabric, as a mean over starts and specimens.

namespace weft::server {

inline constexpr OptionRange kDrapeStarts{2, 100};
inline constexpr OptionRange kDrapeSeconds{0.1, 60};  // [s]

/// All options of `weft drape`.
struct DrapeOptions {
  std::string fabric = "cotton";                              ///< name of a preset
  std::vector<std::pair<std::string, std::string>> settings;  ///< `--set`, of the fabric
  int starts = 5;      ///< of each specimen, each with its own noise
  double seconds = 4;  ///< simulated [s]
  int threads = 1;     ///< each runs tests of its own
  bool json = false;
};

/// Runs the drape test on grids of 41, 61 and 81 particles a side and on a mesh of rings, from
/// several starts each, and prints mean, standard error and folds of each specimen and of all.
/// Folds fall as they may, and what one run shows is one of several answers.
/// Throws OptionError or DefinitionError.
int predict_drape(const DrapeOptions& options);

}  // namespace weft::server
