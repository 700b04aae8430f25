#pragma once

#include <cstddef>

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
/// @param x  positions, four numbers for each particle of the model, laid out as the family reads
///           them [m]
template <class Real>
void aim_dashpots(const DashpotRun& run, const Real* x, DashpotFamily<Real>& family);

/// Adds K v, the forces against the rates of change of some batches' curvatures, to `product` at
/// the particles from `first` up to `end`.
/// @param v        velocities, laid out likewise [m/s]
/// @param product  likewise [N]
template <class Real>
void multiply_dashpots(const DashpotRun& run, const Real* v, std::size_t first, std::size_t end,
                       DashpotFamily<Real>& family, Real* product);

/// Some of the numbers of all vectors.
struct NumberRange {
  std::size_t first, end;
};

/// What the stages of the method work on, number by number, whatever the layout.
template <class Real>
struct StageNumbers {
  const Real *inverse_mass, *start;
  Real *now, *before, *product, *next_change;
};

/// Factors of a stage.
template <class Real>
struct StageFactors {
  Real now, before, product, start;
};

/// The first stage: now = start by_start, and how it changes velocities.
template <class Real>
void open_dashpot_stages(const NumberRange& range, Real by_start, const StageNumbers<Real>& of);

/// A later stage, into `before`; `product` is cleared.
template <class Real>
void advance_dashpot_stage(const NumberRange& range, const StageFactors<Real>& by,
                           const StageNumbers<Real>& of);

}  // namespace weft
