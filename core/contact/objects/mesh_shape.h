#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "core/contact/objects/feature_blocks.h"
#include "core/geometry/bvh.h"
#include "core/geometry/distance.h"
#include "core/geometry/triangle_mesh.h"

// A triangle mesh as an object: normals, tree, and which features are sharp.

namespace weft {

/// How high a ridge or a corner may rise over points of a cloth that are at most R beside it: the
/// larger of slope R and curvature R^2 / 2.
template <class Real>
struct Rise {
  Real slope = 0;      ///< infinite where the mesh has a rim
  Real curvature = 0;  ///< [1/m]

  Real over(Real beside) const { return std::max(slope * beside, curvature * beside * beside / 2); }
};

/// A triangle mesh prepared for contact: positions in Real, normals of every feature, and a
/// hierarchy of the triangles. Ridges and corners are the sharp edges and vertices: others, flat or
/// concave ones of a closed mesh, cannot touch a cloth before their triangles do.
template <class Real>
struct MeshShape {
  bool closed = false;
  Real triangle_size = 0;  ///< side of a square of two triangles of mean area [m]
  Real longest_edge = 0;   ///< [m]
  Real rounding = 0;  ///< by which distances from its thinnest triangles come out too large [m]
  Vec3Array<Real> positions;
  std::vector<Triangle> triangles;
  Vec3Array<Real> face_normals;
  Vec3Array<Real> vertex_normals;  ///< angle-weighted
  std::vector<MeshEdge> edges;
  Vec3Array<Real> edge_normals;  ///< mean of the two faces, unit
  FeatureBlocks<Real> triangle_blocks, ridge_blocks, corner_blocks;
  std::vector<Rise<Real>> edge_rises, vertex_rises;  ///< of sharp ones
  Bvh<Real> triangle_tree;
};

/// By how much the distance of a point from a triangle may come out too large in the precision of
/// Real: the normal of a thin one is lost in rounding, but no point of it is far from its sides
/// [m].
/// @param longest       of its sides [m]
/// @param doubled_area  [m^2]
template <class Real>
Real rounding_of_triangle(Real longest, Real doubled_area) {
  const Real noise = 8 * std::numeric_limits<Real>::epsilon() * longest * longest * longest;
  return longest > 0 ? std::min(noise / std::max(doubled_area, std::numeric_limits<Real>::min()),
                                doubled_area / longest)
                     : Real(0);
}

/// The same of the distance between two segments: where these are nearly parallel, their nearest
/// points are lost in rounding [m].
template <class Real>
Real rounding_of_segments(Real length, Real other) {
  return std::sqrt(8 * std::numeric_limits<Real>::epsilon() * length * (length + other));
}

/// A ridge that turns by an angle a and has faces of width w rises a/2 R over points that are R
/// beside it, or a/w R^2 / 2 if the surface goes on turning like that; a corner as it is steep.
template <class Real>
MeshShape<Real> prepare_mesh(const TriangleMesh& mesh);

/// Nearest point of triangle `t` alone, computed in the precision of In.
template <class In, class Real>
TrianglePoint<In> nearest_on(const MeshShape<Real>& mesh, Index t, const Vec3<In>& p) {
  assert(at_index(t) < mesh.triangles.size());
  const Triangle& triangle = mesh.triangles[at_index(t)];
  const auto corner = [&](std::size_t k) -> Vec3<In> {
    return mesh.positions[at_index(triangle[k])].template cast<In>();
  };
  return closest_on_triangle<In>(p, corner(0), corner(1), corner(2));
}

/// Nearest point of a mesh with the side that it is seen from.
template <class Real>
struct MeshDistance {
  Index triangle = kNone;
  Real distance = 0;  ///< [m]; negative inside a closed mesh
  double size = 0;    ///< of the distance, to tell the nearest: both sides of a needle are as near
                      ///< in single precision [m]
  int feature = 0;    ///< of the triangle that is nearest, as TrianglePoint has it
  Vec3<Real> normal;  ///< unit, out of the solid (or towards the point, if the mesh is open)
};

/// Signed distance of a point to triangle `t` alone, with the sign by the nearest feature's normal.
template <class Real>
MeshDistance<Real> distance_to_triangle(const MeshShape<Real>& mesh, Index t, const Vec3<Real>& p);

/// Signed distance to the mesh; `triangle` is none if everything is farther than `reach` [m].
template <class Real>
MeshDistance<Real> distance_to_mesh(const MeshShape<Real>& mesh, const Vec3<Real>& p, Real reach);

}  // namespace weft
