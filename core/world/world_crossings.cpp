#include "core/world/world_crossings.h"

#include <array>

namespace weft {
namespace {

/// A collider's triangles where it is; none if it has no triangles. At rest to the bit, as turning
/// it by nothing would round.
TriangleMesh mesh_now(const ColliderDef& def, const Pose& pose) {
  TriangleMesh mesh;
  if (const auto* box = std::get_if<BoxDef>(&def.shape)) mesh = world_mesh(*box);
  if (const auto* given = std::get_if<MeshDef>(&def.shape)) mesh = given->mesh;
  if (pose == rest_pose(def.shape)) return mesh;
  const Vec3d pivot = pivot_of(def.shape);
  for (Vec3d& p : mesh.positions) p = pose.position + pose.rotation * (p - pivot);
  return mesh;
}

void add(const Crossings& found, Crossings& sum) {
  sum.proper += found.proper;
  sum.touching += found.touching;
}

/// Triangles of cloths that a segment passes.
template <class Real>
Crossings pierced(const World<Real>& world, const Vec3d& from, const Vec3d& to) {
  Aabb<double> segment;
  segment.add(from);
  segment.add(to);
  Crossings sum;
  for (const Triangle& t : world.model().triangles) {
    std::array<Vec3d, 3> corner;
    Aabb<double> box;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = world.state().x[static_cast<std::size_t>(t[k])].template cast<double>();
      box.add(corner[k]);
    }
    if (box.overlaps(segment)) add(crossing_of(from, to, corner[0], corner[1], corner[2]), sum);
  }
  return sum;
}

template <class Real>
Crossings crossings_with(const World<Real>& world, const ColliderDef& def, const Pose& pose) {
  if (const auto* rod = std::get_if<CapsuleDef>(&def.shape)) {
    const Vec3d pivot = pivot_of(def.shape);
    const auto now = [&](const Vec3d& p) -> Vec3d {
      return pose.position + pose.rotation * (p - pivot);
    };
    return pierced(world, now(rod->a), now(rod->b));
  }
  const TriangleMesh mesh = mesh_now(def, pose);
  if (mesh.triangles.empty()) return {};
  return count_crossings(world.state().x, world.model().edges, world.model().triangles, mesh);
}

}  // namespace

template <class Real>
WorldCrossings count_crossings(const World<Real>& world, Bvh<double>& tree) {
  const ClothModel<Real>& model = world.model();
  const Vec3Array<Real>& x = world.state().x;
  WorldCrossings found;
  found.cloths = count_self_crossings(x, model.edges, model.triangles, tree);
  for (std::size_t k = 0; k < world.colliders().size(); ++k)
    add(crossings_with(world, world.def().colliders[k], world.colliders()[k].pose), found.objects);
  return found;
}

template WorldCrossings count_crossings(const World<float>&, Bvh<double>&);
template WorldCrossings count_crossings(const World<double>&, Bvh<double>&);

}  // namespace weft
