#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/math/aligned_vector.h"
#include "core/solver/implicit/bending_line.h"

// The matrix of one grid level, and operations on its vectors.

namespace weft {

/// Zeros around each row of a level, not less than the widest vector, in numbers.
inline constexpr std::ptrdiff_t kGridMargin = 16;

/// A vector of a level: three planes of numbers, each in the level's layout.
template <class Real>
using GridVector = AlignedVector<Real>;

/// Layout of a level's numbers: particle (r, c) of a plane is at origin + r * stride + c. Two rows
/// of zeros precede and follow them, and at least kGridMargin + 2 zeros end each row.
struct GridLayout {
  int rows = 0, columns = 0;
  std::ptrdiff_t stride = 0, plane = 0, origin = 0;

  GridLayout() = default;
  GridLayout(int row_count, int column_count);
  std::size_t size() const { return 3 * static_cast<std::size_t>(plane); }
  std::ptrdiff_t at(int r, int c) const { return origin + r * stride + c; }
};

/// The four kinds of springs of a grid, by the cell (r, c) where they begin: along to (r, c + 1),
/// down to (r + 1, c), falling to (r + 1, c + 1), and rising, which joins (r, c + 1) with (r + 1,
/// c).
enum GridSpring { kAlong, kDown, kFalling, kRising };

/// The symmetric positive semidefinite matrix of one level of a grid: a symmetric 3 x 3 block for
/// each particle, and one for each spring that acts on the difference of its ends. Blocks are
/// planes of numbers xx xy xz yy yz zz.
template <class Real>
struct SpringGrid {
  GridLayout layout;
  /// By GridSpring [N/m]. On the finest level a block is a I + s s^T, and stored as s and a,
  /// because memory traffic bounds the speed of the product.
  std::array<std::array<AlignedVector<Real>, 6>, 4> springs;
  bool factored = false;                       ///< springs are stored that way
  AlignedVector<Real> inertia;                 ///< of each particle, times the unit matrix [N/m]
  std::array<AlignedVector<Real>, 6> air;      ///< of each particle, if there is air [N/m]
  bool has_air = false;                        ///< whether `air` is used
  std::array<AlignedVector<Real>, 6> inverse;  ///< of the diagonal blocks; 0 where pinned [m/N]
  AlignedVector<Real> free;                    ///< 1; 0 if pinned and around the grid

  // Bending, as a constant matrix (QuadraticBending).
  QuadraticBending<Real> bending;
  bool bending_counts = false;  ///< otherwise it is left out
  /// Per column the nine numbers of its BendingLine, in lines `stride` + 3 kGridMargin apart; each
  /// begins with a margin and is surrounded by zeros.
  AlignedVector<Real> column_bending;
  std::vector<BendingLine<Real>> row_bending;
  AlignedVector<Real> bending_bound;  ///< see `invert_diagonal`

  bool bends() const { return bending_counts; }
  std::ptrdiff_t bending_pitch() const { return layout.stride + 3 * kGridMargin; }

  /// Sizes all arrays and fills them with zeros; all particles are free and nothing bends.
  void prepare(const GridLayout& shape, bool is_factored);

  /// Sets the bending and includes it from then on.
  /// @param form             of the finest level
  /// @param cells            with its factors on the finest level, where they count; coarser ones,
  ///                         which only precondition it, go without
  /// @param rows_at, columns_at, unit  see bending_lines
  void set_bending(const QuadraticBending<Real>& form, const GridCells& cells,
                   const std::vector<int>& rows_at, const std::vector<int>& columns_at, int unit);
};

/// y = A p. Pinned particles get 0.
template <class Real>
void multiply(const SpringGrid<Real>& grid, const Real* p, Real* y);

/// z = omega D^-1 r with D the diagonal blocks.
template <class Real>
void smooth_from_zero(const SpringGrid<Real>& grid, Real omega, const Real* r, Real* z);

/// z += omega D^-1 (r - y), where y = A z.
template <class Real>
void smooth(const SpringGrid<Real>& grid, Real omega, const Real* r, const Real* y, Real* z);

/// Sum of a[k] b[k], in the same order on all instruction sets.
/// @param count  a multiple of kGridMargin
template <class Real>
double dot(const Real* a, const Real* b, std::size_t count);

/// y += s a.
/// @param count  likewise
template <class Real>
void add_scaled(Real s, const Real* a, Real* y, std::size_t count);

/// y = a + s y.
template <class Real>
void scale_and_add(Real s, const Real* a, Real* y, std::size_t count);

/// Inverts the diagonal blocks: each particle's own block, those of its springs, and half the sum
/// of the absolute values of its row of the bending matrix, so that no eigenvalue of D^-1 A exceeds
/// 2 (for springs and rows alike 2 D - A is a sum of squares).
template <class Real>
void invert_diagonal(SpringGrid<Real>& grid);

/// Inverse of a symmetric matrix, both as xx xy xz yy yz zz; zeros if it is singular.
template <class Real>
std::array<Real, 6> inverse_of(const std::array<Real, 6>& a);

}  // namespace weft
