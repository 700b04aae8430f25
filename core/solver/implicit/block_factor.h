#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/solver/implicit/dissection.h"
#include "core/types.h"

// Sparse factorisation of a symmetric matrix of 3 x 3 blocks.

namespace weft {

/// The factors U D^-1 U^T of a symmetric positive definite matrix of 3 x 3 blocks, U lower
/// triangular with diagonal D, column by column ("left-looking"; Davis 2006, chapter 4). Double
/// precision, because assembled blocks hold the stiffness of threads beside that of bends, a
/// million times smaller.
class BlockFactor {
 public:
  using Block = Eigen::Matrix<double, 3, 3>;

  /// Where a block of the matrix is, and whether its transpose is.
  struct Slot {
    std::size_t at = 0;
    bool transposed = false;
  };

  /// Finds the places of all blocks.
  /// @returns whether a factorisation takes at most `most_products`; nothing is kept otherwise
  bool prepare(const CouplingLists& coupled, const Vec3Array<double>& places,
               std::size_t most_products);

  bool empty() const { return columns_.empty(); }
  /// Whether solving with old factors this often has taken as long as new ones would.
  bool is_worn(std::size_t uses) const { return uses * rows_.size() > products_; }

  /// Place of the block in row i and column j, i not j, which are coupled.
  Slot slot(Index i, Index j) const;

  /// Begins a new matrix, of zeros.
  void clear();
  void add(const Slot& slot, const Block& block) {
    if (slot.transposed)
      lower_[slot.at] += block.transpose();
    else
      lower_[slot.at] += block;
  }
  /// Adds to the diagonal block of a particle.
  void add_own(Index i, const Block& block) {
    diagonal_[position_[static_cast<std::size_t>(i)]] += block;
  }

  /// Replaces the matrix by its factors.
  /// @returns whether it is positive definite
  bool factor();

  /// z = A^-1 r, three numbers a particle.
  template <class Real>
  void solve(const Real* r, Real* z);

 private:
  void update(std::size_t column, std::size_t from);

  std::vector<Index> columns_;         ///< particles in the order of their elimination
  std::vector<std::size_t> position_;  ///< of each particle in it
  std::vector<std::size_t> begin_;     ///< of each column, and the end of the last one
  std::vector<std::size_t> rows_;      ///< of the blocks of a column, ascending
  std::vector<Block> lower_, diagonal_, inverse_;
  std::size_t products_ = 0;

  std::vector<Block> sum_;                    ///< of a column in work, by row
  std::vector<std::size_t> next_, of_, top_;  ///< columns that next act on a row, as lists
  std::vector<Eigen::Vector3d> solution_;
};

}  // namespace weft
