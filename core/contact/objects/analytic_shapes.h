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

template <class Real>
struct ObjectBall {
  Vec3<Real> centre;  ///< [m]
  Real radius;        ///< [m]
  std::size_t collider;
};

/// A capsule: all points within a radius of the core from a to b.
template <class Real>
struct ObjectRod {
  Vec3<Real> a, b;  ///< [m]
  Real radius;      ///< [m]
  std::size_t collider;
};

/// A rod, or a ball, whose core is a point.
template <class Real>
struct RoundObject {
  ObjectRod<Real> rod;
  bool is_ball = false;
};

}  // namespace weft
