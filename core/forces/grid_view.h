#pragma once

#include <cstddef>

#include "core/cloth/cloth_model.h"
#include "core/forces/cell_misfit.h"

// Layout of the arrays that a grid's kernels work on.

namespace weft {

inline constexpr int kGridLanes = 16;  ///< not less than the widest vector, in numbers

/// One row of a grid: `count` particles from column `column` on, with indices from `particle` on in
/// the arrays of the whole model.
template <class Real>
struct GridRow {
  std::ptrdiff_t column = 0, count = 0, particle = 0;
  const Real* coefficients = nullptr;  ///< kGridCoefficients lines, at column 0
};

/// Lines of coefficients, indexed by the particle where springs and stencils start.
enum GridCoefficient : int {
  kWarp,     ///< stiffness of the spring to (r, c + 1) [N/m]
  kWeft,     ///< of the spring to (r + 1, c) [N/m]
  kShear,    ///< of each diagonal of cell (r, c) [N/m]
  kTwist,    ///< bending: cell difference of cell (r, c) [N/m]
  kBendU,    ///< second difference along u centred at (r, c + 1) [N/m]
  kBendV,    ///< second difference along v centred at (r + 1, c) [N/m]
  kHasCell,  ///< 1 if cell (r, c) exists, else 0
  kGridCoefficients
};

/// The data of a grid's kernels. Each row of the grid has a few lines of `line` numbers, each with
/// one component of all its particles, so that one pointer and the line's length reach everything.
/// Pointers are at (row 0, column 0); two rows of zeros follow the last. Sites without a particle
/// hold zeros.
template <class Real>
struct GridView {
  int rows = 0, columns = 0;
  std::ptrdiff_t line = 0;             ///< numbers per line, at least the columns in whole vectors
  const GridRow<Real>* row = nullptr;  ///< per row
  /// x y z from the origin [m], 1/m [1/kg] (0 where pinned), vx vy vz [m/s], and what drifts lost
  /// of x y z to rounding in this tick [m].
  Real* motion = nullptr;
  /// Near the places when the tick began [m]. Seen from there they change in finer steps than those
  /// of the model's floats: such steps would shake stiff cloth, and what shakes does not stick.
  Real origin[3] = {};
  /// Forces see what drifts lost of the places, too. Stiff cloth that sticks, where hardly anything
  /// moves, would else be shaken by the steps of the places from substep to substep.
  bool fine = false;
  Real* external = nullptr;   ///< forces of air and slings, three lines per row [N]
  Real* wind = nullptr;       ///< velocity of the air, three lines per row [m/s]
  const Real* odd = nullptr;  ///< by column: 1 for odd columns, else 0
  GridSprings<Real> springs;
  MisfitLaw<Real> misfit;
  Real* scratch = nullptr;  ///< kGridScratchLines lines

  std::ptrdiff_t pitch() const { return kMotionLines * line; }
  Real* remainder() const { return motion + kRemainderLine * line; }
  /// Longer, because some stores have an offset.
  std::ptrdiff_t scratch_line() const { return line + kGridLanes; }
  static constexpr int kMotionLines = 10, kInverseMassLine = 3, kVelocityLine = 4,
                       kRemainderLine = 7;
};

/// Lines of scratch: factors of springs, forces for other columns, forces carried to the row below
/// (see grid_step-inl.h), powers per column, stiffness of the cells' twist.
inline constexpr int kPowerLine = 25, kTwistLine = 26, kGridScratchLines = 27;

/// Sum of a pass's values per column, in column order, so that the width of a vector does not
/// matter.
template <class Real>
double sum_of_columns(const GridView<Real>& grid, const Real* values) {
  double sum = 0;
  for (int c = 0; c < grid.columns; ++c) sum += static_cast<double>(values[c]);
  return sum;
}

/// Time step of a grid pass: v <- keep v + scaled_dt (f/m + g), x <- x + dt v (drift-inl.h).
/// Particles without inverse mass get velocity 0.
template <class Real>
struct GridStep {
  Real keep = 0, scaled_dt = 0;  ///< [1], [s]
  Real gravity[3] = {};          ///< [m/s^2]
  Real dt = 0;                   ///< of the drift [s]; 0: none
  bool has_external = false;     ///< add the external forces
};

}  // namespace weft
