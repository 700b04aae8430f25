#pragma once

#include "core/cloth/cloth_model.h"
#include "core/solver/verlet.h"

// When the dashpots of bending act in a tick.

namespace weft {

/// The passes of a tick. What goes through zero at each pass is never damped. So passes follow each
/// other faster than the bending of the mesh can swing, or, where it swings faster than is worth
/// following, in groups of three uneven parts, so that no swing meets all of them at one phase.
struct DashpotPasses {
  int count = 1;
  bool even = true;  ///< else in groups of three

  DashpotPasses times(int factor) const { return {count * factor, even}; }
};

/// What a part needs.
/// @param seconds  of the tick
template <class Real>
DashpotPasses dashpot_passes(const ClothPart<Real>& part, double seconds);

/// The substeps from the end of `range` to the end of the next pass. Where there are fewer substeps
/// than passes, some passes are one.
SubstepRange next_range(const SubstepRange& range, const DashpotPasses& passes);

/// The longest time between two passes over that of the tick [1].
double longest_share(const DashpotPasses& passes);

}  // namespace weft
