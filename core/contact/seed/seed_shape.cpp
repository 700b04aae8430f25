// Prepares objects for the seed's contact.

#include "core/contact/seed/seed_shape.h"

#include <cassert>
#include <cmath>

#include "core/contact/seed/constants.h"
#include "core/contact/seed/seed_equations.h"
#include "core/geometry/distance.h"

namespace weft {
namespace {

template <class Real>
Vec3<Real> direction(const Vec3<Real>& d, Real length) {
  return length > 0 ? (d / length).eval() : Vec3<Real>::UnitY().eval();
}

template <class Real>
SurfacePoint<Real> distance_from_box(const BoxDef& box, const Vec3<Real>& p) {
  const Vec3d local =
      box.orientation.normalized().conjugate() * (p.template cast<double>() - box.centre);
  const Vec3d over = local.cwiseAbs() - box.half_extents;
  Vec3d out = over.cwiseMax(0.0);
  double distance = out.norm();
  if (!(distance > 0)) {
    int axis = 0;
    distance = over.maxCoeff(&axis);
    out = Vec3d::Unit(axis);
  } else {
    out /= distance;
  }
  for (int k = 0; k < 3; ++k)
    if (local[k] < 0) out[k] = -out[k];
  return {static_cast<Real>(distance), (box.orientation.normalized() * out).template cast<Real>()};
}

template <class Real>
void add_sharp_edges(const TriangleMesh& mesh, Real reach, SeedShape<Real>& shape) {
  std::vector<Aabb<Real>> boxes;
  std::vector<Edge> ends;
  for (const MeshEdge& e : edges_of(mesh)) {
    const Vec3d first = unit_normal(mesh, e.triangle[0]);
    Vec3d normal = first;
    if (e.triangle[1] != kNone) {
      const Vec3d second = unit_normal(mesh, e.triangle[1]);
      const Vec3d middle = (mesh.positions[static_cast<std::size_t>(e.a)] +
                            mesh.positions[static_cast<std::size_t>(e.b)]) /
                           2;
      const Triangle& t = mesh.triangles[static_cast<std::size_t>(e.triangle[1])];
      Vec3d centre = Vec3d::Zero();
      for (const Index v : t) centre += mesh.positions[static_cast<std::size_t>(v)] / 3;
      const bool convex = (centre - middle).dot(first) < 0;
      if (shape.closed && (!convex || first.dot(second) > kSharpEdgeCosine)) continue;
      normal += second;
    }
    if (!(normal.norm() > 0)) continue;
    shape.sharp_edges.push_back({e.a, e.b, normal.normalized().template cast<Real>()});
    Aabb<Real> box;
    for (const Index v : {e.a, e.b}) box.add(shape.positions[static_cast<std::size_t>(v)]);
    boxes.push_back(box.grown(reach / 2));
    ends.push_back({e.a, e.b});
  }
  shape.edge_tree.build(boxes, pairs_that_touch(ends));
}

}  // namespace

template <class Real>
Aabb<Real> proximity_box(const Vec3<Real>& x1, const Vec3<Real>& x2, const Vec3<Real>& x3, Real h) {
  assert(h > 0);
  const Vec3<Real> doubled = (x1 - x3).cross(x2 - x3);
  // The corners where two weights are -delta.
  const Real delta = doubled.squaredNorm() > 0 ? seed::weight_margin(doubled, h) : Real(0);
  const Vec3<Real> sum = x1 + x2 + x3;
  Aabb<Real> box;
  for (const Vec3<Real>* x : {&x1, &x2, &x3}) box.add((*x + (*x * Real(3) - sum) * delta).eval());
  return box.grown(h / 2);
}

template <class Real>
SeedShape<Real> make_seed_shape(const ShapeDef& def, Real reach) {
  assert(reach > 0);
  SeedShape<Real> shape;
  const auto* mesh_def = std::get_if<MeshDef>(&def);
  if (!mesh_def) {
    shape.simple = def;
    return shape;
  }
  const TriangleMesh& mesh = mesh_def->mesh;
  shape.is_mesh = true;
  shape.closed = is_closed(mesh);
  shape.triangles = mesh.triangles;
  for (const Vec3d& p : mesh.positions) shape.positions.push_back(p.template cast<Real>());
  std::vector<Aabb<Real>> boxes;
  const auto at = [&](Index v) -> const Vec3<Real>& {
    return shape.positions[static_cast<std::size_t>(v)];
  };
  for (const Triangle& t : mesh.triangles)
    boxes.push_back(proximity_box<Real>(at(t[0]), at(t[1]), at(t[2]), reach));
  shape.tree.build(boxes, pairs_that_touch(mesh.triangles));
  add_sharp_edges(mesh, reach, shape);
  return shape;
}

template <class Real>
SurfacePoint<Real> distance_from(const ShapeDef& simple, const Vec3<Real>& p) {
  assert(!std::holds_alternative<MeshDef>(simple));
  if (const auto* plane = std::get_if<PlaneDef>(&simple)) {
    const Vec3<Real> n = plane->normal.normalized().template cast<Real>();
    return {n.dot(p - plane->point.template cast<Real>()), n};
  }
  if (const auto* sphere = std::get_if<SphereDef>(&simple)) {
    const Vec3<Real> d = p - sphere->centre.template cast<Real>();
    const Real length = d.norm();
    return {length - static_cast<Real>(sphere->radius), direction(d, length)};
  }
  if (const auto* capsule = std::get_if<CapsuleDef>(&simple)) {
    const Vec3<Real> a = capsule->a.template cast<Real>(), b = capsule->b.template cast<Real>();
    const Vec3<Real> d = p - (a + (b - a) * closest_on_segment(p, a, b));
    const Real length = d.norm();
    return {length - static_cast<Real>(capsule->radius), direction(d, length)};
  }
  return distance_from_box(std::get<BoxDef>(simple), p);
}

#define WEFT_INSTANTIATE(Real)                                                               \
  template Aabb<Real> proximity_box(const Vec3<Real>&, const Vec3<Real>&, const Vec3<Real>&, \
                                    Real);                                                   \
  template SeedShape<Real> make_seed_shape(const ShapeDef&, Real);                           \
  template SurfacePoint<Real> distance_from(const ShapeDef&, const Vec3<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
