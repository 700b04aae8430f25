// Calls detection, solver and certificates of contact with objects in their order.

#include "core/contact/objects/contact.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/constants.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/moving_rows.h"
#include "core/contact/objects/object_certificate.h"

namespace weft {

template <class Real>
Contact<Real>::Contact(const std::vector<ContactDef>& cloths,
                       const std::vector<ColliderDef>& colliders, ClothPatches patches,
                       Executor* executor, MeshStore* store)
    : executor_(executor), shapes_(object_shapes<Real>(colliders, store)),
      pairs_(object_pairs<Real>(shapes_.meshes.size(), patches.list.size())) {
  assert(!cloths.empty());
  cloths_.defs = cloths;
  cloths_.patches = std::move(patches);
  double thickest = 0;
  for (const ContactDef& cloth : cloths) {
    thickest = std::max(thickest, cloth.thickness);
    cloths_.bounces |= cloth.restitution > 0;
  }
  cloths_.thickness = static_cast<Real>(thickest);
}

template <class Real>
void Contact<Real>::reset() {
  clearance_.collected = reach_.made = resolved_ = false;
  settled_ = true;
  clearance_.distance.clear();
  rows_.all.clear();
  rows_.moving.clear();
  rows_.exits.clear();
  log_.clear();
  response_.lone_given.clear();
  bounces_.v_came.clear();
  bounces_.v_kicked.clear();
  bounces_.impacts.clear();
  for (ColliderFrame<Real>& frame : shapes_.frames) frame.wary = frame.rest = 0;
  forget_neighbourhoods(pairs_);
}

template <class Real>
void Contact<Real>::let_rest(const ClothState<Real>& state) {
  clearance_.collected = reach_.made = false;
  clearance_.resting.clear();
  if (state.asleep.empty()) return;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Index cloth = cloth_of(cloths_, static_cast<Index>(i));
    clearance_.resting.push_back(state.asleep[at_index(cloth)]);
  }
}

template <class Real>
void Contact<Real>::begin_tick(double tick_seconds, ColliderStates* colliders) {
  resolved_ = false;
  log_.clear();
  response_.lone_given.clear();
  if (begin_motion(tick_seconds, colliders, shapes_, motion_)) reach_.made = false;
}

template <class Real>
void Contact<Real>::place(const ColliderStates& colliders) {
  assert(colliders.size() == shapes_.frames.size());
  for (std::size_t k = 0; k < colliders.size(); ++k) place_collider(k, colliders[k].pose, shapes_);
}

template <class Real>
void Contact<Real>::note_motion(const ClothState<Real>& state) {
  if (cloths_.bounces) bounces_.v_came = state.v;
}

template <class Real>
void Contact<Real>::note_kicked(const ClothState<Real>& state, double force_ratio) {
  if (motion_.force_ratio != force_ratio) {
    note_lone(rows_, response_, log_);  // what they gave at the old ratio
    motion_.force_ratio = force_ratio;
    log_.set_force_ratio(force_ratio);
  }
  if (cloths_.bounces) bounces_.v_kicked = state.v;
}

// ---- detect ----

template <class Real>
void Contact<Real>::collect(const ClothState<Real>& state, Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  measure_clearance(cloths_, shapes_, motion_, state, dt, executor_, clearance_, profile);
  mark_near(cloths_, clearance_, near_);
  take_to_own(shapes_, state.x, near_);
  collect_pairs(cloths_, shapes_, near_, state.x, executor_, clearance_, pairs_, profile);
  mark_paired(cloths_, shapes_, clearance_, pairs_, near_);
  clearance_.x = state.x;
  for (ColliderFrame<Real>& frame : shapes_.frames) frame.travel_since_pairs = 0;
  motion_.since_pairs = 0;
  clearance_.collected = true;
}

/// Gives particles that are in no list, and that go farther than they may, a new clearance.
/// @return whether all stay within their reach then, so that every list stays valid
template <class Real>
bool Contact<Real>::renew_clear(const ClothState<Real>& state, Real dt, Profile& profile) {
  if (!clearance_.collected || !reach_.made || !is_still(motion_, rows_)) return false;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (reach_.travel2[i] <= reach_.reach[i] * reach_.reach[i]) continue;
    if (near_.active[i] ||
        !renew_clearance(cloths_, shapes_, state, i, dt, clearance_, reach_.reach))
      return false;
    reach_.x[i] = state.x[i];
    ++profile[Stage::broad_phase].work;
  }
  return measure_travel(state, dt, Real(0), executor_, reach_);
}

/// Makes the rows anew from the candidates, which are collected again first if they do not hold.
template <class Real>
void Contact<Real>::rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  const std::size_t n = state.x.size();
  reach_.reach.resize(n);
  reach_.travel2.resize(n);
  scratch_.moved.resize(n);
  const auto allow = [&] {
    return allow_rows(cloths_, shapes_, motion_, state, dt, clearance_, near_, executor_,
                      scratch_.moved, reach_.reach);
  };
  if (!clearance_.collected || !allow()) {
    collect(state, dt, profile);
    allow();
  }
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  reach_.x = state.x;
  for (ColliderFrame<Real>& frame : shapes_.frames) frame.travel_since_rows = 0;
  motion_.since_rows = motion_.coming;
  take_to_own(shapes_, state.x, near_);
  note_lone(rows_, response_, log_);
  log_.before_rebuild(rows_.all);
  rows_.all.clear();
  rows_.moving.clear();
  scratch_.gap.resize(n);
  for (std::size_t i = 0; i < n; ++i) scratch_.gap[i] = cloths_.thickness + reach_.reach[i];
  const ObjectRowSource<Real> source{cloths_, shapes_, state,        clearance_,
                                     near_,   pairs_,  reach_.reach, motion_.any_tracked};
  add_particle_rows(source, executor_, scratch_, rows_, profile);
  add_features_on_rounds(source, executor_, scratch_, rows_, profile);
  add_features_on_meshes(source, executor_, scratch_, rows_, profile);
  finish_rows(cloths_, n, executor_, rows_);
  reach_.made = true;
}

template <class Real>
Real Contact<Real>::calm_room(const ClothState<Real>& state) const {
  const bool known = clearance_.collected && reach_.made;
  if (!known || !rows_.all.empty() || !rows_.exits.empty() || !is_still(motion_, rows_)) return 0;
  Real room = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < state.x.size(); ++i)
    room = std::min(room, reach_.reach[i] - (state.x[i] - reach_.x[i]).norm());
  return std::max(room, Real(0));
}

// ---- solve and certify ----

template <class Real>
void Contact<Real>::resolve(ClothState<Real>& state, Real dt, Profile& profile,
                            ClothGuard<Real>* guard) {
  if (shapes_.empty()) {
    if (guard) guard->respond_alone(state, dt);
    return;
  }
  assert((!resolved_ || !motion_.any_tracked) && "move_objects follows resolve");
  resolved_ = true;
  plan_objects(dt, shapes_, motion_);
  bool hold = clearance_.collected && reach_.made;
  {
    const StageTimer timer(profile, Stage::broad_phase, 0);
    // Objects have taken a part of the reach, and will take more; from what bounces off them twice.
    const Real less = motion_.since_rows + motion_.coming * (cloths_.bounces ? 2 : 1);
    hold = (hold && measure_travel(state, dt, less, executor_, reach_)) ||
           renew_clear(state, dt, profile);
  }
  if (!hold) {
    rebuild_rows(state, dt, profile);
    measure_travel(state, dt, Real(0), executor_, reach_);
  }
  if (motion_.any_tracked) find_pinches(rows_, state.x, motion_, pinches_);
  if (!rows_.all.empty()) {
    ObjectSolve<Real> solve = solving(state);
    profile[Stage::contact].work += rows_.all.size();
    begin_notes(solve);
    find_busy_rows(rows_, reach_.travel2, log_, response_);
    push_out(solve, clearance_.smallest_gap, dt);
    aim_rows(solve, shapes_, dt);
    // Where ticks end with half a kick they begin with one, and friction has half as much to hold.
    if (motion_.any_press) share_hold(solve, shapes_, settled_ ? dt / 2 : dt);
    solve_rows(solve, dt, guard);
    bounce(solve, guard);
    book_reactions(state.x, rows_, motion_, log_);
    profile[Stage::friction].work += solve.friction_evaluations;
    if (guard) guard->push_apart(state);
    certify_drift(state, dt, guard != nullptr);
  } else if (guard) {
    guard->respond_alone(state, dt);
    certify_drift(state, dt, true);
  }
  settled_ = false;
  if (!motion_.any_tracked || !guard) return;
  stops_.x = state.x;
  stops_.v = state.v;
}

template <class Real>
void Contact<Real>::certify_drift(ClothState<Real>& state, Real dt, bool others) {
  ObjectCertificate<Real> certificate{
      shapes_, motion_, rows_, reach_, response_, log_, executor_, state, clearance_.smallest_gap,
      dt};
  certify(certificate, others);
}

template <class Real>
bool Contact<Real>::move_objects(ClothState<Real>& state, Real dt, bool truncated) {
  assert((resolved_ || shapes_.empty()) && "resolve comes first");
  resolved_ = false;
  if (!motion_.any_tracked) return true;
  bool moved = true;
  if (truncated && !rows_.moving.empty()) {
    StoppedStep<Real> step{
        shapes_, motion_, rows_, response_.x_unpushed, state, clearance_.smallest_gap, dt};
    moved = stand_before_stopped(step, stops_);
  }
  advance_objects(dt, shapes_, motion_);
  turn_with_objects(shapes_, log_, rows_);
  return moved;
}

template <class Real>
void Contact<Real>::settle(ClothState<Real>& state, Real dt, Profile& profile,
                           ClothGuard<Real>* guard) {
  assert(!resolved_ || !motion_.any_tracked);
  settled_ = true;
  if (rows_.all.empty()) {
    if (guard) guard->sweep(state);
    return;
  }
  ObjectSolve<Real> solve = solving(state);
  profile[Stage::contact].work += rows_.all.size();
  begin_notes(solve);
  measure_travel(state, dt, Real(0), executor_, reach_);
  find_busy_rows(rows_, reach_.travel2, log_, response_);
  respond_alone(solve, dt, false);
  aim_rows(solve, shapes_, dt);
  if (motion_.any_press) share_hold(solve, shapes_, dt / 2);
  solve_rows(solve, dt, guard);
  bounce(solve, guard);
  if (guard && !guard->rows().empty()) {
    for (int sweep = 0; sweep < kClosingSweeps; ++sweep) {
      const bool changed = guard->sweep(state) > 0;
      sweep_rows(solve, !changed);
    }
  }
  book_reactions(state.x, rows_, motion_, log_);
  profile[Stage::friction].work += solve.friction_evaluations;
}

// ---- read-outs ----

template <class Real>
std::vector<ContactPoint> Contact<Real>::contacts(const Vec3Array<Real>& x) {
  note_lone(rows_, response_, log_);
  std::vector<ContactPoint> contacts =
      log_.contacts(rows_.all, x, kTouching, static_cast<double>(motion_.tick_seconds));
  // The plane of a contact is that of its last row, which the cloth may have left since.
  for (ContactPoint& contact : contacts) {
    const Vec3<Real> point = contact.point.template cast<Real>();
    const Real distance = distance_from(shapes_, at_index(contact.collider), point);
    if (distance < Real(kFarAway)) contact.gap = static_cast<double>(distance);
  }
  return contacts;
}

template <class Real>
bool Contact<Real>::touches(const Vec3Array<Real>& x) const {
  return std::any_of(rows_.all.begin(), rows_.all.end(), [&x](const ContactRow<Real>& row) {
    if (!row.responds) return false;
    Real height = -row.offset;
    for (std::size_t k = 0; k < row.count; ++k)
      height += row.normal.dot(x[at_index(row.particle[k])]) * row.weight[k];
    return height <= row.thickness * static_cast<Real>(kTouching);
  });
}

template <class Real>
Real Contact<Real>::gap_of(const ContactRow<Real>& row, const Vec3Array<Real>& x) const {
  const Vec3<Real> p = weighted(row, x);
  const Real distance = distance_from(shapes_, at_index(row.collider), p);
  return distance < Real(kFarAway) ? distance : row.normal.dot(p) - row.offset;
}

template <class Real>
double Contact<Real>::deepest_penetration(const Vec3Array<Real>& x) const {
  Real least = 0;
  std::vector<Real> distance;
  for (std::size_t i = 0; i < x.size(); ++i) {
    // No particle in the ball about a neighbour that reaches to the nearest surface needs
    // measuring.
    Real known = 0, edge = 0;
    for (const auto& neighbour : cloths_.patches.neighbours.of(i)) {
      const auto j = at_index(neighbour.particle);
      if (j >= i) continue;
      edge = std::max(edge, (x[i] - x[j]).norm());
      known = std::max(known, distance[j] - (x[i] - x[j]).norm());
    }
    distance.push_back(known > edge * 2 ? known : signed_distance(shapes_, x[i]));
    least = std::min(least, distance.back());
  }
  for (const Edge& edge : cloths_.patches.edges) {
    const auto i = at_index(edge[0]), j = at_index(edge[1]);
    const Vec3<Real> along = x[j] - x[i];
    const Real length = along.norm();
    for (const Real t : {Real(0.25), Real(0.5), Real(0.75)}) {
      // The ball about an end that reaches to the nearest surface holds no point of an object.
      if (length * t < distance[i] || length * (1 - t) < distance[j]) continue;
      least = std::min(least, signed_distance<Real>(shapes_, x[i] + along * t));
    }
  }
  return static_cast<double>(-least);
}

template class Contact<float>;
template class Contact<double>;

}  // namespace weft
