// Exact edge-triangle intersection tests.

#include "core/diagnostics/crossings.h"

#include <utility>

#include "core/geometry/ray_cast.h"
#include "core/math/exact_sign.h"

namespace weft {
namespace {

using Positions = std::vector<Vec3d>;

template <class Real>
Positions in_double(const Vec3Array<Real>& x) {
  Positions result;
  result.reserve(x.size());
  for (const Vec3<Real>& p : x) result.push_back(p.template cast<double>());
  return result;
}

/// A visitor that sums crossings.
auto adding_to(Crossings& sum) {
  return [&sum](const Edge&, const Triangle&, const Crossings& how) {
    sum.proper += how.proper;
    sum.touching += how.touching;
  };
}

std::vector<Edge> pairs_of(const std::vector<MeshEdge>& edges) {
  std::vector<Edge> pairs;
  pairs.reserve(edges.size());
  for (const MeshEdge& e : edges) pairs.push_back({e.a, e.b});
  return pairs;
}

}  // namespace

Crossings crossing_of(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b,
                      const Vec3d& c) {
  const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q > 0 || (side_p == 0 && side_q == 0)) return {};
  const int ab = orientation(p, q, a, b), bc = orientation(p, q, b, c),
            ca = orientation(p, q, c, a);
  const bool outside = ab * bc < 0 || bc * ca < 0 || ca * ab < 0;
  if (outside) return {};
  const bool proper = side_p * side_q < 0 && ab != 0 && bc != 0 && ca != 0;
  // All three zero: the triangle has no area in the edge's direction.
  if (!proper && ab == 0 && bc == 0 && ca == 0) return {};
  return proper ? Crossings{1, 0} : Crossings{0, 1};
}

bool share_vertex(const Edge& edge, const Triangle& t) {
  for (const Index i : edge)
    if (i == t[0] || i == t[1] || i == t[2]) return true;
  return false;
}

CrossingSurface::CrossingSurface(std::vector<Edge> edges, std::vector<Triangle> triangles)
    : edges_(std::move(edges)), triangles_(std::move(triangles)) {}

CrossingSurface::CrossingSurface(const TriangleMesh& mesh)
    : CrossingSurface(pairs_of(edges_of(mesh)), mesh.triangles) {}

void CrossingSurface::fit() {
  if (triangles_.empty()) return;
  triangle_boxes(positions_, triangles_, boxes_);
  tree_.empty() ? tree_.build(boxes_) : tree_.refit(boxes_);
}

template <class Real>
Crossings count_self_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                               const std::vector<Triangle>& triangles, Bvh<double>& tree) {
  Crossings sum;
  const Positions positions = in_double(x);
  std::vector<Aabb<double>> boxes;
  triangle_boxes(positions, triangles, boxes);
  tree.empty() ? tree.build(boxes) : tree.refit(boxes);
  for_each_crossing(positions, edges, positions, triangles, true, tree, adding_to(sum));
  return sum;
}

template <class Real>
Crossings count_crossings(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                          const std::vector<Triangle>& triangles, const TriangleMesh& mesh) {
  CrossingSurface cloth(edges, triangles), object(mesh);
  cloth.place(x.size(), [&x](std::size_t i) -> Vec3d { return x[i].template cast<double>(); });
  object.place(mesh.positions.size(), [&mesh](std::size_t i) { return mesh.positions[i]; });
  Crossings sum;
  for_each_crossing(cloth, object, false, adding_to(sum));
  for_each_crossing(object, cloth, false, adding_to(sum));
  return sum;
}

#define WEFT_INSTANTIATE(Real)                                                              \
  template Crossings count_self_crossings(const Vec3Array<Real>&, const std::vector<Edge>&, \
                                          const std::vector<Triangle>&, Bvh<double>&);      \
  template Crossings count_crossings(const Vec3Array<Real>&, const std::vector<Edge>&,      \
                                     const std::vector<Triangle>&, const TriangleMesh&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
