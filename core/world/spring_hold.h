#pragma once

#include <string>
#include <vector>

#include "core/world/constants.h"
#include "core/world/world.h"

// Cloths that relaxation cannot hold with the substeps that it has.

namespace weft {

/// A cloth whose springs the solver `relaxation` cannot hold under its own weight: it sags, and
/// contact of cloth with cloth then has to treat a net that is repeatedly pulled through itself.
struct SlackSprings {
  std::string cloth;
  double strain = 0;      ///< by gravity alone in a hanging cloth
  int substeps = 0;       ///< per tick
  int sweeps = 0;         ///< per substep
  int needed = 0;         ///< substeps that limit the strain to kMostHangingStrain
  int needed_sweeps = 0;  ///< in each of those
};

/// Strain of a hanging net of `rows` springs of length `h` [m] under relaxation, in excess of that
/// of its fabric. Each substep adds g dt^2 to every particle, and a sweep passes on about a third
/// of the difference between neighbours: the top keeps 3 rows g dt^2 / (h sweeps), within a factor
/// of 2 up to kMostHangingStrain (measured with 25 to 65 rows).
/// @param dt  substep [s]
double strain_of_hanging(double rows, double h, double gravity, double dt, int sweeps);

/// The cloths of a world at its start that relaxation cannot hold in contact of cloth with cloth;
/// none with another solver or without such contact. Rigid springs that are swept only once per
/// substep are not held by any number of substeps.
template <class Real>
std::vector<SlackSprings> slack_springs(const World<Real>& world);

/// A sentence for people, with the substeps that it needs.
std::string describe(const SlackSprings& slack);

}  // namespace weft
