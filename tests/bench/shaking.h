#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// What a solver makes of a disturbance: the worst of several seeds, where dice are thrown.
struct ShakingFigure {
  std::string solver, fabric, disturbance;
  int substeps = 0, sweeps = 0;  ///< a tick, as they ran; sweeps a substep
  double rigidity = 0;           ///< of bending, B [N m]
  int n = 0;
  int seeds = 0;
  double from_rest = 0;  ///< 5 s later with damping 5/s: rms distance from its own rest, over 1 m
  int back = 0;          ///< of the seeds, those within 1 %
  /// In 5 s without damping, and during the disturbance: most above the start and the disturbance's
  /// work, over these two less the energy of the rest.
  double gained_energy = 0;
  int bounded = 0;  ///< of the seeds, those below 1 %
  int rescues = 0;  ///< ticks that were taken back, in all runs
};

/// Hangs the test cloths by one edge and disturbs them: velocities of 20 m/s, all particles in a
/// ball of 1 mm, a pin teleported by 3 m and back. With a rigidity for which a flat sheet is the
/// only rest, and, of the smaller cloths, with that of the other scenes.
std::vector<ShakingFigure> measure_shaking(bool quick);

}  // namespace weft::bench
