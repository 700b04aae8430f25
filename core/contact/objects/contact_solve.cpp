// The response of Contact: velocities that respect the rows, and the certificate of the end
// positions.

#include <algorithm>
#include <cmath>

#include "core/contact/constants.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/row_values.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Sweeps of projected Gauss-Seidel over the rows.
constexpr int kSweeps = 2;

/// Further ones, each after one over the rows of cloths with each other: one where these press, as
/// piles would tremble without, and more while each changes what something moves in the substep by
/// more than kResidual. None where the first one, begun from the impulses of the
/// last step, found next to nothing to do [m/s].
constexpr int kMoreSweeps = 8;
constexpr double kStill = 5e-4;

/// Rounds of projection on violated planes before a particle is held.
constexpr int kCertifyRounds = 3;

}  // namespace

/// Visits rows by number, without the lone ones if these are worked on apart.
template <class Real>
template <class Visit>
void Contact<Real>::for_joint_rows(Visit&& visit) const {
  if (lone_apart_) {
    for (const std::size_t r : joint_rows_) visit(r);
  } else {
    for (std::size_t r = 0; r < rows_.size(); ++r) visit(r);
  }
}

/// Lists the rows that can respond in this step: the others are farther from touching than their
/// particles go. Where objects move, all may.
template <class Real>
void Contact<Real>::find_busy_rows() {
  busy_rows_.clear();
  pushed_rows_.clear();
  const bool all = !stands_still();
  // Who wants to know of contacts is told by the rows one by one.
  lone_apart_ = !all && !log_.wanted();
  lone_response_ = {};
  for_joint_rows([&](std::size_t r) {
    if (all ? rows_[r].responds : !(farthest2(rooms_[r], travel2_) < rooms_[r].touch2))
      busy_rows_.push_back(r);
  });
}

template <class Real>
void Contact<Real>::push_out(ClothState<Real>& state, Real dt) {
  // Where nothing moves, only pushes are taken back.
  if (!lone_apart_) x_unpushed_ = state.x;
  for (const std::size_t r : busy_rows_) {
    const ContactRow<Real>& row = rows_[r];
    const Real lack = row.thickness - (row.normal.dot(weighted(row, state.x)) - row.offset);
    if (!(lack > Real(kTouchSlack))) continue;
    if (lone_apart_ && pushed_rows_.empty()) x_unpushed_ = state.x;
    const Real step = std::min(lack * Real(kPushOutPart), Real(kPushOutSpeed) * dt);
    share_out<Real>(row, row.normal * step, state.x);
    pushed_rows_.push_back(r);
  }
  if (!pushed_rows_.empty()) take_back_pushes(state);
  // A lone particle goes away from the only plane that it could come too near to.
  if (lone_apart_) lone_response_ = lone_rows_.push_and_respond(lone_pass(state, dt), executor_);
}

/// Normal velocity that each row must reach: no farther down than the thickness within the step,
/// and none when touching.
template <class Real>
void Contact<Real>::aim_rows(const ClothState<Real>& state, Real dt) {
  impacts_.clear();
  for (const std::size_t r : busy_rows_) {
    ContactRow<Real>& row = rows_[r];
    const Real gap = row.normal.dot(weighted(row, state.x)) - row.offset;
    const Real room = std::max(Real(0), gap - row.thickness - Real(kTouchSlack));
    row.least_speed = -room / dt;
    if (row.mover != kNone) {
      MovingRow<Real>& moving = moving_rows_[static_cast<std::size_t>(row.mover)];
      moving.surface = frames_[moving.collider].velocity_at(weighted(row, state.x));
    }
    if (bounces_) note_impact(r, state);
  }
}

/// Pushes a row's point. Friction: the tangential velocity is stopped if that takes at most
/// friction times the normal impulse, else slowed by as much (Coulomb; eq. (10) of the seed). What
/// jaws squeeze has besides the normal impulses that cancel there, and their friction does not.
/// @param v,vn  velocity of the point over the object, and along the normal [m/s]
/// @param push  change of the latter [m/s]
template <class Real>
void Contact<Real>::respond(std::size_t r, const Vec3<Real>& v, Real vn, Real push,
                            ClothState<Real>& state, std::uint64_t& friction_evaluations) {
  const ContactRow<Real>& row = rows_[r];
  Real* grip =
      row.mover == kNone ? nullptr : &moving_rows_[static_cast<std::size_t>(row.mover)].grip;
  Vec3<Real> change = row.normal * push;
  const Real friction = static_cast<Real>(cloths_[static_cast<std::size_t>(row.cloth)].friction);
  if (friction > 0) {
    ++friction_evaluations;
    const Vec3<Real> slip = v - row.normal * vn;
    const Real speed = slip.norm(), most = friction * push + (grip ? *grip : Real(0));
    change -= speed > most ? (slip * (most / speed)).eval() : slip;
    if (grip) *grip -= std::clamp(speed - friction * push, Real(0), *grip);
  }
  share_out(row, change, state.v);
  pushed_rows_.push_back(r);
  if (row.mover != kNone) take_reaction(row, weighted(row, state.x), change);
  if (log_.wanted()) log_.add(rows_, r, change);
}

/// A sweep of projected Gauss-Seidel.
/// @param again  nobody but these rows has changed a velocity since the last sweep: lone ones have
///               what they want
/// @return largest change of a normal velocity [m/s]
template <class Real>
Real Contact<Real>::sweep_rows(ClothState<Real>& state, std::uint64_t& friction_evaluations,
                               bool again) {
  Real largest = 0;
  if (lone_apart_ && !again) {
    const LoneResponse<Real> lone = lone_rows_.sweep(lone_pass(state, Real(0)));
    largest = lone.largest;
    friction_evaluations += lone.friction_evaluations;
  }
  for (const std::size_t r : busy_rows_) {
    if (again && lone_rows_.has(r)) continue;
    const ContactRow<Real>& row = rows_[r];
    const Vec3<Real> v = velocity_over(row, state.v);
    const Real vn = row.normal.dot(v);
    Real push = row.least_speed - vn;
    if (!(push > 0)) {
      if (row.mover == kNone || moving_rows_[static_cast<std::size_t>(row.mover)].grip == 0)
        continue;
      push = 0;
    } else if (row.impact != kNone) {
      impacts_[static_cast<std::size_t>(row.impact)].taken +=
          vn * vn - row.least_speed * row.least_speed;
    }
    largest = std::max(largest, push);
    respond(r, v, vn, push, state, friction_evaluations);
  }
  return largest;
}

/// The rows of cloths with each other are swept after a first sweep over these: what lies on an
/// object in layers would seem to part as long as the object does not carry the lowest one.
/// Cloth that is pressed on an object in layers, or led by hands against it, needs more than the
/// usual sweeps, and those of its own rows in between: without, what the rows leave is stopped by
/// the certificates.
template <class Real>
void Contact<Real>::solve_rows(ClothState<Real>& state, Real dt, Profile& profile,
                               ClothGuard<Real>* guard) {
  std::uint64_t friction_evaluations = lone_response_.friction_evaluations;
  Real left = lone_response_.largest, among_cloths = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    stop_point();
    const bool again = sweep == 0 ? lone_apart_ : !(among_cloths > 0);
    left = std::max(left, sweep_rows(state, friction_evaluations, again));
    if (guard && sweep == 0) among_cloths = guard->sweep(state);
  }
  if (!(among_cloths > static_cast<Real>(kStill))) guard = nullptr;
  const Real enough = thickness_ * Real(kResidual) / dt;
  for (int sweep = 0; guard && sweep < kMoreSweeps && (sweep == 0 || left > enough); ++sweep) {
    if (!(guard->sweep(state) > (sweep == 0 ? Real(0) : enough))) break;
    left = sweep_rows(state, friction_evaluations);
  }
  profile[Stage::friction].work += friction_evaluations;
}

/// Notes the impulse by which the certificate stopped particle k of a row.
/// @param before  its velocity until then [m/s]
template <class Real>
void Contact<Real>::log_stop(const ContactRow<Real>& row, std::size_t k, const Vec3<Real>& before,
                             const ClothState<Real>& state) {
  ContactRow<Real> single = row;
  single.particle = {row.particle[k], 0, 0};
  single.weight = {Real(1), 0, 0};
  single.count = 1;
  const Vec3<Real> change = state.v[static_cast<std::size_t>(row.particle[k])] - before;
  log_.add_apart(single, change, state);
}

/// Keeps each particle of a row on its side of the row's plane through the coming drift: as the
/// plane separates two convex features, nobody crosses who ends where he may.
/// @param hold  stop a particle that would cross, instead of lifting it along the normal
/// @return whether anybody had to be kept
template <class Real>
bool Contact<Real>::keep_off(const ContactRow<Real>& row, bool hold, ClothState<Real>& state,
                             Real dt) {
  bool kept = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
    const auto i = static_cast<std::size_t>(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = row.normal.dot(state.x[i] + state.v[i] * dt) - row.offset;
    const Real least = least_end(row, now);
    if (end >= least || state.inverse_mass[i] == 0 || state.v[i].isZero(0)) continue;
    kept = true;
    const Vec3<Real> before = state.v[i];
    if (hold)
      state.v[i].setZero();
    else
      state.v[i] += row.normal * ((least - end) / dt * Real(1.0001));
    if (log_.wanted()) log_stop(row, k, before, state);
  }
  return kept;
}

/// Holds whoever would go beyond the reach within which the planes are all that matters. Not moving
/// is always allowed.
template <class Real>
void Contact<Real>::hold_within_reach(ClothState<Real>& state, Real dt) {
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3<Real> end = state.x[i] + state.v[i] * dt;
    const Real reach = row_reach_[i] - way_rows_;
    if (!((end - x_rows_[i]).squaredNorm() <= reach * std::abs(reach))) state.v[i].setZero();
  }
}

/// Certifies the coming drift: nobody crosses a plane, and nobody goes beyond the reach.
/// @param others  have changed velocities since everybody was measured, and not by rows
template <class Real>
void Contact<Real>::certify(ClothState<Real>& state, Real dt, bool others) {
  if (!moving_rows_.empty()) return certify_with_movers(state, dt);
  const bool still = stands_still();
  if (!still || !(others ? measure_way(state, dt) : measure_pushed_way(state, dt))) {
    hold_within_reach(state, dt);
    measure_way(state, dt);
  }
  bool kept = false;
  for_joint_rows([&](std::size_t r) {
    if (!still || !(farthest2(rooms_[r], travel2_) < rooms_[r].cross2))
      kept |= keep_off(rows_[r], false, state, dt);
  });
  if (lone_apart_) {
    lone_rows_.for_each_crossing(
        travel2_.data(), [&](std::size_t r) { kept |= keep_off(rows_[r], false, state, dt); });
  }
  if (!kept) return;
  for (int round = 1; round < kCertifyRounds && kept; ++round) {
    kept = false;
    for (const ContactRow<Real>& row : rows_) kept |= keep_off(row, false, state, dt);
  }
  if (kept) {
    for (const ContactRow<Real>& row : rows_) keep_off(row, true, state, dt);
  }
  hold_within_reach(state, dt);
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template void Contact<Real>::find_busy_rows();                                                 \
  template void Contact<Real>::hold_within_reach(ClothState<Real>&, Real);                       \
  template void Contact<Real>::push_out(ClothState<Real>&, Real);                                \
  template void Contact<Real>::aim_rows(const ClothState<Real>&, Real);                          \
  template void Contact<Real>::respond(std::size_t, const Vec3<Real>&, Real, Real,               \
                                       ClothState<Real>&, std::uint64_t&);                       \
  template Real Contact<Real>::sweep_rows(ClothState<Real>&, std::uint64_t&, bool);              \
  template void Contact<Real>::solve_rows(ClothState<Real>&, Real, Profile&, ClothGuard<Real>*); \
  template bool Contact<Real>::keep_off(const ContactRow<Real>&, bool, ClothState<Real>&, Real); \
  template void Contact<Real>::log_stop(const ContactRow<Real>&, std::size_t, const Vec3<Real>&, \
                                        const ClothState<Real>&);                                \
  template void Contact<Real>::certify(ClothState<Real>&, Real, bool);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
