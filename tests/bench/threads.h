#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// A scene on one thread and on two.
struct ThreadFigure {
  std::string scene;
  int ticks = 0;
  double offered = 0;     ///< share of the wall time of one thread that runs in chunks
  double wall_one = 0;    ///< of the run, median [s]
  double wall_ratio = 0;  ///< wall time of two threads over that of one, median over pairs of runs
  double cpu_ratio = 0;   ///< likewise of the CPU time of the whole process
  bool same_bits = false;
  int runs = 0;
};

/// Runs some built-in scenes and a large cloth on a sphere on one thread and on two, in turn.
/// Threads wait for each other, so here wall time counts as well; what else runs on the machine
/// makes two look worse than they are.
/// @param mesh_directory  of installed meshes; a scene whose mesh is missing is left out
std::vector<ThreadFigure> measure_threads(bool quick, const std::string& mesh_directory);

}  // namespace weft::bench
