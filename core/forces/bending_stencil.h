#pragma once

#include "core/cloth/cloth_model.h"

namespace weft {

/// Calls visit(stiffness, particle indices, weights, corners) for every stencil w of the quadratic
/// bending form of a part, whose energy is stiffness/2 |sum_k w_k x_k|^2: 1 -2 1 along each row and
/// column (border lines stand for half a cell), and 1 -1 -1 1 over the corners of each cell.
template <class Real, class Visitor>
void visit_bending_stencils(const ClothPart<Real>& part, Visitor&& visit) {
  static constexpr double kLine[] = {1, -2, 1}, kTwist[] = {1, -1, -1, 1};
  const QuadraticBending<Real>& q = part.quadratic_bending;
  const Index rows = part.rows, columns = part.columns;
  const auto share = [](Index k, Index count) {
    return k == 0 || k == count - 1 ? Real(0.5) : Real(1);
  };
  for (Index r = 0; r < rows; ++r) {
    for (Index c = 0; c < columns; ++c) {
      const Index i = part.particles.first + r * columns + c;
      if (c > 0 && c + 1 < columns) {
        const Index corners[] = {i - 1, i, i + 1};
        visit(q.along_u * share(r, rows), corners, kLine, 3);
      }
      if (r > 0 && r + 1 < rows) {
        const Index corners[] = {i - columns, i, i + columns};
        visit(q.along_v * share(c, columns), corners, kLine, 3);
      }
      if (r + 1 < rows && c + 1 < columns) {
        const Index corners[] = {i, i + 1, i + columns, i + columns + 1};
        visit(q.twist, corners, kTwist, 4);
      }
    }
  }
}

}  // namespace weft
