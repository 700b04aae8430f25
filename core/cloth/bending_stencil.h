#pragma once

#include <array>
#include <cassert>

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

/// Share of the second difference along u centred at (r, c).
inline double share_bend_u(const GridCells& g, int r, int c) {
  return 0.5 * ((g.has_cell(r - 1, c - 1) && g.has_cell(r - 1, c)) +
                (g.has_cell(r, c - 1) && g.has_cell(r, c)));
}

/// Share of the second difference along v centred at (r, c).
inline double share_bend_v(const GridCells& g, int r, int c) {
  return 0.5 * ((g.has_cell(r - 1, c - 1) && g.has_cell(r, c - 1)) +
                (g.has_cell(r - 1, c) && g.has_cell(r, c)));
}

/// Row `k` of the matrix of second differences 1 -2 1 along `count` particles: the weights of the
/// particle itself, of the previous and of the next one (two away it is 1), and the number of cells
/// that meet there, 1 or 2.
template <class Real>
std::array<Real, 4> bending_line(int k, int count) {
  assert(k >= 0 && k < count);
  const auto inner = [count](int n) { return n > 0 && n + 1 < count ? 1 : 0; };
  const int before = inner(k - 1), here = inner(k), behind = inner(k + 1);
  return {static_cast<Real>(before + 4 * here + behind), static_cast<Real>(-2 * (before + here)),
          static_cast<Real>(-2 * (here + behind)), static_cast<Real>((k > 0) + (k + 1 < count))};
}

/// Calls visit(stiffness, particle indices, weights, corners) for every stencil w of a part's
/// quadratic bending form, whose energy is stiffness/2 |sum_k w_k x_k|^2. A grid has 1 -2 1 along
/// each row and column (half on lines with a cell on one side only), and 1 -1 -1 1 over the corners
/// of each cell; a mesh has one for each inner edge.
template <class Real, class Visitor>
void visit_bending_stencils(const ClothPart<Real>& part, Visitor&& visit) {
  static constexpr double kLine[] = {1, -2, 1}, kTwist[] = {1, -1, -1, 1};
  const QuadraticBending<Real>& q = part.quadratic_bending;
  const GridCells& g = part.cells;
  assert(g.particles.size() ==
         static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns));
  const auto particle = [&](int r, int c) { return part.particles.first + g.particle(r, c); };
  for (const HingeStencil<Real>& hinge : part.hinge_stencils) {
    Index corners[4];
    double weights[4];
    for (int k = 0; k < 4; ++k) {
      corners[k] = part.particles.first + hinge.x[k];
      weights[k] = static_cast<double>(hinge.weight[k]);
    }
    visit(hinge.stiffness, corners, weights, 4);
  }
  for (int r = 0; r < g.rows; ++r) {
    for (int c = 0; c < g.columns; ++c) {
      if (const double share = share_bend_u(g, r, c); share > 0) {
        const Index corners[] = {particle(r, c - 1), particle(r, c), particle(r, c + 1)};
        visit(q.along_u * static_cast<Real>(share), corners, kLine, 3);
      }
      if (const double share = share_bend_v(g, r, c); share > 0) {
        const Index corners[] = {particle(r - 1, c), particle(r, c), particle(r + 1, c)};
        visit(q.along_v * static_cast<Real>(share), corners, kLine, 3);
      }
      if (g.has_cell(r, c)) {
        const Index corners[] = {particle(r, c), particle(r, c + 1), particle(r + 1, c),
                                 particle(r + 1, c + 1)};
        visit(q.twist, corners, kTwist, 4);
      }
    }
  }
}

}  // namespace weft
