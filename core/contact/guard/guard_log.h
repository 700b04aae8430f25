#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/stopped_particles.h"
#include "core/types.h"

// What cloths press each other with, over a tick.

namespace weft {

/// What the features of a pair have got from each other in a tick.
struct LoggedPair {
  std::uint64_t key = 0;
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<double, 4> weight = {0, 0, 0, 0};  ///< of its last row
  Vec3d normal = Vec3d::Zero();   ///< likewise, unit, from the second feature to the first
  Vec3d impulse = Vec3d::Zero();  ///< on the first feature [N s]
  Index next = kNone;             ///< another pair with the same first particle
};

/// Impulses of a tick by pairs, if they are wanted.
struct GuardLog {
  bool wanted = false;
  bool begun = false;             ///< a step of the tick has been made
  std::vector<LoggedPair> pairs;  ///< in the order in which they first pushed
  std::vector<Index> first;       ///< of each particle the last pair whose first one it is
};

/// Forgets what was logged: a tick begins, or it is not wanted.
void clear_log(GuardLog& log);

/// Adds what a row has pushed [N s].
template <class Real>
void log_impulse(const GuardRow<Real>& row, const Vec3d& impulse, GuardLog& log);

/// Adds what stopped pairs have pushed.
template <class Real>
void log_meetings(const std::vector<StoppedPair<Real>>& pairs, GuardLog& log);

/// Whether a pair has pushed in this tick.
bool is_logged(const GuardLog& log, std::uint64_t key, Index first);

}  // namespace weft
