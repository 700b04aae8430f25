#pragma once

#include <vector>

#include "core/solver/implicit/spring_grid.h"

namespace weft {

/// Approximate inverse of a grid's matrix, symmetric and positive definite: one V-cycle over levels
/// of every second particle, with one damped block Jacobi sweep before and one after (NUMERICS.md
/// b). Coarse springs are the fine ones they lie on, so that what is compressed in wrinkles does
/// not make the coarse cloth soft. Any number of rows and columns: where a line of cells is odd,
/// the last coarse cell is as short as a fine one. Bending stays on the finest level.
template <class Real>
class Multigrid {
 public:
  /// Sizes all levels for a grid of at least 2 x 2 particles.
  void prepare(const GridLayout& finest);

  /// The finest level, to be filled; its `inverse` and all coarser levels come from `coarsen`.
  SpringGrid<Real>& finest() { return levels_.front().grid; }
  const SpringGrid<Real>& finest() const { return levels_.front().grid; }
  std::size_t level_count() const { return levels_.size(); }

  /// After the finest level has changed. Pinned particles have a great mass below it.
  void coarsen();

  /// z = about A^-1 r. Both of the finest level's layout, zero where pinned and around the grid.
  void precondition(const Real* r, Real* z);

 private:
  /// Lines of a level along one direction, and those of the level below it that stay.
  struct Lines {
    std::vector<int> kept;            ///< of each coarse line, its fine one
    std::vector<int> first, second;   ///< of each fine line, the coarse ones about it
    std::vector<Real> share, other;   ///< and their weights, sum 1
    std::vector<Real> before, after;  ///< of each coarse line, the weights of its fine neighbours
  };
  struct Level {
    SpringGrid<Real> grid;
    Lines rows, columns;             ///< to the next coarser level
    GridVector<Real> residual, sum;  ///< of this level
    GridVector<Real> product;        ///< A times sum
  };

  static Lines lines(int count);
  static void coarsen_springs(const Level& fine, SpringGrid<Real>& coarse);
  static void restrict_plane(const Level& fine, const GridLayout& coarse, const Real* from,
                             Real* to, std::vector<Real>& line);
  void cycle(std::size_t level, const Real* r, Real* z);
  void add_prolonged(const Level& fine, const GridLayout& coarse, const Real* from, Real* to);

  std::vector<Level> levels_;
  std::vector<Real> line_;        ///< of the finest level's columns
  AlignedVector<Real> weighted_;  ///< own blocks, with pinned particles heavy
};

}  // namespace weft
