#pragma once

#include <cassert>
#include <vector>

#include "core/solver/implicit/grid_transfer.h"
#include "core/solver/implicit/spring_grid.h"

// Multigrid preconditioner of regular grids.

namespace weft {

/// Approximate inverse of a grid's matrix, symmetric and positive definite: one V-cycle over levels
/// of every second particle, with one damped block Jacobi sweep before and one after. Any number of
/// rows and columns; grid_transfer.h describes the transfers. Bending is included on the levels
/// where it is not small against inertia.
template <class Real>
class Multigrid {
 public:
  /// Sizes all levels for a grid of at least 2 x 2 particles.
  void prepare(const GridLayout& finest, const QuadraticBending<Real>& bending,
               const GridCells& cells);

  /// The finest level, for the caller to fill; `coarsen` computes its `inverse` and all coarser
  /// levels.
  SpringGrid<Real>& finest() {
    assert(!levels_.empty() && "prepare comes first");
    return levels_.front().grid;
  }
  const SpringGrid<Real>& finest() const {
    assert(!levels_.empty() && "prepare comes first");
    return levels_.front().grid;
  }
  std::size_t level_count() const { return levels_.size(); }

  /// Call after the finest level has changed. Pinned particles are heavy on coarser levels.
  void coarsen();

  /// z approximates A^-1 r. Both in the finest level's layout, zero where pinned and around the
  /// grid.
  void precondition(const Real* r, Real* z);

 private:
  struct Level {
    SpringGrid<Real> grid;
    Real strongest_bending = 0;      ///< largest of its bending bounds [N/m]
    GridVector<Real> residual, sum;  ///< of this level
    GridVector<Real> product;        ///< A times sum
  };

  void cycle(std::size_t number, const Real* r, Real* z);

  std::vector<Level> levels_;
  TransferLines<Real> lines_;
  AlignedVector<Real> weighted_;  ///< a plane, with pinned particles heavy
};

}  // namespace weft
