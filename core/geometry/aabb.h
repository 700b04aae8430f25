#pragma once

#include <limits>

#include "core/types.h"

// Axis-aligned boxes with the usual operations.

namespace weft {

/// Axis-aligned bounding box [m]. Initially empty.
template <class Real>
struct Aabb {
  Vec3<Real> lower = Vec3<Real>::Constant(std::numeric_limits<Real>::infinity());
  Vec3<Real> upper = Vec3<Real>::Constant(-std::numeric_limits<Real>::infinity());

  void add(const Vec3<Real>& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  void add(const Aabb& box) {
    lower = lower.cwiseMin(box.lower);
    upper = upper.cwiseMax(box.upper);
  }
  /// The box with every side moved outwards by `margin` [m].
  Aabb grown(Real margin) const {
    Aabb box = *this;
    box.lower.array() -= margin;
    box.upper.array() += margin;
    return box;
  }
  bool overlaps(const Aabb& o) const {
    return lower[0] <= o.upper[0] && o.lower[0] <= upper[0] && lower[1] <= o.upper[1] &&
           o.lower[1] <= upper[1] && lower[2] <= o.upper[2] && o.lower[2] <= upper[2];
  }
  /// Whether the other box lies inside; an empty one lies inside every box.
  bool contains(const Aabb& o) const {
    return (lower.array() <= o.lower.array()).all() && (upper.array() >= o.upper.array()).all();
  }
  Vec3<Real> centre() const { return (lower + upper) * Real(0.5); }
  /// Squared distance of a point from the box, 0 inside [m^2].
  Real squared_distance(const Vec3<Real>& p) const {
    return (lower - p).cwiseMax(p - upper).cwiseMax(Real(0)).squaredNorm();
  }
};

}  // namespace weft
