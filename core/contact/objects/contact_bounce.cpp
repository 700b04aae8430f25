// Restitution in Contact, after all that touches has been stopped. An object gives back a part of
// what it has taken in this step of the motion along its normal and no more, so that no bounce
// brings energy, however many rows and layers push each other (Stronge's coefficient of
// restitution). And only the motion of the last step bounces: what rests has none towards the
// object, whatever presses on it.

#include <algorithm>
#include <cmath>

#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/row_values.h"

namespace weft {
namespace {

/// Slower impacts do not bounce [m/s].
constexpr double kBounceSpeed = 0.05;

}  // namespace

template <class Real>
void Contact<Real>::note_motion(const ClothState<Real>& state) {
  if (bounces_) v_came_ = state.v;
}

template <class Real>
void Contact<Real>::note_kicked(const ClothState<Real>& state) {
  if (bounces_) v_kicked_ = state.v;
}

/// Velocity of a row's point over the object there [m/s].
template <class Real>
Vec3<Real> Contact<Real>::velocity_over(const ContactRow<Real>& row,
                                        const Vec3Array<Real>& v) const {
  Vec3<Real> over = weighted(row, v);
  if (row.mover != kNone) over -= moving_rows_[static_cast<std::size_t>(row.mover)].surface;
  return over;
}

/// Notes whether a row's point hits in this step, which would bring it there, and how fast it then
/// leaves. Of the motion before the kick and after it the slower counts: forces of one step, as
/// where cloth is pressed on an object, are no impact.
template <class Real>
void Contact<Real>::note_impact(std::size_t r, const ClothState<Real>& state) {
  ContactRow<Real>& row = rows_[r];
  row.impact = kNone;
  const Real restitution =
      static_cast<Real>(cloths_[static_cast<std::size_t>(row.cloth)].restitution);
  if (restitution == 0) return;
  Real speed = row.normal.dot(velocity_over(row, v_kicked_.empty() ? state.v : v_kicked_));
  if (!v_came_.empty()) speed = std::max(speed, row.normal.dot(velocity_over(row, v_came_)));
  if (!(speed < std::min(row.least_speed, -static_cast<Real>(kBounceSpeed)))) return;
  row.impact = static_cast<Index>(impacts_.size());
  impacts_.push_back({r, -restitution * speed, 0});
}

/// Lets what was hit bounce, and then what it meets respond to that, without a bounce.
template <class Real>
void Contact<Real>::bounce(ClothState<Real>& state, Profile& profile, ClothGuard<Real>* guard) {
  v_came_.clear();
  v_kicked_.clear();
  if (impacts_.empty()) return;
  std::uint64_t friction_evaluations = 0;
  for (const Impact<Real>& impact : impacts_) {
    const ContactRow<Real>& row = rows_[impact.row];
    const Real restitution =
        static_cast<Real>(cloths_[static_cast<std::size_t>(row.cloth)].restitution);
    const Vec3<Real> v = velocity_over(row, state.v);
    const Real vn = row.normal.dot(v);
    const Real fastest = std::sqrt(vn * vn + restitution * restitution * impact.taken);
    const Real push = std::min(impact.speed, fastest) - vn;
    if (push > 0) respond(impact.row, v, vn, push, state, friction_evaluations);
  }
  if (guard) guard->sweep(state);
  sweep_rows(state, friction_evaluations);
  profile[Stage::friction].work += friction_evaluations;
}

#define WEFT_INSTANTIATE(Real)                                                    \
  template void Contact<Real>::note_motion(const ClothState<Real>&);              \
  template void Contact<Real>::note_kicked(const ClothState<Real>&);              \
  template Vec3<Real> Contact<Real>::velocity_over(const ContactRow<Real>&,       \
                                                   const Vec3Array<Real>&) const; \
  template void Contact<Real>::note_impact(std::size_t, const ClothState<Real>&); \
  template void Contact<Real>::bounce(ClothState<Real>&, Profile&, ClothGuard<Real>*);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
