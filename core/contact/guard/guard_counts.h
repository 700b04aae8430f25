#pragma once

#include <cstdint>

// What the guard has done.

namespace weft {

/// Work and losses since the guard was built; sums of lengths of single particles' displacements.
struct GuardCounts {
  double wanted = 0;              ///< displacement that particles in pairs wanted [m]
  double truncated = 0;           ///< part of it that was not allowed [m]
  std::uint64_t collections = 0;  ///< of all pairs
  std::uint64_t renewals = 0;     ///< of the pairs of some particles
  std::uint64_t anchored = 0, critical = 0;
  std::uint64_t quiet = 0;  ///< steps that one bound for all particles certified
  std::uint64_t calm = 0;   ///< steps along calm paths, in which no particle was examined
};

}  // namespace weft
