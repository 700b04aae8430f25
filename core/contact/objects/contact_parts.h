#pragma once

#include <cstddef>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Small things that the files of Contact hand to each other.

namespace weft {

/// A gap this much wider than the thickness still counts as touching, so that rounding of positions
/// does not let a resting particle fall for a substep, and its friction with it [m].
inline constexpr double kTouchSlack = 2e-5;

/// Near features of a patch, as ranges of their lists.
struct NearPatch {
  std::size_t patch = 0;
  IndexRange particles, edges, triangles;
};

/// A plane with a convex feature of an object below it.
template <class Real>
struct ContactBarrier {
  Vec3<Real> normal = Vec3<Real>::UnitY();  ///< out of the object
  double top = 0;                           ///< normal.x of the feature's highest point [m]
  Real distance = 0;                        ///< of the cloth's feature from it [m]
  Real keep = 0;                            ///< height that particles keep besides [m]
};

/// What is to be done about features of the cloth and a mesh that could meet.
template <class Real>
struct ContactLook {
  Real reach = 0;        ///< that none of the cloth's particles goes beyond [m]
  bool carried = false;  ///< particles alone keep the cloth off: it is only certified
};

}  // namespace weft
