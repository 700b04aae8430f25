#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// What a solver makes of an insult.
struct ShakingFigure {
  std::string solver, setting, fabric, insult;
  int n = 0;
  double from_rest = 0;      ///< 5 s later with drag 5/s: rms distance from its own rest, over 1 m
  double gained_energy = 0;  ///< without drag: most above its start, over start minus rest
  int rescues = 0;           ///< ticks that were taken back, in both runs
};

/// Hangs the test cloths by one edge and hurts them: random velocities of 20 m/s, all particles in
/// a ball of 1 mm, a pin teleported by 3 m and back.
std::vector<ShakingFigure> measure_shaking(bool quick);

}  // namespace weft::bench
