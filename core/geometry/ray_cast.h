#pragma once

#include <array>
#include <optional>

#include "core/geometry/bvh.h"
#include "core/types.h"

namespace weft {

/// Where a ray meets a triangle.
template <class Real>
struct RayHit {
  Real distance = 0;  ///< in units of the direction's length, >= 0
  Index triangle = kNone;
  std::array<Real, 3> barycentric = {};  ///< >= 0, sum 1
};

/// Hit of a ray on triangle abc from either side; nothing if they are parallel, if the triangle has
/// no area or if it is behind the origin. Edges belong to both of their triangles: no ray slips
/// through between them (the edge tests of both see the same numbers; Woop, Benthin, Wald 2013).
template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c);

/// First hit among triangles through their hierarchy; of equally near ones the smallest index.
template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Bvh<Real>& hierarchy, const Vec3Array<Real>& positions,
                                     const std::vector<Triangle>& triangles);

/// Boxes of triangles, for a hierarchy; `boxes` is resized.
template <class Real>
void triangle_boxes(const Vec3Array<Real>& positions, const std::vector<Triangle>& triangles,
                    std::vector<Aabb<Real>>& boxes);

}  // namespace weft
