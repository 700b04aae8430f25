#pragma once

#include <cassert>
#include <variant>
#include <vector>

#include "core/contact/colliders/collider.h"
#include "core/contact/seed/constants.h"
#include "core/geometry/bottom_up_tree.h"
#include "core/types.h"

// Objects in the seed's contact.

namespace weft {

/// Signed distance of a point from a simple shape, negative inside, and the outward normal.
template <class Real>
struct SurfacePoint {
  Real distance = 0;                        ///< [m]
  Vec3<Real> normal = Vec3<Real>::UnitY();  ///< unit
};

/// A static model of the seed: a simple shape, or triangles with a tree that is built once.
template <class Real>
struct SeedShape {
  /// A protruding edge, which can cut into cloth between its particles.
  struct SharpEdge {
    Index a = 0, b = 0;
    Vec3<Real> normal;  ///< unit, mean of the faces
  };

  bool is_mesh = false;
  ShapeDef simple;            ///< for shapes other than meshes
  bool closed = false;        ///< a solid with outward triangles
  Vec3Array<Real> positions;  ///< [m]
  std::vector<Triangle> triangles;
  BottomUpTree<Real> tree;  ///< over the triangles
  std::vector<SharpEdge> sharp_edges;
  BottomUpTree<Real> edge_tree;  ///< over the sharp edges
};

/// Whether edges that are closest here form an edge-edge pair; nearer to an end the particle or
/// vertex there represents them.
/// @param s  fraction of the edge's length, 0 to 1
template <class Real>
bool is_within_edge(Real s) {
  assert(!(s < 0) && !(s > 1));
  return s > Real(kSeedEdgeEnd) && s < Real(1 - kSeedEdgeEnd);
}

/// Prepares a collider.
/// @param reach  search distance around triangles [m]
template <class Real>
SeedShape<Real> make_seed_shape(const ShapeDef& def, Real reach);

/// Distance from a plane, sphere, capsule or box. The middle of a round shape counts as below its
/// top.
template <class Real>
SurfacePoint<Real> distance_from(const ShapeDef& simple, const Vec3<Real>& p);

/// Box of a triangle that overlaps the boxes, reaching h/2 around particles, of all points that
/// eqs. (7) and (8) call near to it. (Boxes of flat cloth need some volume, or the search would
/// descend the wrong tree first.)
/// @param h  thickness [m]
template <class Real>
Aabb<Real> proximity_box(const Vec3<Real>& x1, const Vec3<Real>& x2, const Vec3<Real>& x3, Real h);

}  // namespace weft
