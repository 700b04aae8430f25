#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/bvh.h"
#include "core/geometry/triangle_mesh.h"
#include "core/types.h"

// Counts where edges pass through triangles, exactly, and without any code of the contact that it
// judges.

namespace weft {

/// Pairs of an edge and a triangle that meet.
struct Crossings {
  std::size_t proper = 0;    ///< the edge passes through the inside of the triangle
  std::size_t touching = 0;  ///< they meet, but an end or a border only; coplanar pairs excepted
};

/// Whether and how edge pq and triangle abc meet, exactly. Coplanar ones count as neither.
Crossings crossing_of(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b,
                      const Vec3d& c);

/// Edges of cloths through triangles of cloths that share no particle with them.
/// @param x     positions of all particles [m], finite
/// @param tree  over the same triangles, from an earlier count; built if it is empty. Who counts
///              often keeps one.
template <class Real>
Crossings count_self_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                               const std::vector<Triangle>& triangles, Bvh<double>& tree);
template <class Real>
Crossings count_self_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                               const std::vector<Triangle>& triangles) {
  Bvh<double> tree;
  return count_self_crossings(x, edges, triangles, tree);
}

/// Edges of cloths through triangles of the mesh, and edges of the mesh through triangles of
/// cloths.
template <class Real>
Crossings count_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                          const std::vector<Triangle>& triangles, const TriangleMesh& mesh);

}  // namespace weft
