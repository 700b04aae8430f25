#pragma once

#include <variant>
#include <vector>

#include "core/contact/colliders/collider.h"
#include "core/geometry/bottom_up_tree.h"
#include "core/types.h"

namespace weft {

/// Signed distance of a point from a simple shape, negative inside, and the way out.
template <class Real>
struct SurfacePoint {
  Real distance = 0;                        ///< [m]
  Vec3<Real> normal = Vec3<Real>::UnitY();  ///< unit
};

/// A static model as the seed sees it: a simple shape, or triangles with their tree, made once.
template <class Real>
struct SeedShape {
  /// An edge that sticks out, where cloth can be cut although no particle is near.
  struct SharpEdge {
    Index a = 0, b = 0;
    Vec3<Real> normal;  ///< unit, mean of the faces
  };

  bool is_mesh = false;
  ShapeDef simple;            ///< if it is no mesh
  bool closed = false;        ///< a solid, whose triangles face outwards
  Vec3Array<Real> positions;  ///< [m]
  std::vector<Triangle> triangles;
  BottomUpTree<Real> tree;  ///< over the triangles
  std::vector<SharpEdge> sharp_edges;
  BottomUpTree<Real> edge_tree;  ///< over the sharp edges
};

/// Whether edges that are closest here are a pair of their own; nearer to an end the particle or
/// vertex there stands for them.
/// @param s  part of the edge's length, 0 to 1
template <class Real>
bool is_within_edge(Real s) {
  constexpr double kEnd = 0.01;
  return s > Real(kEnd) && s < Real(1 - kEnd);
}

/// Prepares a collider.
/// @param reach  at which triangles shall be found [m]
template <class Real>
SeedShape<Real> make_seed_shape(const ShapeDef& def, Real reach);

/// Distance from a plane, sphere, capsule or box. The middle of a round shape counts as below its
/// top.
template <class Real>
SurfacePoint<Real> distance_from(const ShapeDef& simple, const Vec3<Real>& p);

/// Box of a triangle that overlaps, with boxes that reach h/2 around particles, those of all points
/// that eqs. (7) and (8) call near to it. (Boxes of flat cloth need some volume, or the search
/// would go down the wrong tree first.)
/// @param h  thickness [m]
template <class Real>
Aabb<Real> proximity_box(const Vec3<Real>& x1, const Vec3<Real>& x2, const Vec3<Real>& x3, Real h);

}  // namespace weft
