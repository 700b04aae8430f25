#pragma once

#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/object_shapes.h"
#include "core/types.h"

// Moving objects when self-collision has truncated a particle's displacement after contact with
// objects was certified: what holds cloth off cloth may stop a particle before an object that
// comes.

namespace weft {

/// As certified, while objects move: a particle that is elsewhere then was stopped by others.
template <class Real>
struct MoverStops {
  Vec3Array<Real> x, v;  ///< [m], [m/s]
  std::vector<char> is_stopped;
};

/// The substep in which particles may have been stopped.
template <class Real>
struct StoppedStep {
  ObjectShapes<Real>& shapes;  ///< objects are blocked
  ObjectMotion<Real>& motion;
  const ObjectRows<Real>& rows;
  const Vec3Array<Real>& x_unpushed;  ///< positions before the push-out [m]
  ClothState<Real>& state;
  Real smallest_gap;  ///< [m]
  Real dt;            ///< [s]
};

/// Lets objects stand still that would go into particles that were stopped since the certificate.
/// Where that is not enough, as others follow an object too closely, nothing moves at all, but for
/// objects that are forced to.
/// @return whether anything may move
template <class Real>
bool stand_before_stopped(StoppedStep<Real>& step, MoverStops<Real>& stops);

}  // namespace weft
