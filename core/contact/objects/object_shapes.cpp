// Builds the shapes of objects, places them, and measures distances from them.

#include "core/contact/objects/object_shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>

#include "core/contact/objects/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

template <class Real>
std::shared_ptr<const MeshShape<Real>> prepared(const TriangleMesh& mesh, MeshStore* store) {
  if constexpr (std::is_same_v<Real, float>) {
    if (store) return store->prepared(mesh);
  }
  return std::make_shared<const MeshShape<Real>>(prepare_mesh<Real>(mesh));
}

template <class Real>
void add_shape(const ShapeDef& shape, std::size_t collider, MeshStore* store,
               ObjectShapes<Real>& shapes) {
  if (const auto* plane = std::get_if<PlaneDef>(&shape)) {
    const Vec3d n = plane->normal.normalized();
    shapes.planes.push_back({n.cast<Real>(), static_cast<Real>(n.dot(plane->point)), collider});
  } else if (const auto* sphere = std::get_if<SphereDef>(&shape)) {
    const auto first_rod = std::find_if(shapes.rounds.begin(), shapes.rounds.end(),
                                        [](const auto& r) { return !r.is_ball; });
    const Vec3<Real> centre = sphere->centre.cast<Real>();
    shapes.rounds.insert(first_rod,
                         {centre, centre, static_cast<Real>(sphere->radius), collider, true});
  } else if (const auto* capsule = std::get_if<CapsuleDef>(&shape)) {
    shapes.rounds.push_back({capsule->a.cast<Real>(), capsule->b.cast<Real>(),
                             static_cast<Real>(capsule->radius), collider, false});
  } else {
    const auto* box = std::get_if<BoxDef>(&shape);
    shapes.meshes.push_back(
        prepared<Real>(box ? world_mesh(*box) : std::get<MeshDef>(shape).mesh, store));
    shapes.mesh_collider.push_back(collider);
  }
}

template <class Real>
Vec3<Real> nearest_on_core(const RoundObject<Real>& rod, const Vec3<Real>& p) {
  return rod.a + (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b);
}

}  // namespace

template <class Real>
ObjectShapes<Real> object_shapes(const std::vector<ColliderDef>& colliders, MeshStore* store) {
  ObjectShapes<Real> shapes;
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    validate(colliders[k], "colliders[" + std::to_string(k) + "].");
    add_shape(colliders[k].shape, k, store, shapes);
    ColliderFrame<Real>& frame = shapes.frames.emplace_back();
    frame.friction_factor = colliders[k].friction_factor;
    frame.pivot = pivot_of(colliders[k].shape);
    frame.radius = radius_of(colliders[k].shape);
    frame.pose = rest_pose(colliders[k].shape);
  }
  shapes.own_planes = shapes.planes;
  shapes.own_rounds = shapes.rounds;
  for (const auto& mesh : shapes.meshes)
    shapes.widest_skin = std::min(shapes.widest_skin, mesh->triangle_size);
  return shapes;
}

template <class Real>
void place_collider(std::size_t collider, const Pose& pose, ObjectShapes<Real>& shapes) {
  assert(collider < shapes.frames.size());
  ColliderFrame<Real>& frame = shapes.frames[collider];
  if (pose == frame.pose) return;
  frame.place(pose);
  for (std::size_t k = 0; k < shapes.planes.size(); ++k) {
    ObjectPlane<Real>& plane = shapes.planes[k];
    if (plane.collider != collider) continue;
    plane.offset = shapes.own_planes[k].offset;
    if (frame.displaced) plane.offset += plane.normal.dot(frame.shift);
  }
  for (std::size_t k = 0; k < shapes.rounds.size(); ++k) {
    if (shapes.rounds[k].collider != collider) continue;
    shapes.rounds[k].a = frame.world(shapes.own_rounds[k].a);
    shapes.rounds[k].b = frame.world(shapes.own_rounds[k].b);
  }
}

template <class Real>
Real analytic_clearance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach) {
  Real nearest = reach;
  for (const ObjectPlane<Real>& plane : shapes.planes)
    nearest = std::min(nearest, plane.normal.dot(p) - plane.offset);
  for (const RoundObject<Real>& rod : shapes.rounds)
    nearest = std::min(nearest, (p - nearest_on_core(rod, p)).norm() - rod.radius);
  return nearest;
}

template <class Real>
Real clearance_of(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach) {
  Real nearest = analytic_clearance(shapes, p, reach);
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const MeshShape<Real>& mesh = *shapes.meshes[m];
    const Vec3<Real> own = shapes.mesh_frame(m).own(p);
    if (mesh.triangle_tree.bounds().squared_distance(own) > reach * reach) continue;
    const MeshDistance<Real> d = distance_to_mesh(mesh, own, reach);
    if (d.triangle != kNone) nearest = std::min(nearest, d.distance);
  }
  return nearest;
}

template <class Real>
Real least_clearance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach) {
  const Real nearest = analytic_clearance(shapes, p, reach);
  Real bound = nearest * nearest;
  if (!(nearest > 0)) return nearest;
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const MeshShape<Real>& mesh = *shapes.meshes[m];
    const Vec3<Real> own = shapes.mesh_frame(m).own(p);
    bound = mesh.triangle_tree.nearest(
        bound, [&](const Aabb<Real>& box) { return box.squared_distance(own); },
        [&](Index t, Real best) {
          const Real distance2 = (own - nearest_on(mesh, t, own).point).squaredNorm();
          return std::min(best, distance2 * Real(kBoundSlack));
        });
  }
  return std::sqrt(bound);
}

template <class Real>
Real signed_distance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p) {
  Real nearest = analytic_clearance(shapes, p, Real(kFarAway));
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const MeshShape<Real>& mesh = *shapes.meshes[m];
    if (!mesh.closed) continue;
    const Vec3<Real> own = shapes.mesh_frame(m).own(p);
    const Real outside = std::sqrt(mesh.triangle_tree.bounds().squared_distance(own));
    nearest = std::min(
        nearest, outside > 0 ? outside : distance_to_mesh(mesh, own, Real(kFarAway)).distance);
  }
  return nearest;
}

template <class Real>
Real distance_from(const ObjectShapes<Real>& shapes, std::size_t collider, const Vec3<Real>& p) {
  assert(collider < shapes.frames.size());
  Real nearest = Real(kFarAway);
  for (const RoundObject<Real>& rod : shapes.rounds) {
    if (rod.collider == collider)
      nearest = std::min(nearest, (p - nearest_on_core(rod, p)).norm() - rod.radius);
  }
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const MeshShape<Real>& mesh = *shapes.meshes[m];
    if (shapes.mesh_collider[m] != collider || !mesh.closed) continue;
    const Vec3<Real> own = shapes.frames[collider].own(p);
    nearest = std::min(nearest, distance_to_mesh(mesh, own, Real(kFarAway)).distance);
  }
  return nearest;
}

template <class Real>
double top_of(const ObjectShapes<Real>& shapes, std::size_t mesh, const Vec3<Real>& normal,
              std::initializer_list<Index> vertices) {
  const ColliderFrame<Real>& frame = shapes.mesh_frame(mesh);
  const Vec3d n = normal.template cast<double>();
  double top = -std::numeric_limits<double>::infinity();
  for (const Index v : vertices) {
    const Vec3<Real> at = frame.world(shapes.meshes[mesh]->positions[at_index(v)]);
    top = std::max(top, n.dot(at.template cast<double>()));
  }
  return top;
}

WEFT_INSTANTIATE_FUNCTIONS(object_shapes, place_collider, analytic_clearance, clearance_of,
                           least_clearance, signed_distance, distance_from, top_of)

}  // namespace weft
