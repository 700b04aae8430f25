// Writes down the stiffnesses of a row of a grid.

#include "core/forces/grid_coefficients.h"

#include <algorithm>
#include <limits>

#include "core/cloth/bending_stencil.h"
#include "core/forces/grid_view.h"
#include "core/instantiate.h"

namespace weft {

template <class Real>
std::vector<Real> coefficient_row(const ClothPart<Real>& part, int r, std::ptrdiff_t line) {
  const GridCells& g = part.cells;
  const GridSprings<Real>& springs = *part.grid_springs;
  const QuadraticBending<Real>& bending = part.quadratic_bending;
  std::vector<Real> lines(static_cast<std::size_t>(kGridCoefficients * line), Real(0));
  for (int c = 0; c < g.columns; ++c) {
    const auto set = [&](GridCoefficient k, Real full, double share) {
      lines[static_cast<std::size_t>(k * line + c)] = full * static_cast<Real>(share);
    };
    const double cell = g.has_cell(r, c);
    set(kWarp, springs.warp, share_along(g, r, c));
    set(kWeft, springs.weft, share_down(g, r, c));
    set(kShear, springs.shear, cell);
    set(kTwist, bending.twist, cell);
    set(kBendU, bending.along_u, share_bend_u(g, r, c + 1));
    set(kBendV, bending.along_v, share_bend_v(g, r + 1, c));
    set(kHasCell, Real(1), cell);
  }
  return lines;
}

template <class Real>
double shake_of(const ClothPart<Real>& part) {
  const GridSprings<Real>& springs = *part.grid_springs;
  const auto u = static_cast<double>(springs.rest_warp), v = static_cast<double>(springs.rest_weft);
  const double step = std::max(u * part.columns, v * part.rows) *
                      static_cast<double>(std::numeric_limits<Real>::epsilon());
  const QuadraticBending<Real>& bending = part.quadratic_bending;
  const auto stiffness = static_cast<double>(bending.along_u + bending.along_v + bending.twist);
  return 6 * stiffness * step / (part.fabric.areal_density * u * v);
}

WEFT_INSTANTIATE_FUNCTIONS(coefficient_row, shake_of)

}  // namespace weft
