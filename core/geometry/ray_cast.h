#pragma once

#include <array>
#include <optional>

#include "core/geometry/bvh.h"
#include "core/types.h"

// Casts rays at triangles, for picking.

namespace weft {

/// Intersection of a ray with a triangle.
template <class Real>
struct RayHit {
  Real distance = 0;  ///< in units of the direction's length, >= 0
  Index triangle = kNone;
  std::array<Real, 3> barycentric = {};  ///< >= 0, sum 1
};

/// Intersection of a ray with triangle abc from either side; nothing if they are parallel, if the
/// triangle has no area or if it lies behind the origin. Edges belong to both of their triangles:
/// no ray slips through between them, because their edge tests use the same numbers (Woop, Benthin,
/// Wald 2013).
template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c);

/// First hit among triangles, found through their hierarchy; the smallest index at equal distance.
template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Bvh<Real>& hierarchy, const Vec3Array<Real>& positions,
                                     const std::vector<Triangle>& triangles);

/// Boxes of triangles, for a hierarchy; `boxes` is resized and keeps its capacity.
template <class Real>
void triangle_boxes(const Vec3Array<Real>& positions, const std::vector<Triangle>& triangles,
                    std::vector<Aabb<Real>>& boxes);

}  // namespace weft
