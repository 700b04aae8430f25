#pragma once

#include <algorithm>
#include <cassert>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/contact_log.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/object_shapes.h"
#include "core/types.h"

// Rows whose planes go with an object.

namespace weft {

/// Height that must be left above a row's plane, unless it is less already [m].
/// @param moves  the object does
template <class Real>
Real least_height(const ContactRow<Real>& row, bool moves, Real smallest_gap) {
  assert(smallest_gap > 0 && row.thickness >= 0);
  return moves ? std::max(smallest_gap, row.thickness * Real(kMoverGap)) : row.keep;
}

/// How high above a plane at rest a particle must be after the coming drift that is at a height now
/// [m]. What is nearer than it keeps must not come nearer, rounding included.
template <class Real>
Real least_end(const ContactRow<Real>& row, Real now, Real smallest_gap) {
  return now < 0 ? now : std::min(now + smallest_gap / 16, row.keep);
}

/// How high above the row's plane a particle will be that is at `end` after the substep, the object
/// having moved [m].
template <class Real>
Real height_after(const ObjectRows<Real>& rows, const ObjectShapes<Real>& shapes,
                  const ContactRow<Real>& row, const Vec3<Real>& end) {
  if (const MovingRow<Real>* moving = rows.moving_of(row)) {
    const ColliderFrame<Real>& frame = shapes.frames[moving->collider];
    if (frame.moves) return row.normal.dot(frame.taken_back(end)) - row.offset;
  }
  return row.normal.dot(end) - row.offset;
}

/// Books what each object that moves has given to the cloth in a step: impulse and work. Call it
/// once the rows are solved: sweeps give some of them a part each, hundreds of times in a tick.
/// @param x  positions, as the rows were solved at [m]
template <class Real>
void book_reactions(const Vec3Array<Real>& x, ObjectRows<Real>& rows, ObjectMotion<Real>& motion,
                    ContactLog& log);

/// Turns the rows that go with objects, after these have moved.
template <class Real>
void turn_with_objects(const ObjectShapes<Real>& shapes, ContactLog& log, ObjectRows<Real>& rows);

}  // namespace weft
