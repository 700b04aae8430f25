#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// A built-in scene with one part of its model switched off.
struct PartFigure {
  std::string scene, solver;
  std::string off;  ///< "nothing", "wind", "bending", "contact", ...
  int ticks = 0;
  double cpu_per_second = 0;  ///< CPU seconds a simulated second; median of the runs
  double moved = 0;           ///< rms distance of the particles from the scene as it is [m]
  bool same_bits = false;     ///< the state's hash is that of the scene as it is
  int runs = 0;
};

/// Times every built-in scene with and without each part that it has; but no hard cases.
/// @param quick  once instead of five times, and without the seed's experiments
/// @param mesh_directory  of installed meshes; scenes whose mesh is missing are left out
std::vector<PartFigure> measure_parts(bool quick, const std::string& mesh_directory);

}  // namespace weft::bench
