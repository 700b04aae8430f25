#pragma once

#include "core/contact/colliders/collider_state.h"
#include "core/contact/objects/object_shapes.h"
#include "core/types.h"

// How objects move in a tick and in its substeps, and how they stand still where cloth cannot
// yield.

namespace weft {

/// Motion of all objects in the running tick.
template <class Real>
struct ObjectMotion {
  ColliderStates* colliders = nullptr;  ///< null: all stand as defined
  Real tick_seconds = 0;
  bool any_tracked = false;  ///< one of them moves in this tick
  bool any_press = false;    ///< one of them presses, as jaws do
  Real surface_speed = 0;    ///< of the fastest [m/s]
  Real since_pairs = 0;      ///< longest displacement since the pairs were collected [m]
  Real since_rows = 0;       ///< since the rows were made, with the coming substep [m]
  Real coming = 0;           ///< in the coming substep alone [m]
  double force_ratio = 1;    ///< see Collision::before_drift
  double work = 0;           ///< on the cloth in this tick [J]

  /// No object moves, or has moved since the lists were made.
  bool is_still() const {
    return !any_tracked && since_rows == 0 && coming == 0 && since_pairs == 0;
  }
};

/// Begins a tick.
/// @return whether rows have to be made anew
template <class Real>
bool begin_motion(double tick_seconds, ColliderStates* colliders, ObjectShapes<Real>& shapes,
                  ObjectMotion<Real>& motion);

/// Plans how each object moves in the coming substep. Objects that have been resisted by more than
/// their force stand.
template <class Real>
void plan_objects(Real dt, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion);

/// Moves the objects on as planned.
template <class Real>
void advance_objects(Real dt, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion);

/// Makes an object stand still in the coming substep, and its mate with it.
template <class Real>
void block_object(std::size_t collider, ObjectShapes<Real>& shapes, ObjectMotion<Real>& motion);

}  // namespace weft
