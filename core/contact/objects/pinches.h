#pragma once

#include <cstddef>
#include <vector>

#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_rows.h"
#include "core/types.h"

// Single layers of cloth between an object that comes and another object.

namespace weft {

/// A row on one side of a pinch.
struct PinchRow {
  std::size_t row = 0;
  std::size_t object = 0;  ///< that presses: the row's own, or the one on the other side
  std::size_t other = 0;   ///< of the two the one that the row does not belong to
};

/// What is pinched in this substep. A layer between two objects gives way to neither. Solved row by
/// row it would resist by its own mass, however hard it is pressed; so an object that comes stands
/// there, and presses it with its force as jaws do (share_hold).
struct Pinches {
  std::vector<PinchRow> fronts;  ///< rows of objects that come
  std::vector<PinchRow> backs;   ///< those of the other objects, on the other side of the cloth

  /// A row that is near a particle.
  struct Touch {
    std::size_t row = 0;
    Index next = kNone;  ///< another one of the particle
  };
  std::vector<Touch> touches;      ///< of the particles of `fronts`
  std::vector<Index> first_touch;  ///< of each particle; kNone: it is in no row of `fronts`
  std::vector<Index> particles;    ///< in rows of `fronts`

  /// All rows of an object.
  struct Facing {
    Vec3d normals = Vec3d::Zero();  ///< their sum
    int rows = 0;
  };
  std::vector<Facing> facing;  ///< of each object, if one pinches
};

/// Finds what is pinched, and tells it to the objects: `pinch` of ColliderState.
template <class Real>
void find_pinches(const ObjectRows<Real>& rows, const Vec3Array<Real>& x,
                  ObjectMotion<Real>& motion, Pinches& pinches);

}  // namespace weft
