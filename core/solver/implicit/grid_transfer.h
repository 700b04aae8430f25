#pragma once

#include <cassert>

#include "core/math/aligned_vector.h"
#include "core/solver/implicit/spring_grid.h"

// Transfer between the levels of multigrid.

namespace weft {

// Transfer from one level of a grid to the next coarser one and back. In both directions every
// second line of particles is kept, and the last one: if the number of lines is even, the last
// coarse cell is as short as a fine one.

/// Number of kept lines out of `count`.
inline int coarse_count(int count) {
  assert(count >= 2);
  return count / 2 + 1;
}

/// Two rows of numbers with margins, for the functions below.
template <class Real>
struct TransferLines {
  AlignedVector<Real> fine, coarse;

  /// @param finest  the widest level
  void prepare(const GridLayout& finest);
};

/// `to` = sum over the fine particles around each coarse one of bilinear weight times `from`. One
/// plane of numbers, with zeros around the grid.
template <class Real>
void restrict_plane(const GridLayout& fine, const GridLayout& coarse, const Real* from, Real* to,
                    TransferLines<Real>& lines);

/// `to` += bilinear interpolation of `from`, for free particles. One plane of numbers.
/// @param free  of the fine level
template <class Real>
void add_prolonged(const GridLayout& fine, const GridLayout& coarse, const Real* free,
                   const Real* from, Real* to, TransferLines<Real>& lines);

/// Each coarse spring is the sum of the parallel fine ones around it, by their bilinear weight
/// across it and the squared fraction of its length that they cover: springs compressed in wrinkles
/// do not soften the coarse cloth, as springs rebuilt from every second position would.
template <class Real>
void coarsen_springs(const SpringGrid<Real>& fine, SpringGrid<Real>& coarse,
                     TransferLines<Real>& lines);

}  // namespace weft
