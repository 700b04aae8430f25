#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/guard/guard_counts.h"
#include "core/math/quad.h"
#include "core/types.h"

// The step that is being certified.

namespace weft {

/// Where all particles are, certified, and where they want to go in the coming drift.
template <class Real>
struct GuardedStep {
  std::uint64_t number = 0;      ///< counts the steps that were examined
  QuadArray<Real> from;          ///< certified positions, where rows are solved too [m]
  QuadArray<Real> displacement;  ///< wanted in the drift, and allowed where it was truncated [m]
  std::vector<Real> length;      ///< of the displacement, when it was measured [m]
  std::uint64_t measured = 0;    ///< number of the step in which it was
  double lost = 0;               ///< displacement truncated in this step [m]
  double allowed = 0;            ///< and what is left of it, in the last one examined [m]
};

/// Measures how far all want to move, once a step: gaps are shared by what was wanted at first.
template <class Real>
void measure_lengths(GuardedStep<Real>& step);

/// Adds up the displacements of particles in pairs.
/// @param active  these particles
template <class Real>
void count_motion(const std::vector<Index>& active, GuardedStep<Real>& step, GuardCounts& counts);

/// No particle moves, which is always allowed.
/// @param is_active  of each particle 1 if what it loses counts
template <class Real>
void halt(const std::vector<char>& is_active, GuardedStep<Real>& step, Vec3Array<Real>& x,
          Vec3Array<Real>& v);

}  // namespace weft
