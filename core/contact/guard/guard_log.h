#pragma once

#include <vector>

#include "core/contact/contact_tally.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/stopped_particles.h"
#include "core/types.h"

// What cloths press each other with over a tick, and their contacts as read-outs and the wire
// report them.

namespace weft {

/// Impulses of a tick by pairs of features, if they are wanted.
struct GuardLog {
  bool wanted = false;
  bool begun = false;      ///< a step of the tick has been made
  double force_ratio = 1;  ///< see Collision::before_drift
  ContactTally tally;
};

/// Forgets what was logged: a tick begins, or it is not wanted.
void clear_log(GuardLog& log);

/// Adds what a row has pushed [N s].
template <class Real>
void log_impulse(const GuardRow<Real>& row, const Vec3d& impulse, GuardLog& log);

/// Adds what stopped pairs have pushed.
template <class Real>
void log_meetings(const std::vector<StoppedPair<Real>>& pairs, GuardLog& log);

/// Contacts of cloths with themselves and each other: pairs that pushed in the tick, with their
/// mean forces over it, and rows whose features touch.
/// @param x        positions now [m]
/// @param seconds  of the tick
template <class Real>
std::vector<ContactPoint> contacts_of(const GuardLog& log, const std::vector<GuardRow<Real>>& rows,
                                      const Vec3Array<Real>& x, double seconds);

}  // namespace weft
