// Calls detection, certificates and the solver of cloth contact in their order.

#include "core/contact/guard/cloth_guard.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/constants.h"
#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/contact/smallest_gap.h"

namespace weft {
namespace {

/// Whether the rounding of positions could close a pair's gap.
template <class Real>
bool touches(const GuardedPair<Real>& pair, const QuadArray<Real>& x, Real smallest_gap) {
  if (pair.bound >= smallest_gap) return false;
  Real largest = 0;
  for (const Index i : pair.particle) {
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(x[at_index(i)][k]));
  }
  return !(pair.bound > largest * std::numeric_limits<Real>::epsilon() * Real(kRoundingsOfNoGap));
}

/// Opens pairs that touch unless they were apart before: nothing tells on which side of each other
/// their features are. What was apart once is so at any gap.
/// @param first   number of the first new pair
/// @param unseen  these are the first pairs, and none was apart before
template <class Real>
void open_touching(std::size_t first, bool unseen, const QuadArray<Real>& x, Real smallest_gap,
                   GuardedPairs<Real>& pairs) {
  const std::vector<std::uint64_t>& keys = pairs.open_keys;
  if (keys.empty() && !unseen) return;
  for_pairs_from(pairs, first, [&](GuardedPair<Real>& pair) {
    if (!touches(pair, x, smallest_gap)) return;
    if (!unseen && !std::binary_search(keys.begin(), keys.end(), key_of(pair))) return;
    pair.open = true;
    ++pairs.open;
  });
}

// What a reset forgets keeps its memory, so that no step after it allocates.

template <class Real>
void forget(Regions<Real>& regions) {
  regions.sizes.assign(regions.sizes.size(), Quad<Real>{{0, 0, -1, 0}});
  regions.dirty.clear();
  regions.columns.clear();
  for (AnchorPart<Real>& part : regions.parts) part.columns.clear(), part.next.clear();
}

template <class Real>
void forget(GuardedTangles<Real>& tangled) {
  tangled.tangles.reset();
  tangled.is_heap.assign(tangled.is_heap.size(), 0);
  tangled.heaps = 0;
  tangled.unseen = true;
}

}  // namespace

template <class Real>
ClothGuard<Real>::ClothGuard(const ClothModel<Real>& model, Executor* executor)
    : executor_(executor), cloths_(guarded_cloths(model)), search_(patch_search(model)),
      stopped_(stopped_particles<Real>(model.mass.size())),
      making_(row_making<Real>(model.mass.size())), rows_(row_set<Real>(model.mass.size())),
      push_(push_out<Real>(model.mass.size())) {
  const std::size_t n = model.mass.size(), cloths = cloths_.particles_of.size();
  for (QuadArray<Real>* array : {&step_.from, &step_.displacement, &paths_.from, &paths_.velocity,
                                 &regions_.anchor, &sweeps_.v})
    array->assign(n, {});
  for (Vec3Array<Real>* array : {&calm_.paths.base, &calm_.paths.velocity, &slack_.ends})
    array->assign(n, Vec3<Real>::Zero());
  paths_.since.assign(n, Real(0));
  regions_.sizes.assign(n, Quad<Real>{{0, 0, -1, 0}});
  for (std::vector<char>* array : {&pairs_.is_active, &critical_.is_tight}) array->assign(n, 0);
  critical_.fraction.assign(n, Real(1));
  critical_.stopped_at.assign(n, 0);
  regions_.wave_of.assign(n, 0);
  regions_.anchored_at.assign(n, 0);
  regions_.parts.resize(kMostParts);
  calm_.paths.reach = cloths_.reach;
  tangled_.tangles = ClothTangles<Real>(model);
  tangled_.is_heap.assign(cloths, 0);
  tangled_.crossings_of.assign(cloths, 0);
  awake_.resting.assign(search_.tree.patch_count(), 0);
  let_rest({});
}

template <class Real>
void ClothGuard<Real>::reset() {
  phase_ = GuardPhase::between_steps;
  paths_.collected = false;
  forget_found(search_);
  forget_made(making_);
  forget(regions_);
  forget_critical(critical_);
  forget_rows(rows_);
  forget_pairs(pairs_);
  forget_push(push_);
  forget_stopped(stopped_);
  forget(tangled_);
  sweeps_.kicked = 0;
  sweeps_.upwards = false;
  settled_ = true;
}

template <class Real>
void ClothGuard<Real>::let_rest(const std::vector<char>& asleep) {
  assert(asleep.empty() || asleep.size() == cloths_.particles_of.size());
  paths_.collected = making_.made = false;
  const auto sleeps = [&](std::size_t cloth) { return !asleep.empty() && asleep[cloth] != 0; };
  for (std::size_t p = 0; p < awake_.resting.size(); ++p) {
    const Index particle = search_.tree.patch(static_cast<Index>(p)).particles.front();
    awake_.resting[p] = sleeps(at_index(cloth_of(cloths_, particle))) ? 1 : 0;
  }
  awake_.ranges.clear();
  awake_.count = 0;
  for (std::size_t k = 0; k < cloths_.particles_of.size(); ++k) {
    if (sleeps(k)) continue;
    awake_.ranges.push_back(cloths_.particles_of[k]);
    awake_.count += static_cast<std::size_t>(cloths_.particles_of[k].count);
  }
}

// ---- solve ----

template <class Real>
void ClothGuard<Real>::solve(ClothState<Real>& state, Real dt, Profile& profile, Real force_ratio) {
  assert(phase_ == GuardPhase::between_steps && dt > 0);
  phase_ = GuardPhase::solved;
  note_settled();
  log_.force_ratio = static_cast<double>(force_ratio);
  const Real kicked = std::exchange(settled_, false) ? dt / 2 : dt;
  calm_.calm = pairs_.active.empty() && open_pairs() == 0;
  const bool looks = calm_.calm || !making_.made || (making_.steps + 1) % kStepsBetweenLooks == 0;
  if (log_.wanted && looks) rows_.deals.log_pushes(rows_.all, log_);
  if (calm_.calm) {
    calm_.x_before = state.x;
    forget_rows(rows_);
    return;
  }
  copy_in(state.x, step_.from, executor_);
  tangled_.tangles.draw(state, dt);
  making_.time += dt;
  ++making_.steps;
  if (!making_.made || is_time_to_look(making_)) rows_.deals.give_back(rows_.all, executor_);
  const RowSource<Real> source = row_source(state);
  if (!stopped_.jammed.empty() && is_time_to_look(making_)) note_jammed(stopped_.jammed, making_);
  if (find_moved(pairs_.active, step_.from, cloths_.thickest, making_))
    renew_rows(source, regions_.anchor, pairs_, making_, rows_, executor_, profile);
  if (making_.steps % kStepsBetweenCuts == 0) {
    rows_.slabs.cut(pairs_.active, step_.from);
    rows_.in_slabs = false;
  }
  if (!pairs_.arrived.empty()) add_arrived(source, pairs_, making_, rows_, profile);
  if (rows_.all.empty()) {
    forget_rows(rows_);
    return;
  }
  load_velocities(state.v, rows_.slabs, sweeps_.v, executor_);
  if (is_time_to_look(making_)) examine_rows(state, dt, profile);
  start_rows(state, dt, kicked, profile);
}

/// Chooses the busy rows, measures how hard they press, and turns those that push.
template <class Real>
void ClothGuard<Real>::examine_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  find_busy_rows(step_.from, sweeps_.v, dt, rows_, executor_);
  measure_pressures(cloths_.inverse_area, sweeps_.kicked, rows_, executor_);
  turn_rows(row_source(state), making_, rows_, executor_, profile);
  rows_.deals.take(rows_.slabs, rows_.all, step_.from.size(), executor_);
}

/// Gives the impulses of the last step again, in proportion to the time of the forces.
template <class Real>
void ClothGuard<Real>::start_rows(ClothState<Real>& state, Real dt, Real kicked, Profile& profile) {
  profile[Stage::contact].work += rows_.all.size();
  warm_start(step_.from, dt, kicked, rows_, sweeps_, executor_);
  store_velocities(sweeps_.v, rows_.slabs, state.v, executor_);
}

template <class Real>
Real ClothGuard<Real>::sweep(ClothState<Real>& state) {
  if (rows_.slabs.empty()) return 0;
  assert((phase_ == GuardPhase::solved || settled_) && "solve or settle first");
  load_velocities(state.v, rows_.slabs, sweeps_.v, executor_);
  const Real largest = sweep_once(step_.from, rows_, sweeps_, executor_);
  store_velocities(sweeps_.v, rows_.slabs, state.v, executor_);
  return largest;
}

template <class Real>
Real ClothGuard<Real>::residual(Real dt) const {
  // Tangles come apart more easily while layers give way a little.
  return cloths_.thickest * Real(open_pairs() > 0 ? kResidual : kAloneResidual) / dt;
}

template <class Real>
void ClothGuard<Real>::push_apart(ClothState<Real>& state) {
  if (!sweeps_.lack) return;
  add_push(rows_, push_, state.v, executor_);
}

template <class Real>
void ClothGuard<Real>::respond_alone(ClothState<Real>& state, Real dt) {
  if (rows_.all.empty()) return;
  const Real enough = residual(dt);
  for (int k = 0; k < kMostSweeps; ++k) {
    if (!(sweep(state) > enough)) break;
  }
  push_apart(state);
}

template <class Real>
bool ClothGuard<Real>::finish(ClothState<Real>& state, bool keeps_velocity) {
  assert(phase_ == GuardPhase::certified);
  const bool changes = !stopped_.list.empty() || !push_.particles.empty();
  phase_ = GuardPhase::between_steps;
  if (!keeps_velocity) forget_stopped(stopped_);
  give_velocities_back(stopped_, state.v);
  take_back_push(push_, state.v);
  meet_at_planes(state.inverse_mass, stopped_, state.v);
  if (log_.wanted) log_meetings(stopped_.pairs, log_);
  stopped_.pairs.clear();
  if (step_.is_free) keep_mean_velocity(step_.mean_velocity, state);
  return changes;
}

template <class Real>
void ClothGuard<Real>::settle(ClothState<Real>& state, Real dt, Profile& profile) {
  assert(phase_ == GuardPhase::between_steps && dt > 0);
  if (rows_.all.empty()) return;
  rows_.slabs.visit_particles(
      nullptr, [&](Index k) { step_.from[at_index(k)] = to_quad(state.x[at_index(k)]); });
  load_velocities(state.v, rows_.slabs, sweeps_.v, executor_);
  start_rows(state, dt, dt / 2, profile);
  settled_ = true;
}

// ---- detect ----

/// Collects pairs anew around the paths on which all particles go on as they move now.
template <class Real>
void ClothGuard<Real>::collect(const ClothState<Real>& state, Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  ++counts_.collections;
  regions_.smallest_gap = smallest_gap_at(step_.from);
  search_.motion.radius = cloths_.reach + regions_.smallest_gap;
  search_.motion.margin = cloths_.margin;
  begin_paths(step_, awake_, dt, cloths_.reach, cloths_.finest, executor_, paths_);
  predict(Real(0), executor_, paths_, search_.motion);
  search_.boxes.forget();
  search_.tree.refit(search_.motion, true);
  const bool unseen = std::exchange(tangled_.unseen, false);
  if (unseen || open_pairs() > 0)
    find_tangles(search_.tree, cloths_, awake_.resting, step_.from, state.inverse_mass, tangled_);
  pairs_.drop_all();
  find_near_patches(search_);
  test_near_patches(search_, cloths_, {awake_.resting, tangled_, true}, executor_, pairs_, profile);
  open_touching(0, unseen, step_.from, regions_.smallest_gap, pairs_);
  if (open_pairs() > 0) {
    note_touches(pairs_, step_.from, tangled_);
    paths_.horizon = std::min(paths_.horizon, std::max(static_cast<Real>(kLookAgain), dt));
  }
  pairs_.list_all(step_.from.size(), executor_);
  anchor_anew(pairs_, step_, regions_);
  share_all_gaps(pairs_, step_, executor_, regions_);
  paths_.elapsed = dt;
  paths_.collected = true;
  slack_.left = 0;  // was known from other paths
  making_.made = false;
}

/// Gives particles that leave their paths new ones, and collects their pairs anew; the others go
/// on. What was made for them when they began holds for the rest of their paths.
template <class Real>
void ClothGuard<Real>::collect_strays(Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  ++counts_.renewals;
  begin_paths_of_strays(step_, dt, cloths_.reach, paths_);
  predict(paths_.elapsed - dt, executor_, paths_, search_.motion);
  find_near_patches_of(paths_.strays, search_);
  pairs_.drop_of(paths_.strays, search_.changed);
  const std::size_t kept = pairs_.all.size();
  test_near_patches(search_, cloths_, {awake_.resting, tangled_, false}, executor_, pairs_,
                    profile);
  open_touching(kept, false, step_.from, regions_.smallest_gap, pairs_);
  place_new_particles(pairs_, kept, step_.from, making_);
  admit_pairs(kept, step_, executor_, pairs_, regions_);
  pairs_.list_from(kept);
  pairs_.note_arrivals(kept);
  slack_.left = 0;
}

// ---- certify ----

template <class Real>
void ClothGuard<Real>::certify(ClothState<Real>& state, Real dt, const std::function<Real()>& room,
                               Profile& profile) {
  assert(phase_ == GuardPhase::solved && dt > 0);
  phase_ = GuardPhase::certified;
  const StageTimer timer(profile, Stage::regions, 0);
  ++step_.number;
  if (log_.wanted) rows_.deals.note_pushes(static_cast<Real>(log_.force_ratio));
  log_.begun = true;
  step_.is_free = false;
  step_.common = {};
  paths_.elapsed += dt;
  if (calm_.calm) {
    if (stays_calm(calm_.paths, paths_, state, dt, executor_)) {
      paths_.off_now = paths_.off;
      calm_.paths.time = paths_.elapsed;
      return;
    }
    copy_in(calm_.x_before, step_.from, executor_);
  }
  if (regions_.dirty.empty() && has_slack(slack_, paths_, state, dt, executor_)) {
    ++counts_.quiet;
    step_.allowed = 0;
    return;
  }
  keep_in_regions(state, dt, room, profile);
  note_ends(state, dt, paths_.elapsed, executor_, slack_);
  if (pairs_.active.empty()) note_calm_paths(paths_, executor_, calm_);
  step_.count_motion(pairs_.active, counts_);
}

/// Collects the pairs that the step needs, anchors particles that would leave their regions, and
/// truncates what no region allows; again for particles that were stopped off their paths.
template <class Real>
void ClothGuard<Real>::keep_in_regions(ClothState<Real>& state, Real dt,
                                       const std::function<Real()>& room, Profile& profile) {
  regions_.anchored.clear();
  slack_.left = find_strays(state, dt, cloths_.reach, awake_, executor_, step_, paths_);
  bool collected = paths_.hold();
  for (int attempt = 0;; ++attempt) {
    const std::vector<Index>& strays = paths_.strays;
    collected = collected && strays.size() <= awake_.count / kManyStrays &&
                pairs_.all.size() <= pairs_.most &&
                (strays.empty() || allows_for_common(paths_, cloths_.reach));
    if (!collected)
      collect(state, dt, profile);
    else if (!strays.empty())
      collect_strays(dt, profile);
    collected = true;
    slack_.left = std::min(slack_.left, find_loose(pairs_.active, step_, regions_));
    if (regions_.loose.empty()) return;
    if (attempt == 0) find_common(awake_, state.inverse_mass, dt, room, step_);
    for (const Index i : regions_.anchored) regions_.anchored_at[at_index(i)] = 0;
    regions_.anchored.clear();
    const std::uint64_t before = counts_.anchored;
    anchor_loose(pairs_, step_, regions_, executor_, counts_);
    stop_crossings(pairs_, step_, regions_, critical_, executor_, counts_);
    profile[Stage::regions].work += counts_.anchored - before;
    truncate(pairs_, cloths_, dt, attempt >= kRetries, critical_, step_, regions_, paths_, stopped_,
             state);
    slack_.left = 0;
    if (strays.empty()) return;
    if (attempt == kMostRetries) break;
  }
  // New pairs are looked for in the next step.
  note_all_stopped(state.v, stopped_);
  step_.halt(pairs_.is_active, state.x, state.v);
  paths_.strays.clear();
  regions_.dirty.clear();
  paths_.collected = false;
}

template <class Real>
void ClothGuard<Real>::stand_still() {
  assert(phase_ == GuardPhase::certified);
  paths_.collected = false;
  counts_.truncated += step_.allowed;
}

template <class Real>
void ClothGuard<Real>::leave_calm_paths(int steps, Real time, const Vec3<Real>& common,
                                        bool renew) {
  assert(phase_ == GuardPhase::between_steps && steps >= 0);
  counts_.calm += static_cast<std::uint64_t>(steps);
  paths_.elapsed = calm_.paths.time = time;
  paths_.off = paths_.off_now = calm_.noted_off + to_quad(common);
  if (renew) paths_.collected = false;
}

template class ClothGuard<float>;
template class ClothGuard<double>;

}  // namespace weft
