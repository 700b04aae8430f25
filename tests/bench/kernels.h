#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// One figure about speed or memory.
struct KernelFigure {
  std::string name, unit;
  double value = 0;
  double bar = 0;  ///< at most this is wanted; 0: no bar
  int runs = 0;    ///< of which the value is the median
};

/// Nanoseconds a particle and substep, whole ticks divided by what they contain: verlet on a grid
/// and on a triangle mesh whose vertices come in random order, XPBD on a grid. Then the
/// bytes a particle that verlet takes on both, and the largest square of particles whose swing
/// needs half of one core at most.
std::vector<KernelFigure> measure_kernels(bool quick);

}  // namespace weft::bench
