// Certifies a drift where objects move: what they meet is lifted or carried along, and where cloth
// cannot yield the object stands still.

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/moving_rows.h"
#include "core/contact/objects/object_certificate.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// By how much a particle of a row follows an object more closely than it may where that could be
/// stopped: so that it can stand still, no particle goes to where it still is [m].
template <class Real>
Real lack_behind(const ObjectCertificate<Real>& c, const ContactRow<Real>& row, std::size_t i) {
  assert(c.rows.moving_of(row));
  const ColliderFrame<Real>& frame = c.shapes.frames[c.rows.moving_of(row)->collider];
  if (frame.wary == 0 || !frame.moves) return 0;
  const Real now = row.normal.dot(c.state.x[i]) - row.offset;
  const Real end = row.normal.dot(c.state.x[i] + c.state.v[i] * c.dt) - row.offset;
  return least_end(row, now, c.smallest_gap) - end;
}

/// Lifts each particle of a row off an object that comes, or holds it back from one that goes.
/// @return whether any had to be lifted, or could not
template <class Real>
bool keep_off_mover(ObjectCertificate<Real>& c, const ContactRow<Real>& row) {
  ClothState<Real>& state = c.state;
  const ColliderFrame<Real>& frame = c.shapes.frames[c.rows.moving_of(row)->collider];
  bool kept = false;
  for (std::size_t k = 0; k < row.count; ++k) {
    const auto i = at_index(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = height_after<Real>(c.rows, c.shapes, row, state.x[i] + state.v[i] * c.dt);
    const Real least = std::min(now, least_height(row, true, c.smallest_gap));
    const Real behind = end >= least ? lack_behind(c, row, i) : Real(0);
    if (end >= least && !(behind > 0)) continue;
    const bool held = state.inverse_mass[i] == 0;
    if (held && !frame.moves) continue;
    kept = true;
    if (held) continue;
    const Vec3<Real> before = state.v[i];
    const Vec3<Real> normal = behind > 0 ? row.normal : (frame.turn * row.normal).eval();
    state.v[i] += normal * (std::max(least - end, behind) / c.dt * Real(kLiftSlack));
    const Real gained = (state.v[i].squaredNorm() - before.squaredNorm()) / 2;
    c.motion.work +=
        std::max(0.0, static_cast<double>(gained / state.inverse_mass[i])) * c.motion.force_ratio;
    tell_stop(c, row, k, before);
  }
  return kept;
}

/// Holds the particles of a row that would cross its plane if its object rests; if it moves, they
/// are carried along, or else it stands. It stands before nothing that it still has to lead out:
/// that is on the wrong side anyway.
/// @return whether something was changed
template <class Real>
bool hold_row(ObjectCertificate<Real>& c, const ContactRow<Real>& row, bool carry) {
  ClothState<Real>& state = c.state;
  const MovingRow<Real>* const mover = c.rows.moving_of(row);
  const std::size_t collider = mover ? mover->collider : 0;
  bool changed = false;
  for (std::size_t k = 0; k < row.count; ++k) {
    const auto i = at_index(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = height_after<Real>(c.rows, c.shapes, row, state.x[i] + state.v[i] * c.dt);
    const bool moves = mover && c.shapes.frames[collider].moves;
    Real least = moves ? std::min(now, c.smallest_gap) : least_end(row, now, c.smallest_gap);
    if (moves)
      least = std::max(now < 0 ? now - Real(kCarrySlack) : least,
                       std::min(now, least_height(row, true, c.smallest_gap)) - Real(kCarrySlack));
    const bool held = state.inverse_mass[i] == 0;
    const Vec3<Real> before = state.v[i];
    if (end >= least) {
      if (!moves || held || before.isZero(0) || !(lack_behind(c, row, i) > 0)) continue;
      state.v[i].setZero();
    } else if (moves && carry && !held) {
      state.v[i] = c.shapes.frames[collider].velocity_at(state.x[i]);
    } else if (moves && now < c.smallest_gap && c.rows.leads_out(row)) {
      continue;
    } else if (moves && (*c.motion.colliders)[collider].forced) {
      (*c.motion.colliders)[collider].voided = true;
      continue;
    } else if (moves) {
      block_object(collider, c.shapes, c.motion);
    } else if (!held && !state.v[i].isZero(0)) {
      state.v[i].setZero();
    } else {
      continue;
    }
    if (!held) tell_stop(c, row, k, before);
    changed = true;
  }
  return changed;
}

/// Holds particles that would cross a plane of an object at rest or go beyond their reach, and
/// carries or stops at planes of objects that move. Each time either an object stands that moved or
/// only particles that moved are held, so this ends.
/// @return whether something was changed, so that it must be examined again
template <class Real>
bool hold_or_block(ObjectCertificate<Real>& c, bool carry) {
  ClothState<Real>& state = c.state;
  bool changed = false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3<Real> end = state.x[i] + state.v[i] * c.dt;
    const Real reach = c.reach.reach[i] - c.motion.since_rows;
    if ((end - c.reach.x[i]).squaredNorm() <= reach * std::abs(reach) || state.v[i].isZero(0))
      continue;
    state.v[i].setZero();
    changed = true;
  }
  for (const ContactRow<Real>& row : c.rows.all) changed |= hold_row(c, row, carry);
  return changed;
}

}  // namespace

template <class Real>
void certify_with_movers(ObjectCertificate<Real>& c) {
  bool kept = false;
  const auto keep = [&](const ContactRow<Real>& row) {
    kept |= row.mover != kNone ? keep_off_mover(c, row) : keep_off(c, row, false);
  };
  const bool within = measure_travel(c.state, c.dt, c.motion.since_rows, c.executor, c.reach);
  for_near_rows(c, keep);
  if (within && !kept) return;
  for (int round = 1; round < kCertifyRounds && kept; ++round) {
    kept = false;
    for (const ContactRow<Real>& row : c.rows.all) keep(row);
  }
  // A particle that still would cross is carried along by its object, if that is legal; else
  // objects stand, one after the other. When all stand, not moving is legal.
  bool carry = true;
  while (hold_or_block(c, carry)) {
    stop_point();
    carry = false;
  }
}

WEFT_INSTANTIATE_FUNCTIONS(certify_with_movers)

}  // namespace weft
