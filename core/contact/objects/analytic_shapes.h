#pragma once

#include <cstddef>

#include "core/types.h"

// Objects that Contact knows by formula, where they are now.

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

}  // namespace weft
