#include "core/world/crossing_counter.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/geometry/distance.h"

namespace weft {
namespace {

/// A collider's triangles as it is defined; none if it has no triangles.
TriangleMesh mesh_of(const ShapeDef& shape) {
  if (const auto* box = std::get_if<BoxDef>(&shape)) return world_mesh(*box);
  if (const auto* given = std::get_if<MeshDef>(&shape)) return given->mesh;
  return {};
}

void add(const Crossings& found, Crossings& sum) {
  sum.proper += found.proper;
  sum.touching += found.touching;
}

/// Distance of two features of cloths where they are now [m]: the normals of rows are from when
/// these were built, and a pair that has just come near has no row yet.
template <class Real>
double gap_of(const GuardedPair<Real>& pair, const Vec3Array<Real>& x) {
  std::array<Vec3d, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
    p[k] = x[static_cast<std::size_t>(pair.particle[k])].template cast<double>();
  if (pair.kind == PairKind::vertex_triangle)
    return (p[0] - closest_on_triangle(p[0], p[1], p[2], p[3]).point).norm();
  const SegmentPoints<double> nearest = closest_of_segments(p[0], p[1], p[2], p[3]);
  return (nearest.p - nearest.q).norm();
}

}  // namespace

template <class Real>
void CrossingCounter<Real>::list_surfaces(const World<Real>& world) {
  cloth_.emplace(world.model().edges, world.model().triangles);
  objects_.clear();
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const ShapeDef& shape = world.def().colliders[k].shape;
    TriangleMesh mesh = mesh_of(shape);
    if (const auto* rod = std::get_if<CapsuleDef>(&shape))
      objects_.push_back({k, {rod->a, rod->b}, CrossingSurface({{0, 1}}, {}), {}});
    else if (!mesh.triangles.empty())
      objects_.push_back({k, mesh.positions, CrossingSurface(mesh), {}});
  }
}

template <class Real>
WorldCrossings CrossingCounter<Real>::count(const World<Real>& world) {
  if (!cloth_) list_surfaces(world);
  const Vec3Array<Real>& x = world.state().x;
  cloth_->place(x.size(), [&x](std::size_t i) -> Vec3d { return x[i].template cast<double>(); });
  WorldCrossings found;
  found.cloths = count_self_crossings(*cloth_);
  for (Object& object : objects_) {
    const Pose& pose = world.colliders()[object.collider].pose;
    if (!object.pose || !(*object.pose == pose)) {
      const ShapeDef& shape = world.def().colliders[object.collider].shape;
      // At rest to the bit, as turning it by nothing would round.
      const bool rests = pose == rest_pose(shape);
      const Vec3d pivot = pivot_of(shape);
      object.surface.place(object.own.size(), [&](std::size_t i) -> Vec3d {
        return rests ? object.own[i] : pose.position + pose.rotation * (object.own[i] - pivot);
      });
      object.pose = pose;
    }
    add(count_crossings(*cloth_, object.surface), found.objects);
  }
  return found;
}

template <class Real>
double smallest_gap(const World<Real>& world) {
  const Vec3Array<Real>& x = world.state().x;
  double smallest = std::numeric_limits<double>::infinity();
  for (const ContactRow<Real>& row : world.contact().rows()) {
    if (!row.responds) continue;
    smallest = std::min(smallest, static_cast<double>(world.contact().gap_of(row, x)));
  }
  if (!world.guard()) return smallest;
  for (const GuardedPair<Real>& pair : world.guard()->pairs()) {
    if (!pair.gone && !pair.open) smallest = std::min(smallest, gap_of(pair, x));
  }
  return smallest;
}

template class CrossingCounter<float>;
template class CrossingCounter<double>;
template double smallest_gap(const World<float>&);
template double smallest_gap(const World<double>&);

}  // namespace weft
