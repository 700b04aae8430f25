#pragma once

#include <cassert>
#include <vector>

#include "core/cloth/cloth_model.h"

// Stencils of the quadratic bending form.

namespace weft {

// Shares of springs and stencils in grids with missing cells: each cell beside a line stands for
// half.

/// Share of the spring along u from (r, c) to (r, c + 1).
inline double share_along(const GridCells& g, int r, int c) {
  return 0.5 * (g.has_cell(r - 1, c) + g.has_cell(r, c));
}

/// Share of the spring along v from (r, c) to (r + 1, c).
inline double share_down(const GridCells& g, int r, int c) {
  return 0.5 * (g.has_cell(r, c - 1) + g.has_cell(r, c));
}

/// Share of the second difference along u centred at (r, c), with the factor of a clamp there.
inline double share_bend_u(const GridCells& g, int r, int c) {
  const double half = 0.5 * ((g.has_cell(r - 1, c - 1) && g.has_cell(r - 1, c)) +
                             (g.has_cell(r, c - 1) && g.has_cell(r, c)));
  return half > 0 ? half * g.stiffening_along_u(r, c) : 0;
}

/// Share of the second difference along v centred at (r, c), with the factor of a clamp there.
inline double share_bend_v(const GridCells& g, int r, int c) {
  const double half = 0.5 * ((g.has_cell(r - 1, c - 1) && g.has_cell(r, c - 1)) +
                             (g.has_cell(r - 1, c) && g.has_cell(r, c)));
  return half > 0 ? half * g.stiffening_along_v(r, c) : 0;
}

/// What a particle of a line has a part in: second differences 1 -2 1 centred at itself and its
/// neighbours, and cells.
template <class Real>
struct BendingRow {
  Real before = 0, here = 0, behind = 0;  ///< factors of the differences; 0: there is none
  Real cell_before = 0, cell_behind = 0;  ///< 1 if there is such a cell, else 0
  Real cells() const { return cell_before + cell_behind; }
};

/// @param count       of particles
/// @param stiffening  factors of the differences centred at each particle; empty: 1
template <class Real>
BendingRow<Real> bending_row(int k, int count, const std::vector<double>& stiffening) {
  assert(k >= 0 && k < count);
  assert(stiffening.empty() || stiffening.size() == static_cast<std::size_t>(count));
  const auto inner = [&](int n) {
    if (n <= 0 || n + 1 >= count) return 0.0;
    return stiffening.empty() ? 1.0 : stiffening[static_cast<std::size_t>(n)];
  };
  BendingRow<Real> row;
  row.before = static_cast<Real>(inner(k - 1));
  row.here = static_cast<Real>(inner(k));
  row.behind = static_cast<Real>(inner(k + 1));
  row.cell_before = k > 0 ? Real(1) : Real(0);
  row.cell_behind = k + 1 < count ? Real(1) : Real(0);
  return row;
}

/// Calls visit(stiffness, particle indices, weights, corners) for every stencil w of a part's
/// quadratic bending form, whose energy is stiffness/2 |sum_k w_k x_k|^2. A grid has 1 -2 1 along
/// each row and column (half on lines with a cell on one side only), and 1 -1 -1 1 over the corners
/// of each cell; a mesh has 1 -1 along each of its links, with a stiffness of either sign.
template <class Real, class Visitor>
void visit_bending_stencils(const ClothPart<Real>& part, Visitor&& visit) {
  static constexpr double kLink[] = {1, -1}, kLine[] = {1, -2, 1}, kTwist[] = {1, -1, -1, 1};
  const QuadraticBending<Real>& q = part.quadratic_bending;
  const GridCells& g = part.cells;
  assert(g.particles.size() ==
         static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns));
  const auto particle = [&](int r, int c) { return part.particles.first + g.particle(r, c); };
  for (const BendingLink& link : part.bending_links) {
    const Index ends[] = {part.particles.first + link.i, part.particles.first + link.j};
    visit(link.weight, ends, kLink, 2);
  }
  for (int r = 0; r < g.rows; ++r) {
    for (int c = 0; c < g.columns; ++c) {
      if (const double share = share_bend_u(g, r, c); share > 0) {
        const Index corners[] = {particle(r, c - 1), particle(r, c), particle(r, c + 1)};
        visit(static_cast<double>(q.along_u * static_cast<Real>(share)), corners, kLine, 3);
      }
      if (const double share = share_bend_v(g, r, c); share > 0) {
        const Index corners[] = {particle(r - 1, c), particle(r, c), particle(r + 1, c)};
        visit(static_cast<double>(q.along_v * static_cast<Real>(share)), corners, kLine, 3);
      }
      if (g.has_cell(r, c)) {
        const Index corners[] = {particle(r, c), particle(r, c + 1), particle(r + 1, c),
                                 particle(r + 1, c + 1)};
        visit(static_cast<double>(q.twist), corners, kTwist, 4);
      }
    }
  }
}

}  // namespace weft
