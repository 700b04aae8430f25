#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// What the dearest second of a case costs, and who takes it. All times are CPU seconds of one
/// thread a simulated second where nothing else is said.
struct RealTimeFigure {
  std::string name;
  std::string kind;           ///< "scene", "hard case" or "cotton"
  int seconds_looked_at = 0;  ///< of the beginning, among which the dearest one is
  double dearest = 0;         ///< median of the runs
  /// Shares of that second: springs, bending and integration; air; all contact; the rest.
  double springs = 0, air = 0, contact = 0, other = 0;
  int substeps = 0;     ///< the most that a tick took
  double twice = 0;     ///< the dearest second with at least twice these substeps; 0: not measured
  double wall_two = 0;  ///< seconds by the clock of it on two threads; 0: not measured
  double implicit = 0;  ///< the dearest second with the solver implicit; 0: not measured
  int runs = 0;         ///< interleaved ones, of which `dearest` and `wall_two` are medians
};

/// Runs every built-in scene that verlet moves, hard cases too, and a square metre of cotton of
/// 128 x 128 particles in the scenes of the accuracy, for the same time and on one thread. What
/// takes more than 0.7 of real time is run again, and on two threads, and once with twice the
/// substeps and once with the solver implicit.
/// @param quick  the first second of a few of them, once
/// @param runs   at most
/// @param mesh_directory  of installed meshes; scenes whose mesh is missing are left out
std::vector<RealTimeFigure> measure_real_time(bool quick, int runs,
                                              const std::string& mesh_directory);

}  // namespace weft::bench
