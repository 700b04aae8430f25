// Steps for which the regions of ClothGuard have no room: certified one by one, or stopped.

#include <algorithm>
#include <cmath>

#include "core/contact/guard/cloth_guard.h"
#include "core/contact/travel.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Rounds of looking for an axis for each pair before all that are left stop at planes.
constexpr int kRounds = 12;

/// Times that pairs are collected anew in one step for particles that were stopped off their path,
/// before such ones stay where they are; and before all do.
constexpr int kRetries = 2, kMostRetries = 16;

/// Beyond this part of all particles being off their paths all pairs are collected anew.
constexpr std::size_t kManyStrays = 6;

/// Neither side of a gap gets less than this part of it.
constexpr double kLeastPart = 0.05;

/// A vector is at most so many times as long as its largest component; rounded up.
constexpr double kDiagonal = 1.7321;

/// Particles stop so much before their plane, as a part of their way to it.
constexpr double kStopShort = 1e-4;

/// A bound of how far anybody is off his straight path after the drift [m].
/// @param base      where the paths are at time 0 [m]
/// @param velocity  along them [m/s]
/// @param time      at the end of the drift [s]
template <class Real>
Real farthest_off(const ClothState<Real>& state, Real dt, const Vec3Array<Real>& base,
                  const Vec3Array<Real>& velocity, Real time) {
  PathPass<Real> pass;
  pass.particles = state.x.size();
  pass.x = state.x.data()->data();
  pass.v = state.v.data()->data();
  pass.dt = dt;
  pass.base = base.data()->data();
  pass.velocity = velocity.data()->data();
  pass.time = time;
  return largest_deviation(pass) * static_cast<Real>(kDiagonal);
}

}  // namespace

template <class Real>
void ClothGuard<Real>::certify(ClothState<Real>& state, Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::regions, 0);
  ++substep_;
  elapsed_ += dt;
  if (calm_) {
    if (stays_calm(state, dt)) {
      off_path_now_ = off_path_;
      calm_paths_.time = elapsed_;
      return;
    }
    for (std::size_t i = 0; i < legal_.size(); ++i) legal_[i] = to_quad(x_before_[i]);
  }
  if (has_leeway(state, dt)) {
    ++counts_.quiet;
    allowed_ = 0;
    return;
  }
  anchored_.clear();
  find_strays(state, dt);
  bool collected = collected_ && elapsed_ <= horizon_;
  for (int attempt = 0;; ++attempt) {
    collected = collected && strays_.size() <= awake_count_ / kManyStrays &&
                pairs_.size() <= most_pairs_ && (strays_.empty() || common_way_is_short());
    if (!collected)
      collect(state, dt, profile);
    else if (!strays_.empty())
      collect_strays(dt, profile);
    collected = true;
    const std::uint64_t before = counts_.anchored;
    find_loose();
    if (loose_.empty()) break;
    for (const Index i : anchored_) anchored_at_[static_cast<std::size_t>(i)] = 0;
    anchored_.clear();
    anchor(loose_);
    stop_crossings();
    profile[Stage::regions].work += counts_.anchored - before;
    truncate(state, dt, attempt >= kRetries);
    leeway_ = 0;
    if (strays_.empty()) break;
    if (attempt < kMostRetries) continue;
    halt(state);
    break;
  }
  note_ends(state, dt);
  if (active_.empty()) note_paths();
  count_motion();
}

/// Whether new paths of strays keep to what all leave theirs by in common: a path begins with that
/// of the step before, and has only half its reach for what it is more by now.
template <class Real>
bool ClothGuard<Real>::common_way_is_short() const {
  const Quad<Real> more = off_path_now_ - off_path_before_;
  return dot(more, more) <= reach_ * reach_ / 4;
}

/// Nobody moves: that is always allowed, whatever pairs are known. New ones are looked for in the
/// next step.
template <class Real>
void ClothGuard<Real>::halt(ClothState<Real>& state) {
  ++counts_.halts;
  for (std::size_t i = 0; i < step_.size(); ++i) {
    if (is_active_[i]) lost_ += static_cast<double>(length(step_[i]));
    step_[i] = {};
    state.x[i] = to_vector(legal_[i]);
    state.v[i].setZero();
  }
  strays_.clear();
  dirty_.clear();
  collected_ = false;
}

/// Whether, while there are no pairs, all stay in the balls around their paths in the coming step.
template <class Real>
bool ClothGuard<Real>::stays_calm(const ClothState<Real>& state, Real dt) const {
  if (!collected_ || !(elapsed_ <= horizon_)) return false;
  return farthest_off(state, dt, calm_paths_.base, calm_paths_.velocity, elapsed_) <= reach_;
}

/// Whether, by a bound for all at once, nobody leaves the ball around his path or the room around
/// his anchor in the coming step: what rests is not looked at one by one.
template <class Real>
bool ClothGuard<Real>::has_leeway(const ClothState<Real>& state, Real dt) const {
  if (!(leeway_ > 0) || !collected_ || !(elapsed_ <= horizon_) || !dirty_.empty()) return false;
  const Real along_paths = (fastest_ + length(common_velocity_)) * (elapsed_ - looked_);
  return farthest_off(state, dt, ends_, ends_, Real(0)) + along_paths <= leeway_;
}

/// Writes down where everybody is at the end of a step, if that leaves leeway for others.
template <class Real>
void ClothGuard<Real>::note_ends(const ClothState<Real>& state, Real dt) {
  looked_ = elapsed_;
  if (!(leeway_ > 0)) return;
  for (std::size_t i = 0; i < ends_.size(); ++i) ends_[i] = state.x[i] + state.v[i] * dt;
}

/// Writes down the paths of steps without pairs.
template <class Real>
void ClothGuard<Real>::note_paths() {
  noted_off_path_ = off_path_;
  for (std::size_t i = 0; i < calm_paths_.base.size(); ++i) {
    calm_paths_.base[i] = to_vector(on_path(i, 0) + off_path_);
    calm_paths_.velocity[i] = to_vector(velocity_[i]);
  }
  calm_paths_.fastest = fastest_;
  calm_paths_.time = elapsed_;
  calm_paths_.horizon = horizon_;
  ++calm_paths_.number;
}

template <class Real>
void ClothGuard<Real>::leave_calm_paths(int steps, Real time, const Vec3<Real>& common,
                                        bool renew) {
  counts_.calm += static_cast<std::uint64_t>(steps);
  elapsed_ = calm_paths_.time = time;
  off_path_ = off_path_now_ = noted_off_path_ + to_quad(common);
  if (renew) collected_ = false;
}

/// Certifies or stops the steps of particles that have no room for them.
template <class Real>
void ClothGuard<Real>::stop_crossings() {
  while (find_critical()) {
    stop_point();
    anchor(loose_);
  }
  counts_.critical += critical_.size();
  for (Critical& c : critical_) {
    const GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(c.pair)];
    const PairSeparation<Real> s = separate_pair(pair.kind, points(pair, legal_));
    c.normal = s.normal;
    c.gap = s.gap;
    c.fixed = false;
  }
  for (int round = 0;; ++round) {
    stop_point();
    bool changed = false;
    for (Critical& c : critical_) {
      if (c.fixed || (round < kRounds && holds(c))) continue;
      fix(c);
      changed = true;
    }
    if (!changed) break;
  }
}

/// Lists the particles whose step is longer than their room and the pairs that these endanger.
/// @return whether some particle of such a pair has to be anchored first; these are in loose_
template <class Real>
bool ClothGuard<Real>::find_critical() {
  for (const Index i : anchored_) is_tight_[static_cast<std::size_t>(i)] = 0;
  tight_.clear();
  critical_.clear();
  loose_.clear();
  ++listing_;
  for (const Index k : anchored_) {
    const auto i = static_cast<std::size_t>(k);
    if (dot(step_[i], step_[i]) <= room_[i] * room_[i]) continue;
    is_tight_[i] = 1;
    tight_.push_back(k);
  }
  for (const Index k : tight_) {
    for_pairs_of(static_cast<std::size_t>(k), [&](GuardedPair<Real>& pair) {
      if (pair.listed == listing_) return;
      pair.listed = listing_;
      if (!is_critical(pair)) return;
      critical_.push_back(
          {static_cast<Index>(&pair - pairs_.data()), Vec3<Real>::Zero(), Real(0), false});
      for (const Index j : pair.particle) {
        if (anchored_at_[static_cast<std::size_t>(j)] != substep_) loose_.push_back(j);
      }
    });
  }
  std::sort(loose_.begin(), loose_.end());
  loose_.erase(std::unique(loose_.begin(), loose_.end()), loose_.end());
  return !loose_.empty();
}

template <class Real>
bool ClothGuard<Real>::is_critical(GuardedPair<Real>& pair) {
  Real side[2] = {0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(pair.particle[k]);
    Real& most = side[k < first_side(pair.kind) ? 0 : 1];
    most = std::max(most, is_tight_[i] ? length(step_[i]) : room_[i]);
  }
  const Real needed = side[0] + side[1] + smallest_gap_;
  if (pair.bound >= needed) return false;
  measure(pair);
  return !(pair.bound >= needed);
}

/// Whether the steps, as far as they are allowed, cannot make the sides of a pair meet.
template <class Real>
bool ClothGuard<Real>::holds(const Critical& c) const {
  const GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(c.pair)];
  if (!(c.gap > 0)) return false;
  Real side[2] = {0, 0};
  PairPoints<Real> end;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(pair.particle[k]);
    const Quad<Real> step = step_[i] * fraction_[i];
    Real& most = side[k < first_side(pair.kind) ? 0 : 1];
    most = std::max(most, dot(step, step));
    end[k] = to_vector(legal_[i] + step);
  }
  if (std::sqrt(side[0]) + std::sqrt(side[1]) + smallest_gap_ <= c.gap) return true;
  // One axis that has the sides apart at both ends has them apart all along straight lines. What
  // is nearer than the smallest gap must not come nearer, rounding included.
  const Real least = std::min(c.gap + smallest_gap_ / 16, smallest_gap_);
  return gap_along(pair.kind, end, c.normal) >= least;
}

/// Stops the particles of a pair at two planes in its gap, which is shared as they wanted it.
template <class Real>
void ClothGuard<Real>::fix(Critical& c) {
  c.fixed = true;
  const GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(c.pair)];
  const std::size_t middle = first_side(pair.kind);
  const Quad<Real> normal = to_quad(c.normal);
  const Quad<Real>& origin = legal_[static_cast<std::size_t>(pair.particle[0])];
  std::array<Real, 4> height, way;  // both towards the other side
  Real front[2] = {std::numeric_limits<Real>::infinity(), std::numeric_limits<Real>::infinity()};
  Real goal[2] = {front[0], front[1]};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(pair.particle[k]);
    const std::size_t s = k < middle ? 0 : 1;
    const Real sign = s == 0 ? Real(1) : Real(-1);
    height[k] = sign * dot(normal, legal_[i] - origin);
    way[k] = -sign * dot(normal, step_[i]);
    front[s] = std::min(front[s], height[k]);
    goal[s] = std::min(goal[s], height[k] - way[k] * fraction_[i]);
  }
  const Real wish[2] = {std::max(Real(0), front[0] - goal[0]),
                        std::max(Real(0), front[1] - goal[1])};
  const Real room = c.gap - smallest_gap_;
  const Real both = wish[0] + wish[1];
  Real part = both > 0 ? wish[0] / both : Real(0.5);
  part = std::clamp(part, static_cast<Real>(kLeastPart), static_cast<Real>(1 - kLeastPart));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(pair.particle[k]);
    const std::size_t s = k < middle ? 0 : 1;
    if (!(room > 0)) {
      // No step that rounding could turn into an approach.
      if (!(c.gap > 0) || way[k] > -smallest_gap_ / 16) fraction_[i] = 0;
      continue;
    }
    const Real allowed = height[k] - front[s] + room * (s == 0 ? part : 1 - part);
    if (way[k] * fraction_[i] > allowed)
      fraction_[i] = std::min(fraction_[i], allowed / way[k] * Real(1 - kStopShort));
  }
}

/// Applies what was not allowed to the state. Particles stopped off their predicted path are listed
/// as strays, which ask for pairs around a new one; what the others may then is seen anew.
/// @param stay  they stay where they are, so that none is stopped a second time
template <class Real>
void ClothGuard<Real>::truncate(ClothState<Real>& state, Real dt, bool stay) {
  strays_.clear();
  ++wave_;
  const auto visit = [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    if (wave_of_[i] == wave_) return;
    wave_of_[i] = wave_;
    is_tight_[i] = 0;
    dirty_.push_back(k);
    if (fraction_[i] >= 1) return;
    const Quad<Real> allowed = step_[i] * fraction_[i];
    lost_ += static_cast<double>(length(step_[i] - allowed));
    fraction_[i] = 1;
    const Quad<Real> off = legal_[i] + allowed - on_path(i, elapsed_) - off_path_now_;
    const bool off_path = !(dot(off, off) <= reach_ * reach_);
    if (off_path) strays_.push_back(k);
    step_[i] = off_path && stay ? Quad<Real>() : allowed;
    state.x[i] = to_vector(legal_[i]);
    state.v[i] = to_vector(step_[i]) / dt;
  };
  for (const Critical& c : critical_) {
    for (const Index k : pairs_[static_cast<std::size_t>(c.pair)].particle) visit(k);
  }
  for (const Index k : tight_) visit(k);
  critical_.clear();
  tight_.clear();
}

/// Sums up the motion of particles in pairs.
template <class Real>
void ClothGuard<Real>::count_motion() {
  allowed_ = 0;
  for (const Index k : active_)
    allowed_ += static_cast<double>(length(step_[static_cast<std::size_t>(k)]));
  counts_.truncated += lost_;
  counts_.wanted += allowed_ + lost_;
  lost_ = 0;
}

#define WEFT_INSTANTIATE(Real)                                                          \
  template void ClothGuard<Real>::certify(ClothState<Real>&, Real, Profile&);           \
  template bool ClothGuard<Real>::common_way_is_short() const;                          \
  template void ClothGuard<Real>::halt(ClothState<Real>&);                              \
  template bool ClothGuard<Real>::stays_calm(const ClothState<Real>&, Real) const;      \
  template bool ClothGuard<Real>::has_leeway(const ClothState<Real>&, Real) const;      \
  template void ClothGuard<Real>::note_ends(const ClothState<Real>&, Real);             \
  template void ClothGuard<Real>::note_paths();                                         \
  template void ClothGuard<Real>::leave_calm_paths(int, Real, const Vec3<Real>&, bool); \
  template void ClothGuard<Real>::stop_crossings();                                     \
  template bool ClothGuard<Real>::find_critical();                                      \
  template bool ClothGuard<Real>::is_critical(GuardedPair<Real>&);                      \
  template bool ClothGuard<Real>::holds(const Critical&) const;                         \
  template void ClothGuard<Real>::fix(Critical&);                                       \
  template void ClothGuard<Real>::truncate(ClothState<Real>&, Real, bool);              \
  template void ClothGuard<Real>::count_motion();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
