#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/cloth/membrane_triangle.h"
#include "core/types.h"

// Pairs of membrane triangles for vector code.

namespace weft {

/// Two triangles with a common edge, (x0, x1, x2) and (x0, x1, x3): their four corners are read and
/// pulled once, where single triangles have six. A triangle that is left over has x3 = x0 and a
/// second triangle without gradients, which has no force.
template <class Real>
struct TrianglePair {
  std::array<Index, 4> x{};
  /// u1, u2, v1, v2 [1/m] of both, as in MembraneTriangle, from x0 to x1 and to the third corner.
  std::array<Real, 8> shape{};
  /// Of its corners 0-1 0-2 0-3 1-2 1-3 2-3 the negative entry of the bending matrix, for the pass
  /// over the mesh to fill in [N/m].
  std::array<Real, 6> link{};

  bool is_single() const { return x[3] == x[0]; }
  Index earliest() const;
};

/// Most triangles in pairs: those that have only one partner left choose first (Karp, Sipser 1981).
/// Ordered by their earliest particle.
template <class Real>
std::vector<TrianglePair<Real>> pair_triangles(std::span<const MembraneTriangle<Real>> triangles);

}  // namespace weft
