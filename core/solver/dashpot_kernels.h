#pragma once

#include <cstddef>

#include "core/math/quad.h"
#include "core/solver/dashpot_groups.h"

// Passes over groups of damped stencils, in vector code with the same bits on any processor.

namespace weft {

/// Consecutive batches of a family.
struct DashpotRun {
  std::size_t first, end;
  bool inside;  ///< all of their particles are in the range that is given something
};

/// Finds the geometry of some batches. With N the normal of the lines e and f, a curvature changes
/// with that of e x f across itself, over the length of that. Crumpled cloth, whose normal turns
/// faster than it bends, is not damped.
/// @param x  positions of all particles [m]
template <class Real>
void aim_dashpots(const DashpotRun& run, const Quad<Real>* x, DashpotFamily<Real>& family);

/// Adds K v, the forces against the rates of change of some batches' curvatures, to `product` at
/// the particles from `first` up to `end`.
/// @param v        velocities of all particles [m/s]
/// @param product  of all particles [N]
template <class Real>
void multiply_dashpots(const DashpotRun& run, const Quad<Real>* v, std::size_t first,
                       std::size_t end, DashpotFamily<Real>& family, Quad<Real>* product);

}  // namespace weft
