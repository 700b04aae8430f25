#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/quad.h"
#include "core/types.h"

// The step that is being certified.

namespace weft {

/// Work and losses since the guard was built; sums of lengths of single particles' displacements.
struct GuardCounts {
  double wanted = 0;              ///< displacement that particles in pairs wanted [m]
  double truncated = 0;           ///< part of it that was not allowed [m]
  std::uint64_t collections = 0;  ///< of all pairs
  std::uint64_t renewals = 0;     ///< of the pairs of some particles
  std::uint64_t anchored = 0;     ///< particles
  std::uint64_t critical = 0;     ///< pairs whose step was certified by itself
  std::uint64_t quiet = 0;        ///< steps that one bound for all particles certified
  std::uint64_t calm = 0;         ///< steps along calm paths, in which no particle was examined
};

/// Where all particles are, certified, and where they want to go in the coming drift.
template <class Real>
struct GuardedStep {
  std::uint64_t number = 0;      ///< counts calls of certify
  QuadArray<Real> from;          ///< certified positions, where rows are solved too [m]
  QuadArray<Real> displacement;  ///< wanted in the drift, and allowed where it was truncated [m]
  Quad<Real> common;             ///< displacement of all alike, which what is stopped keeps [m]
  bool is_free = false;          ///< nothing but cloth is near what was stopped, or holds any
  Vec3d mean_velocity = Vec3d::Zero();  ///< of the centre of mass, if it is [m/s]
  double lost = 0;                      ///< displacement truncated in this step [m]
  double allowed = 0;                   ///< and what is left of it, in the last one examined [m]

  /// Where a particle goes that is allowed a fraction of what it wants beyond the common
  /// displacement [m].
  Quad<Real> moved(std::size_t particle, Real fraction) const {
    return common + (displacement[particle] - common) * fraction;
  }
  /// How far it goes at most, whatever the fraction [m].
  Real farthest(std::size_t particle) const {
    const Quad<Real>& own = displacement[particle];
    return std::sqrt(std::max(dot(own, own), dot(common, common)));
  }

  /// Adds up the displacements of particles in pairs.
  /// @param active  these particles
  void count_motion(const std::vector<Index>& active, GuardCounts& counts) {
    allowed = 0;
    for (const Index k : active)
      allowed += static_cast<double>(weft::length(displacement[at_index(k)]));
    counts.truncated += lost;
    counts.wanted += allowed + lost;
    lost = 0;
  }

  /// No particle moves, which is always allowed.
  /// @param is_active  of each particle 1 if what it loses counts
  void halt(const std::vector<char>& is_active, Vec3Array<Real>& x, Vec3Array<Real>& v) {
    assert(x.size() == from.size() && v.size() == x.size());
    for (std::size_t i = 0; i < displacement.size(); ++i) {
      if (is_active[i]) lost += static_cast<double>(weft::length(displacement[i]));
      displacement[i] = {};
      x[i] = to_vector(from[i]);
      v[i].setZero();
    }
  }
};

}  // namespace weft
