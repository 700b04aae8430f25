// Objects that move, in Contact, where somebody else has the last word: what holds cloth off cloth
// may stop a particle before an object that comes.

#include <algorithm>

#include "core/contact/objects/contact.h"

namespace weft {

/// Notes who was stopped, or sent elsewhere, since the rows were certified.
template <class Real>
bool Contact<Real>::find_stopped(const ClothState<Real>& state) {
  is_stopped_.assign(state.x.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.x[i] == x_certified_[i] && state.v[i] == v_certified_[i]) continue;
    is_stopped_[i] = 1;
    any = true;
  }
  return any;
}

/// Whether particle k of a row ends where it may, if its object moves as it is said to now. How far
/// anybody goes does not matter here: ways that were within reach have only become shorter.
template <class Real>
bool Contact<Real>::ends_legally(const ContactRow<Real>& row, std::size_t k,
                                 const ClothState<Real>& state, Real dt) const {
  const auto i = static_cast<std::size_t>(row.particle[k]);
  const Real start = row.normal.dot(x_unpushed_[i]) - row.offset;
  return height_after(row, state.x[i] + state.v[i] * dt) >= std::min(start, smallest_gap_);
}

/// Stops the objects that would go into somebody who was stopped.
/// @return whether there are any
template <class Real>
bool Contact<Real>::block_before_stopped(const ClothState<Real>& state, Real dt) {
  bool any = false;
  for (const MovingRow<Real>& moving : moving_rows_) {
    const ContactRow<Real>& row = rows_[moving.row];
    if (!frames_[moving.collider].moves) continue;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      if (!is_stopped_[static_cast<std::size_t>(row.particle[k])] ||
          ends_legally(row, k, state, dt))
        continue;
      if ((*colliders_)[moving.collider].forced) {
        (*colliders_)[moving.collider].voided = true;
        continue;
      }
      block(moving.collider);
      any = true;
      break;
    }
  }
  return any;
}

/// Whether nobody follows an object so closely that it may not stand still.
template <class Real>
bool Contact<Real>::may_stand(const ClothState<Real>& state, Real dt) const {
  for (const MovingRow<Real>& moving : moving_rows_) {
    if (!frames_[moving.collider].blocked) continue;
    const ContactRow<Real>& row = rows_[moving.row];
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      if (!ends_legally(row, k, state, dt)) return false;
    }
  }
  return true;
}

/// Nobody moves at all, but for objects that are forced to: that is always allowed.
template <class Real>
void Contact<Real>::halt(ClothState<Real>& state, Real dt) {
  state.x = x_unpushed_;
  for (Vec3<Real>& v : state.v) v.setZero();
  for (const MovingRow<Real>& moving : moving_rows_) {
    ColliderState& collider = (*colliders_)[moving.collider];
    if (!frames_[moving.collider].moves) continue;
    if (!collider.forced) {
      block(moving.collider);
      continue;
    }
    const ContactRow<Real>& row = rows_[moving.row];
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
      collider.voided |= !ends_legally(row, k, state, dt);
  }
}

template <class Real>
bool Contact<Real>::move_objects(ClothState<Real>& state, Real dt, bool truncated) {
  bool moved = true;
  if (any_tracked_ && truncated && !moving_rows_.empty() && find_stopped(state) &&
      block_before_stopped(state, dt) && !may_stand(state, dt)) {
    halt(state, dt);
    moved = false;
  }
  move_colliders(dt);
  return moved;
}

#define WEFT_INSTANTIATE(Real)                                                      \
  template bool Contact<Real>::find_stopped(const ClothState<Real>&);               \
  template bool Contact<Real>::ends_legally(const ContactRow<Real>&, std::size_t,   \
                                            const ClothState<Real>&, Real) const;   \
  template bool Contact<Real>::block_before_stopped(const ClothState<Real>&, Real); \
  template bool Contact<Real>::may_stand(const ClothState<Real>&, Real) const;      \
  template void Contact<Real>::halt(ClothState<Real>&, Real);                       \
  template bool Contact<Real>::move_objects(ClothState<Real>&, Real, bool);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
