// Watertight ray tests against triangles and their hierarchy.

#include "core/geometry/ray_cast.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/geometry/constants.h"

namespace weft {
namespace {

/// The ray's coordinate system: its dominant axis last, sheared to point along the ray.
struct RayFrame {
  int x, y, z;
  double sx, sy, sz;

  explicit RayFrame(const Vec3d& d) {
    z = 0;
    if (std::abs(d[1]) > std::abs(d[z])) z = 1;
    if (std::abs(d[2]) > std::abs(d[z])) z = 2;
    x = (z + 1) % 3;
    y = (x + 1) % 3;
    if (d[z] < 0) std::swap(x, y);
    sx = d[x] / d[z];
    sy = d[y] / d[z];
    sz = 1 / d[z];
  }
};

/// Largest number that enters a point's sheared coordinates; rounding scales with it.
double extent(const RayFrame& f, const Vec3d& p) {
  return std::max(std::abs(p[f.x]) + std::abs(f.sx * p[f.z]),
                  std::abs(p[f.y]) + std::abs(f.sy * p[f.z]));
}

std::optional<RayHit<double>> cast_in_frame(const RayFrame& f, const Vec3d& a, const Vec3d& b,
                                            const Vec3d& c) {
  const double ax = a[f.x] - f.sx * a[f.z], ay = a[f.y] - f.sy * a[f.z];
  const double bx = b[f.x] - f.sx * b[f.z], by = b[f.y] - f.sy * b[f.z];
  const double cx = c[f.x] - f.sx * c[f.z], cy = c[f.y] - f.sy * c[f.z];
  const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double determinant = u + v + w;
  // Bound of the rounding for a triangle seen edge-on or without area.
  const double size = std::max({extent(f, a), extent(f, b), extent(f, c)});
  const double rounding = 16 * std::numeric_limits<double>::epsilon() * size * size;
  if (!(std::abs(determinant) > rounding) || !std::isfinite(determinant)) return std::nullopt;
  const double t = (u * a[f.z] + v * b[f.z] + w * c[f.z]) * f.sz / determinant;
  if (!(t >= 0) || !std::isfinite(t)) return std::nullopt;
  return RayHit<double>{t, kNone, {u / determinant, v / determinant, w / determinant}};
}

/// Parameter at which the ray enters a box, infinite if it misses. The bounds are widened by
/// kRaySlack, so that rounding never misses a box.
double entry(const Vec3d& origin, const Vec3d& direction, const Vec3d& lower, const Vec3d& upper) {
  constexpr double kWide = 1 + kRaySlack;
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double slack =
        kRaySlack * (std::abs(lower[axis]) + std::abs(upper[axis]) + std::abs(origin[axis]));
    const double low = lower[axis] - slack - origin[axis],
                 high = upper[axis] + slack - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
      continue;
    }
    double near = low / direction[axis], far = high / direction[axis];
    if (near > far) std::swap(near, far);
    from = std::max(from, near);
    to = std::min(to, far * kWide);
  }
  return from <= to ? from : std::numeric_limits<double>::infinity();
}

}  // namespace

template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Vec3<Real>& a, const Vec3<Real>& b,
                                     const Vec3<Real>& c) {
  // In double for any Real: picking is rare, and an edge must belong to both its triangles.
  const Vec3d o = origin.template cast<double>();
  const RayFrame frame(direction.template cast<double>());
  const auto hit = cast_in_frame(frame, a.template cast<double>() - o,
                                 b.template cast<double>() - o, c.template cast<double>() - o);
  if (!hit) return std::nullopt;
  return RayHit<Real>{
      static_cast<Real>(hit->distance),
      kNone,
      {static_cast<Real>(hit->barycentric[0]), static_cast<Real>(hit->barycentric[1]),
       static_cast<Real>(hit->barycentric[2])}};
}

template <class Real>
std::optional<RayHit<Real>> cast_ray(const Vec3<Real>& origin, const Vec3<Real>& direction,
                                     const Bvh<Real>& hierarchy, const Vec3Array<Real>& positions,
                                     const std::vector<Triangle>& triangles) {
  const Vec3d o = origin.template cast<double>(), d = direction.template cast<double>();
  const RayFrame frame(d);
  std::optional<RayHit<double>> best;
  const auto corner = [&](Index i) {
    return (positions[static_cast<std::size_t>(i)].template cast<double>() - o).eval();
  };
  double nearest = std::numeric_limits<double>::infinity();
  hierarchy.nearest(
      std::numeric_limits<Real>::max(),
      [&](const Aabb<Real>& box) {
        const double t =
            entry(o, d, box.lower.template cast<double>(), box.upper.template cast<double>());
        // Boxes behind the best hit count as missed.
        return t <= nearest ? static_cast<Real>(0) : std::numeric_limits<Real>::infinity();
      },
      [&](Index triangle, Real bound) {
        assert(static_cast<std::size_t>(triangle) < triangles.size());
        const Triangle& t = triangles[static_cast<std::size_t>(triangle)];
        const auto hit = cast_in_frame(frame, corner(t[0]), corner(t[1]), corner(t[2]));
        if (!hit) return bound;
        if (best &&
            (hit->distance > nearest || (hit->distance == nearest && triangle > best->triangle)))
          return bound;
        best = hit;
        best->triangle = triangle;
        nearest = hit->distance;
        return bound;
      });
  if (!best) return std::nullopt;
  return RayHit<Real>{
      static_cast<Real>(best->distance),
      best->triangle,
      {static_cast<Real>(best->barycentric[0]), static_cast<Real>(best->barycentric[1]),
       static_cast<Real>(best->barycentric[2])}};
}

template <class Real>
void triangle_boxes(const Vec3Array<Real>& positions, const std::vector<Triangle>& triangles,
                    std::vector<Aabb<Real>>& boxes) {
  boxes.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    boxes[t] = Aabb<Real>{};
    for (const Index corner : triangles[t]) {
      assert(static_cast<std::size_t>(corner) < positions.size());
      boxes[t].add(positions[static_cast<std::size_t>(corner)]);
    }
  }
}

#define WEFT_INSTANTIATE(Real)                                                            \
  template std::optional<RayHit<Real>> cast_ray(const Vec3<Real>&, const Vec3<Real>&,     \
                                                const Vec3<Real>&, const Vec3<Real>&,     \
                                                const Vec3<Real>&);                       \
  template std::optional<RayHit<Real>> cast_ray(const Vec3<Real>&, const Vec3<Real>&,     \
                                                const Bvh<Real>&, const Vec3Array<Real>&, \
                                                const std::vector<Triangle>&);            \
  template void triangle_boxes(const Vec3Array<Real>&, const std::vector<Triangle>&,      \
                               std::vector<Aabb<Real>>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
