// Stops objects before particles that were stopped.

#include "core/contact/objects/mover_stops.h"

#include <algorithm>
#include <cassert>

#include "core/contact/objects/moving_rows.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Finds particles that were stopped, or sent elsewhere, since the rows were certified.
template <class Real>
bool find_stopped(const ClothState<Real>& state, MoverStops<Real>& stops) {
  assert(stops.x.size() == state.x.size() && stops.v.size() == state.x.size());
  stops.is_stopped.assign(state.x.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.x[i] == stops.x[i] && state.v[i] == stops.v[i]) continue;
    stops.is_stopped[i] = 1;
    any = true;
  }
  return any;
}

/// Whether particle k of a row ends where it may, if its object moves as it is said to now. How far
/// particles go does not matter here: displacements that were within reach have only become
/// shorter. What is still led out of the object is on the wrong side anyway.
template <class Real>
bool ends_legally(const StoppedStep<Real>& step, const ContactRow<Real>& row, std::size_t k) {
  const auto i = at_index(row.particle[k]);
  const Real now = row.normal.dot(step.state.x[i]) - row.offset;
  if (now < step.smallest_gap && step.rows.leads_out(row)) return true;
  const Real start = row.normal.dot(step.x_unpushed[i]) - row.offset;
  const Real end =
      height_after<Real>(step.rows, step.shapes, row, step.state.x[i] + step.state.v[i] * step.dt);
  return end >= std::min(start, step.smallest_gap);
}

/// Whether a particle of a row was stopped and does not end where it may.
template <class Real>
bool hits_stopped(const StoppedStep<Real>& step, const std::vector<char>& is_stopped,
                  const ContactRow<Real>& row, std::size_t k) {
  return is_stopped[at_index(row.particle[k])] && !ends_legally(step, row, k);
}

/// Stops the objects that would go into particles that were stopped.
/// @return whether there are any
template <class Real>
bool block_before_stopped(StoppedStep<Real>& step, const std::vector<char>& is_stopped) {
  bool any = false;
  for (const MovingRow<Real>& moving : step.rows.moving) {
    const ContactRow<Real>& row = step.rows.all[moving.row];
    if (!step.shapes.frames[moving.collider].moves) continue;
    ColliderState& collider = (*step.motion.colliders)[moving.collider];
    for (std::size_t k = 0; k < row.count; ++k) {
      if (!hits_stopped(step, is_stopped, row, k)) continue;
      if (collider.forced) {
        collider.voided = true;
        continue;
      }
      block_object(moving.collider, step.shapes, step.motion);
      any = true;
      break;
    }
  }
  return any;
}

/// Whether no particle follows an object so closely that it may not stand still.
template <class Real>
bool may_stand(const StoppedStep<Real>& step) {
  for (const MovingRow<Real>& moving : step.rows.moving) {
    if (!step.shapes.frames[moving.collider].blocked) continue;
    const ContactRow<Real>& row = step.rows.all[moving.row];
    for (std::size_t k = 0; k < row.count; ++k) {
      if (!ends_legally(step, row, k)) return false;
    }
  }
  return true;
}

/// Nothing moves, but for objects that are forced to: that is always allowed.
template <class Real>
void halt_all(StoppedStep<Real>& step) {
  step.state.x = step.x_unpushed;
  for (Vec3<Real>& v : step.state.v) v.setZero();
  for (const MovingRow<Real>& moving : step.rows.moving) {
    ColliderState& collider = (*step.motion.colliders)[moving.collider];
    if (!step.shapes.frames[moving.collider].moves) continue;
    if (!collider.forced) {
      block_object(moving.collider, step.shapes, step.motion);
      continue;
    }
    const ContactRow<Real>& row = step.rows.all[moving.row];
    for (std::size_t k = 0; k < row.count; ++k) collider.voided |= !ends_legally(step, row, k);
  }
}

}  // namespace

template <class Real>
bool stand_before_stopped(StoppedStep<Real>& step, MoverStops<Real>& stops) {
  assert(step.motion.colliders && step.dt > 0);
  if (!find_stopped(step.state, stops) || !block_before_stopped(step, stops.is_stopped) ||
      may_stand(step))
    return true;
  halt_all(step);
  return false;
}

WEFT_INSTANTIATE_FUNCTIONS(stand_before_stopped)

}  // namespace weft
