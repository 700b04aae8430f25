#pragma once

#include <string>
#include <vector>

#include "core/world/world.h"

namespace weft {

/// Cloth whose springs the solver `relaxation` cannot hold under its own weight: it sags out, and
/// contact of cloth with cloth then meets a net that is drawn through itself again and again.
struct SlackSprings {
  std::string cloth;
  double strain = 0;      ///< that gravity alone brings where the cloth hangs
  int substeps = 0;       ///< of a tick
  int sweeps = 0;         ///< of a substep
  int needed = 0;         ///< substeps that would keep the strain to kMostSlack
  int needed_sweeps = 0;  ///< of each of these
};

/// Strain above which springs count as not held.
inline constexpr double kMostSlack = 0.15;

/// Strain of a hanging net of `rows` springs of length `h` [m] under relaxation, above that of its
/// fabric. Each substep adds g dt^2 to every particle, and a sweep takes about a third of what
/// neighbours differ by on to the next: what is left at the top is 3 rows g dt^2 / (h sweeps),
/// within a factor of 2 up to kMostSlack (measured with 25 to 97 rows). Beyond it the net also
/// begins to bounce, ever higher.
/// @param dt  substep [s]
double strain_of_hanging(double rows, double h, double gravity, double dt, int sweeps);

/// The cloths of a world at its start that relaxation cannot hold beside contact of cloth with
/// cloth; none with another solver or without such contact. Rigid springs that are swept only once
/// a substep, always from the same end, are not held with any number of substeps.
template <class Real>
std::vector<SlackSprings> slack_springs(const World<Real>& world);

/// A sentence for people, with the substeps that it needs.
std::string describe(const SlackSprings& slack);

}  // namespace weft
