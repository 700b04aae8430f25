#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "core/geometry/bvh.h"
#include "core/geometry/triangle_mesh.h"
#include "core/stop_signal.h"
#include "core/types.h"

// Counts where edges pass through triangles, exactly, and without any code of the contact that it
// judges.

namespace weft {

/// Pairs of an edge and a triangle that intersect.
struct Crossings {
  std::size_t proper = 0;    ///< the edge passes through the interior of the triangle
  std::size_t touching = 0;  ///< they touch only at an end or a border; excludes coplanar pairs

  std::size_t all() const { return proper + touching; }
};

/// Whether and how edge pq and triangle abc intersect, exactly. Coplanar pairs count as neither.
Crossings crossing_of(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b,
                      const Vec3d& c);

/// Whether an edge and a triangle of one surface share a vertex.
bool share_vertex(const Edge& edge, const Triangle& t);

/// Edges and triangles of cloth or of an object, for repeated counts: it keeps its arrays and its
/// tree, so that nothing is allocated from the second placement on.
class CrossingSurface {
 public:
  /// @param edges, triangles  indices into the positions of `place`
  CrossingSurface(std::vector<Edge> edges, std::vector<Triangle> triangles);
  /// From a mesh, not placed yet.
  explicit CrossingSurface(const TriangleMesh& mesh);

  /// Moves vertex i to at(i) [m], finite.
  /// @param count  number of vertices, the same each time
  template <class At>
  void place(std::size_t count, At&& at) {
    assert(positions_.empty() || positions_.size() == count);
    positions_.resize(count);
    for (std::size_t i = 0; i < count; ++i) positions_[i] = at(i);
    fit();
  }

  const std::vector<Vec3d>& positions() const { return positions_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Bvh<double>& tree() const { return tree_; }  ///< over the placed triangles

 private:
  void fit();

  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3d> positions_;
  std::vector<Aabb<double>> boxes_;
  Bvh<double> tree_;
};

/// Calls see(edge, triangle, how) for each edge over x that intersects a triangle over y.
/// @param one_cloth  both use the same vertices: pairs with a common one are skipped
/// @param tree       over the triangles at y
template <class See>
void for_each_crossing(const std::vector<Vec3d>& x, const std::vector<Edge>& edges,
                       const std::vector<Vec3d>& y, const std::vector<Triangle>& triangles,
                       bool one_cloth, const Bvh<double>& tree, See&& see) {
  const auto at = [](const std::vector<Vec3d>& of, Index i) -> const Vec3d& {
    return of[static_cast<std::size_t>(i)];
  };
  std::size_t looked = 0;
  for (const Edge& edge : edges) {
    stop_point(looked++);
    const Vec3d &p = at(x, edge[0]), &q = at(x, edge[1]);
    Aabb<double> box;
    box.add(p);
    box.add(q);
    tree.for_each_overlap(box, [&](Index k) {
      assert(static_cast<std::size_t>(k) < triangles.size());
      const Triangle& t = triangles[static_cast<std::size_t>(k)];
      if (one_cloth && share_vertex(edge, t)) return;
      const Crossings how = crossing_of(p, q, at(y, t[0]), at(y, t[1]), at(y, t[2]));
      if (how.all() > 0) see(edge, t, how);
    });
  }
}

/// The same for placed surfaces.
template <class See>
void for_each_crossing(const CrossingSurface& edges, const CrossingSurface& triangles,
                       bool one_cloth, See&& see) {
  if (triangles.triangles().empty()) return;
  for_each_crossing(edges.positions(), edges.edges(), triangles.positions(), triangles.triangles(),
                    one_cloth, triangles.tree(), see);
}

/// Counts edges of cloths through triangles of cloths that share no particle with them.
/// @param x     positions of all particles [m], finite
/// @param tree  over the same triangles, kept by the caller between counts; built if it is empty
template <class Real>
Crossings count_self_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                               const std::vector<Triangle>& triangles, Bvh<double>& tree);
template <class Real>
Crossings count_self_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                               const std::vector<Triangle>& triangles) {
  Bvh<double> tree;
  return count_self_crossings(x, edges, triangles, tree);
}

/// Counts edges of cloths through triangles of the mesh, and edges of the mesh through triangles of
/// cloths.
template <class Real>
Crossings count_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                          const std::vector<Triangle>& triangles, const TriangleMesh& mesh);

}  // namespace weft
