#pragma once

#include <cassert>
#include <initializer_list>
#include <limits>
#include <memory>
#include <vector>

#include "core/contact/colliders/collider_frame.h"
#include "core/contact/objects/mesh_shape.h"
#include "core/contact/objects/mesh_store.h"
#include "core/types.h"

// The shapes of all objects, where they are now, and distances from them.

namespace weft {

template <class Real>
struct ObjectPlane {
  Vec3<Real> normal;  ///< out of the object, unit
  Real offset;        ///< normal.x of its points [m]
  std::size_t collider;
};

/// A ball or a capsule: all points within a radius of the core from a to b.
template <class Real>
struct RoundObject {
  Vec3<Real> a, b;  ///< [m]
  Real radius;      ///< [m]
  std::size_t collider;
  bool is_ball;  ///< its core is a point
};

/// Planes, balls and rods are given by formulas; boxes and meshes are triangles in their own
/// frames.
template <class Real>
struct ObjectShapes {
  std::vector<ObjectPlane<Real>> planes, own_planes;           ///< where they are, and as defined
  std::vector<RoundObject<Real>> rounds, own_rounds;           ///< balls before capsules
  std::vector<std::shared_ptr<const MeshShape<Real>>> meshes;  ///< shared by copies of a world
  std::vector<std::size_t> mesh_collider;                      ///< the collider of each mesh
  std::vector<ColliderFrame<Real>> frames;                     ///< of each collider
  /// Longest skin of a particle that is not fast: the smallest triangle size of all meshes. With
  /// longer skins the number of pairs grows with their square [m].
  Real widest_skin = std::numeric_limits<Real>::infinity();

  bool empty() const { return planes.empty() && rounds.empty() && meshes.empty(); }
  const ColliderFrame<Real>& mesh_frame(std::size_t mesh) const {
    assert(mesh < mesh_collider.size());
    return frames[mesh_collider[mesh]];
  }
};

/// @param store  has prepared meshes of float; null: they are prepared here
/// Throws DefinitionError if a collider is out of range.
template <class Real>
ObjectShapes<Real> object_shapes(const std::vector<ColliderDef>& colliders, MeshStore* store);

/// Puts the shapes of one collider where it is.
template <class Real>
void place_collider(std::size_t collider, const Pose& pose, ObjectShapes<Real>& shapes);

/// Distance of a point from the planes, balls and rods, at most `reach` [m]; negative inside.
template <class Real>
Real analytic_clearance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach);

/// Distance of a point from all objects, at most `reach` [m].
template <class Real>
Real clearance_of(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach);

/// A lower bound of that for a point that is outside of every solid: boxes that could only lower it
/// by less than the slack are not opened.
template <class Real>
Real least_clearance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p, Real reach);

/// Signed distance of a point from the nearest object [m]; of meshes, only closed ones have an
/// inside.
template <class Real>
Real signed_distance(const ObjectShapes<Real>& shapes, const Vec3<Real>& p);

/// Signed distance of a point from the solid shape of one collider [m]; far from it, and from what
/// has no inside, kFarAway.
template <class Real>
Real distance_from(const ObjectShapes<Real>& shapes, std::size_t collider, const Vec3<Real>& p);

/// The highest of some vertices of a mesh along a direction [m].
/// @param normal  in the world
template <class Real>
double top_of(const ObjectShapes<Real>& shapes, std::size_t mesh, const Vec3<Real>& normal,
              std::initializer_list<Index> vertices);

}  // namespace weft
