// Objects that move, in Contact: their frames, the planes that go with them, what they do to the
// cloth and the cloth to them, and how they stand still where cloth cannot give way.

#include <algorithm>
#include <cmath>

#include "core/contact/objects/contact.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Rounds of projection on violated planes before somebody is held.
constexpr int kCertifyRounds = 3;

/// What an object that moves must leave between itself and the cloth; more than one at rest, so
/// that cloth in a pinch stops it before there is no room for rounding [part of the thickness].
constexpr double kMoverGap = 0.25;

/// An object that cloth has stopped stands for so many further substeps, in which the cloth is not
/// pushed and can make way; and for so many may be stopped again.
constexpr int kRest = 2, kWary = 16;

/// Rounding of a particle that is carried along [m].
constexpr double kCarrySlack = 1e-6;

}  // namespace

/// Puts the shapes of one collider where it is.
template <class Real>
void Contact<Real>::place_collider(std::size_t collider, const Pose& pose) {
  ColliderFrame<Real>& frame = frames_[collider];
  if (pose == frame.pose) return;
  frame.place(pose);
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    if (planes_[k].collider != collider) continue;
    planes_[k].offset = own_planes_[k].offset;
    if (frame.displaced) planes_[k].offset += planes_[k].normal.dot(frame.shift);
  }
  for (std::size_t k = 0; k < balls_.size(); ++k) {
    if (balls_[k].collider == collider) balls_[k].centre = frame.world(own_balls_[k].centre);
  }
  for (std::size_t k = 0; k < rods_.size(); ++k) {
    if (rods_[k].collider != collider) continue;
    rods_[k].a = frame.world(own_rods_[k].a);
    rods_[k].b = frame.world(own_rods_[k].b);
  }
}

template <class Real>
void Contact<Real>::place(const ColliderStates& colliders) {
  for (std::size_t k = 0; k < frames_.size(); ++k) place_collider(k, colliders[k].pose);
}

/// Objects that have been resisted by more than their force stand in the coming substep, and both
/// jaws if one does.
template <class Real>
void Contact<Real>::stop_overloaded(double dt) {
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    ColliderState& state = (*colliders_)[k];
    if (!frames_[k].tracked || !count_resistance(dt, state)) continue;
    frames_[k].rest = std::max(frames_[k].rest, 1);
    if (state.mate == kNone) continue;
    ColliderFrame<Real>& mate = frames_[static_cast<std::size_t>(state.mate)];
    mate.rest = std::max(mate.rest, 1);
  }
}

/// How each object moves in the coming substep.
template <class Real>
void Contact<Real>::plan_colliders(Real dt) {
  way_step_ = way_rows_ = gone_ = 0;
  if (!colliders_) return;
  stop_overloaded(static_cast<double>(dt));
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    ColliderFrame<Real>& frame = frames_[k];
    frame.wary = std::max(0, frame.wary - 1);
    frame.blocked = frame.tracked && frame.rest > 0 && !(*colliders_)[k].forced;
    if (frame.tracked && !frame.blocked)
      frame.plan((*colliders_)[k], static_cast<double>(dt), static_cast<double>(tick_seconds_));
    else
      frame.stand();
    if (frame.blocked) (*colliders_)[k].blocked = true;
    frame.rest = frame.blocked ? frame.rest - 1 : 0;
    way_step_ = std::max(way_step_, frame.travel);
    way_rows_ = std::max(way_rows_, frame.travel_since_rows + frame.travel);
    gone_ = std::max(gone_, frame.travel_since_pairs);
  }
}

/// Moves the objects on, with the planes that go with them.
template <class Real>
void Contact<Real>::move_colliders(Real dt) {
  if (!any_tracked_) return;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    ColliderFrame<Real>& frame = frames_[k];
    ColliderState& state = (*colliders_)[k];
    if (!frame.tracked || frame.blocked) continue;
    advance_collider(static_cast<double>(dt), static_cast<double>(tick_seconds_), state);
    place_collider(k, state.pose);
    frame.travel_since_pairs += frame.travel;
    frame.travel_since_rows += frame.travel;
  }
  for (const MovingRow<Real>& moving : moving_rows_) {
    const ColliderFrame<Real>& frame = frames_[moving.collider];
    if (!frame.moves) continue;
    const Vec3d normal = frame.pose.rotation * moving.own_normal;
    const Vec3d shift = frame.pose.position - frame.pose.rotation * frame.pivot;
    ContactRow<Real>& row = rows_[moving.row];
    const Vec3<Real> turned = normal.template cast<Real>();
    if (log_.wanted() && turned != row.normal) log_.before_turn(rows_, moving.row);
    row.normal = turned;
    row.offset = static_cast<Real>(moving.own_offset + normal.dot(shift));
  }
}

/// Active particles as the displaced meshes see them.
template <class Real>
void Contact<Real>::take_to_own(const Vec3Array<Real>& x) {
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const ColliderFrame<Real>& frame = frames_[mesh_collider_[m]];
    if (!frame.displaced) continue;
    x_own_[m].resize(x.size());
    for (const Index i : active_particles_) {
      const auto p = static_cast<std::size_t>(i);
      x_own_[m][p] = frame.own(x[p]);
    }
  }
}

/// The particles in the frame of a mesh, after `take_to_own`; only the active ones may be looked
/// at.
template <class Real>
const Vec3Array<Real>& Contact<Real>::in_frame_of(std::size_t mesh,
                                                  const Vec3Array<Real>& x) const {
  return frames_[mesh_collider_[mesh]].displaced ? x_own_[mesh] : x;
}

/// Makes the row about to be added go with its object.
template <class Real>
void Contact<Real>::follow(const ContactRow<Real>& row, double top, std::size_t collider,
                           Real mobility) {
  const ColliderFrame<Real>& frame = frames_[collider];
  const Vec3d normal = row.normal.template cast<double>();
  const Vec3d shift = frame.pose.position - frame.pose.rotation * frame.pivot;
  MovingRow<Real> moving;
  moving.row = rows_.size();
  moving.collider = collider;
  moving.own_normal = frame.pose.rotation.conjugate() * normal;
  moving.own_offset = top - normal.dot(shift);
  moving.mobility = mobility;
  moving_rows_.push_back(moving);
}

/// Books what an object gave to the cloth: impulse and work.
/// @param change  of the velocity of the row's point [m/s]
template <class Real>
void Contact<Real>::take_reaction(const ContactRow<Real>& row, const Vec3<Real>& point,
                                  const Vec3<Real>& change) {
  const MovingRow<Real>& moving = moving_rows_[static_cast<std::size_t>(row.mover)];
  ColliderState& state = (*colliders_)[moving.collider];
  const Vec3d impulse = (change / moving.mobility).template cast<double>();
  state.impulse += impulse;
  state.angular_impulse += (point.template cast<double>() - state.pose.position).cross(impulse);
  work_ += impulse.dot(moving.surface.template cast<double>());
}

/// How high above the row's plane a particle will be that is at `end` after the substep, the object
/// having moved [m].
template <class Real>
Real Contact<Real>::height_after(const ContactRow<Real>& row, const Vec3<Real>& end) const {
  if (row.mover != kNone) {
    const auto& frame = frames_[moving_rows_[static_cast<std::size_t>(row.mover)].collider];
    if (frame.moves) return row.normal.dot(frame.taken_back(end)) - row.offset;
  }
  return row.normal.dot(end) - row.offset;
}

/// What must be left above a row's plane, unless it is less already [m].
template <class Real>
Real Contact<Real>::least_height(const ContactRow<Real>& row, bool moves) const {
  return moves ? std::max(smallest_gap_, row.thickness * Real(kMoverGap)) : row.keep;
}

/// Between objects that close, or where cloth is drawn between two, one pushes it out into the
/// other: who came too near to any plane goes back to where it was. What started inside is led out
/// however its edges lie.
template <class Real>
void Contact<Real>::take_back_pushes(ClothState<Real>& state) {
  const auto still_leaves = [this](const ContactRow<Real>& row) {
    return row.mover == kNone &&
           std::any_of(exits_.begin(), exits_.end(), [&row](const BadStart<Real>& exit) {
             return static_cast<Index>(exit.collider) == row.collider && exit.cloth == row.cloth;
           });
  };
  for (const ContactRow<Real>& row : rows_) {
    if (!exits_.empty() && still_leaves(row)) continue;
    const Real wanted = least_height(row, row.mover != kNone);
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      const auto i = static_cast<std::size_t>(row.particle[k]);
      if (state.x[i] == x_unpushed_[i]) continue;
      const Real before = row.normal.dot(x_unpushed_[i]) - row.offset;
      if (row.normal.dot(state.x[i]) - row.offset < std::min(before, wanted))
        state.x[i] = x_unpushed_[i];
    }
  }
}

/// By how much a particle of a row follows an object more closely than it may where that could be
/// stopped: so that it can stand still, nobody goes to where it still is [m].
template <class Real>
Real Contact<Real>::lack_behind(const ContactRow<Real>& row, std::size_t i,
                                const ClothState<Real>& state, Real dt) const {
  const auto& frame = frames_[moving_rows_[static_cast<std::size_t>(row.mover)].collider];
  if (frame.wary == 0 || !frame.moves) return 0;
  const Real now = row.normal.dot(state.x[i]) - row.offset;
  const Real end = row.normal.dot(state.x[i] + state.v[i] * dt) - row.offset;
  return least_end(row, now) - end;
}

/// Lifts each particle of a row off an object that comes, or holds it back from one that goes.
/// @return whether anybody had to be lifted, or could not
template <class Real>
bool Contact<Real>::keep_off_mover(const ContactRow<Real>& row, ClothState<Real>& state, Real dt) {
  const auto& frame = frames_[moving_rows_[static_cast<std::size_t>(row.mover)].collider];
  bool kept = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
    const auto i = static_cast<std::size_t>(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = height_after(row, state.x[i] + state.v[i] * dt);
    const Real least = std::min(now, least_height(row, true));
    const Real behind = end >= least ? lack_behind(row, i, state, dt) : Real(0);
    if (end >= least && !(behind > 0)) continue;
    const bool held = state.inverse_mass[i] == 0;
    if (held && !frame.moves) continue;
    kept = true;
    if (held) continue;
    const Vec3<Real> before = state.v[i];
    const Vec3<Real> normal = behind > 0 ? row.normal : (frame.turn * row.normal).eval();
    state.v[i] += normal * (std::max(least - end, behind) / dt * Real(1.0001));
    const Real gained = (state.v[i].squaredNorm() - before.squaredNorm()) / 2;
    work_ += std::max(0.0, static_cast<double>(gained / state.inverse_mass[i]));
    if (log_.wanted()) log_stop(row, k, before, state);
  }
  return kept;
}

/// The certificate where objects move.
template <class Real>
void Contact<Real>::certify_with_movers(ClothState<Real>& state, Real dt) {
  bool kept = true;
  for (int round = 0; round < kCertifyRounds && kept; ++round) {
    kept = false;
    for (const ContactRow<Real>& row : rows_)
      kept |= row.mover != kNone ? keep_off_mover(row, state, dt) : keep_off(row, false, state, dt);
  }
  // Whoever still would cross is carried along by its object, if that is legal; else objects stand,
  // one after the other. When all stand, not moving is legal.
  bool carry = true;
  while (hold_or_block(carry, state, dt)) {
    stop_point();
    carry = false;
  }
}

/// Holds whoever would cross a plane of an object at rest or go beyond its reach, and carries or
/// stops at planes of objects that move. Each time either an object stands that moved or only
/// particles that moved are held, so this ends.
/// @return whether something was changed, so that it must be looked at again
template <class Real>
bool Contact<Real>::hold_or_block(bool carry, ClothState<Real>& state, Real dt) {
  bool changed = false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3<Real> end = state.x[i] + state.v[i] * dt;
    const Real reach = row_reach_[i] - way_rows_;
    if ((end - x_rows_[i]).squaredNorm() <= reach * std::abs(reach) || state.v[i].isZero(0))
      continue;
    state.v[i].setZero();
    changed = true;
  }
  for (const ContactRow<Real>& row : rows_) changed |= hold_row(row, carry, state, dt);
  return changed;
}

template <class Real>
bool Contact<Real>::hold_row(const ContactRow<Real>& row, bool carry, ClothState<Real>& state,
                             Real dt) {
  const bool mover = row.mover != kNone;
  const std::size_t collider =
      mover ? moving_rows_[static_cast<std::size_t>(row.mover)].collider : 0;
  bool changed = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
    const auto i = static_cast<std::size_t>(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = height_after(row, state.x[i] + state.v[i] * dt);
    const bool moves = mover && frames_[collider].moves;
    Real least = moves ? std::min(now, smallest_gap_) : least_end(row, now);
    if (moves) least = std::max(least, std::min(now, least_height(row, true)) - Real(kCarrySlack));
    const bool held = state.inverse_mass[i] == 0;
    const Vec3<Real> before = state.v[i];
    if (end >= least) {
      if (!moves || held || before.isZero(0) || !(lack_behind(row, i, state, dt) > 0)) continue;
      state.v[i].setZero();
    } else if (moves && carry && !held) {
      state.v[i] = frames_[collider].velocity_at(state.x[i]);
    } else if (moves && (*colliders_)[collider].forced) {
      (*colliders_)[collider].voided = true;
      continue;
    } else if (moves) {
      block(collider);
    } else if (!held && !state.v[i].isZero(0)) {
      state.v[i].setZero();
    } else {
      continue;
    }
    if (log_.wanted() && !held) log_stop(row, k, before, state);
    changed = true;
  }
  return changed;
}

/// Makes an object stand still in the coming substep, and its mate with it.
template <class Real>
void Contact<Real>::block(std::size_t collider) {
  const auto stop = [this](std::size_t k) {
    frames_[k].stand();
    frames_[k].blocked = true;
    frames_[k].rest = kRest;
    frames_[k].wary = kWary;
    (*colliders_)[k].blocked = true;
  };
  stop(collider);
  const Index mate = (*colliders_)[collider].mate;
  if (mate != kNone) stop(static_cast<std::size_t>(mate));
  way_rows_ = 0;
  for (const ColliderFrame<Real>& frame : frames_)
    way_rows_ = std::max(way_rows_, frame.travel_since_rows + frame.travel);
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template void Contact<Real>::place_collider(std::size_t, const Pose&);                          \
  template void Contact<Real>::place(const ColliderStates&);                                      \
  template void Contact<Real>::stop_overloaded(double);                                           \
  template void Contact<Real>::plan_colliders(Real);                                              \
  template void Contact<Real>::move_colliders(Real);                                              \
  template void Contact<Real>::take_to_own(const Vec3Array<Real>&);                               \
  template const Vec3Array<Real>& Contact<Real>::in_frame_of(std::size_t, const Vec3Array<Real>&) \
      const;                                                                                      \
  template void Contact<Real>::follow(const ContactRow<Real>&, double, std::size_t, Real);        \
  template void Contact<Real>::take_reaction(const ContactRow<Real>&, const Vec3<Real>&,          \
                                             const Vec3<Real>&);                                  \
  template Real Contact<Real>::height_after(const ContactRow<Real>&, const Vec3<Real>&) const;    \
  template bool Contact<Real>::keep_off_mover(const ContactRow<Real>&, ClothState<Real>&, Real);  \
  template void Contact<Real>::certify_with_movers(ClothState<Real>&, Real);                      \
  template bool Contact<Real>::hold_or_block(bool, ClothState<Real>&, Real);                      \
  template bool Contact<Real>::hold_row(const ContactRow<Real>&, bool, ClothState<Real>&, Real);  \
  template void Contact<Real>::block(std::size_t);                                                \
  template Real Contact<Real>::lack_behind(const ContactRow<Real>&, std::size_t,                  \
                                           const ClothState<Real>&, Real) const;                  \
  template Real Contact<Real>::least_height(const ContactRow<Real>&, bool) const;                 \
  template void Contact<Real>::take_back_pushes(ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
