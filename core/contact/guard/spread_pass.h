#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/quad.h"

// Whether a rectangle of a grid, and which of its cells, are stretched out in a plane, so that they
// cannot touch each other.

namespace weft {

/// A rectangle of cells. Each is two triangles with one side along a row and one along a column.
template <class Real>
struct SpreadPass {
  const Quad<Real>* x = nullptr;  ///< the particle at its first row and column [m]
  std::ptrdiff_t particles = 0;   ///< of a whole row of the grid
  /// Of its first cell and on: 1 where the diagonal goes from the first corner to the last, so that
  /// the first side along a row is in a triangle with the second along a column; 0 otherwise.
  const Real* falls = nullptr;
  std::ptrdiff_t cells = 0;  ///< of a whole row of the grid
  int rows = 0, columns = 0;
  /// Of each spatial component k: that of the plane's two directions over the width of a cell, and
  /// over its height [1/m].
  std::array<std::array<Real, 4>, 3> axes = {};
  Real least = 0;  ///< eigenvalue
};

/// Whether the least eigenvalue of the symmetric part of the gradient in a plane is above `least`
/// all over a rectangle.
template <class Real>
bool is_spread(const SpreadPass<Real>& pass);

/// A rectangle that is asked for its cells has at most this many rows and columns.
inline constexpr int kMostSpreadCells = 8;

/// In which cells of a rectangle it is above `least`: of cell (r, c) bit
/// kMostSpreadCells r + c.
template <class Real>
std::uint64_t spread_cells(const SpreadPass<Real>& pass);

}  // namespace weft
