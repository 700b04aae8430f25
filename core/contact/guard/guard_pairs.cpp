// The broad phase of ClothGuard: pairs of features that could meet while all particles stay near
// their predicted paths.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/guard/cloth_guard.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Gap that every step leaves between features, and the same in units of rounding of the largest
/// coordinate [m].
constexpr double kSmallestGap = 1e-5, kRoundings = 64;

/// Pairs are to hold while the mean particle moves by this part of an edge, but neither longer than
/// these seconds nor shorter than these substeps.
constexpr double kHorizonPart = 0.2, kLongestHorizon = 0.25, kFewestSubsteps = 4;

/// While something crosses it is looked at again so often [s].
constexpr double kLookAgain = 1.0 / 120;

}  // namespace

/// Collects pairs anew around the paths on which all particles go on as they move now.
template <class Real>
void ClothGuard<Real>::collect(const ClothState<Real>& state, Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  const std::size_t n = legal_.size();
  // A motion common to all changes nothing between them.
  const Quad<Real> common = mean_awake([&](std::size_t i) { return step_[i]; });
  common_velocity_ = common * (Real(1) / dt);
  QuadBox<Real> all;
  for (const Quad<Real>& p : legal_) all.add(p);
  const Quad<Real> mean_squares = mean_awake([&](std::size_t i) {
    const Quad<Real> own = step_[i] - common;
    return Quad<Real>{own.lanes * own.lanes};
  });
  Real largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max({largest, -all.lower[k], all.upper[k]});
  smallest_gap_ = std::max(static_cast<Real>(kSmallestGap),
                           largest * std::numeric_limits<Real>::epsilon() * Real(kRoundings));
  const Real speed = std::sqrt(mean_squares[0] + mean_squares[1] + mean_squares[2]) / dt;
  const Real shortest = dt * Real(kFewestSubsteps);
  horizon_ = std::clamp(finest_ * Real(kHorizonPart) / std::max(speed, Real(1e-6)), shortest,
                        std::max(static_cast<Real>(kLongestHorizon), shortest));
  motion_.radius = reach_ + smallest_gap_;
  for (std::size_t i = 0; i < n; ++i) velocity_[i] = path_velocity(i, dt);
  from_ = legal_;
  since_.assign(n, 0);
  predict(0);
  off_path_ = off_path_now_ = off_path_before_ = {};
  boxes_.forget();
  ++counts_.collections;
  tree_.refit(motion_, true);
  if (std::exchange(unseen_, false) || open_pairs() > 0) find_tangles(state);
  pairs_.clear();
  open_pairs_ = 0;
  changed_.assign(n, 1);
  near_patches_.clear();
  tree_.for_each_near_pair([&](Index p, Index q) {
    stop_point(near_patches_.size());
    near_patches_.push_back({p, q});
  });
  test_near_patches(true, profile);
  if (open_pairs() > 0) {
    note_touches();
    horizon_ = std::min(horizon_, std::max(static_cast<Real>(kLookAgain), dt));
  }
  join_pairs();
  most_pairs_ = 2 * pairs_.size() + legal_.size();
  for (const Index i : active_) {
    anchor_[static_cast<std::size_t>(i)] = legal_[static_cast<std::size_t>(i)];
    anchored_at_[static_cast<std::size_t>(i)] = 0;
  }
  share_all_gaps();
  elapsed_ = dt;
  collected_ = true;
  rows_built_ = false;
}

/// Motion along the paths until pairs are collected anew, without the common one.
/// @param past  time of its start [s]
template <class Real>
void ClothGuard<Real>::predict(Real past) {
  const Quad<Real> gone = common_velocity_ * past, common = common_velocity_ * horizon_;
  Real fastest2 = 0;
  for (std::size_t i = 0; i < legal_.size(); ++i) {
    motion_.start[i] = on_path(i, past) - gone;
    motion_.end[i] = on_path(i, horizon_) - common;
    fastest2 = std::max(fastest2, dot(velocity_[i], velocity_[i]));
  }
  fastest_ = std::sqrt(fastest2);
  leeway_ = 0;  // was told from other paths
}

/// Gives particles that leave their paths new ones, and collects their pairs anew; the others go
/// on. What was made for them when they began holds for the rest of their paths.
template <class Real>
void ClothGuard<Real>::collect_strays(Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  const Real past = elapsed_ - dt;
  changed_.assign(legal_.size(), 0);
  for (const Index k : strays_) {
    const auto i = static_cast<std::size_t>(k);
    changed_[i] = 1;
    velocity_[i] = path_velocity(i, dt);
    from_[i] = legal_[i] - off_path_before_;
    since_[i] = past;
  }
  predict(past);
  ++counts_.renewals;
  drop_pairs_of_strays();
  const std::size_t kept = pairs_.size();
  tree_.refit_changed(motion_, changed_);
  for (std::size_t p = 0; p < tree_.patch_count(); ++p) {
    if (tree_.is_marked(static_cast<Index>(p))) boxes_.forget(static_cast<Index>(p));
  }
  near_patches_.clear();
  tree_.for_each_changed_pair([&](Index p, Index q) {
    stop_point(near_patches_.size());
    near_patches_.push_back({p, q});
  });
  test_near_patches(false, profile);
  admit_pairs(kept);
  list_pairs(kept);
  // The rows of pairs that were found again hold as before.
  for (std::size_t k = kept; k < pairs_.size(); ++k) {
    const bool known =
        std::binary_search(dropped_keys_.begin(), dropped_keys_.end(), key_of(pairs_[k]));
    if (!known && !pairs_[k].open) arrived_.push_back(pairs_[k]);
  }
}

/// Drops the pairs of all particles that get new paths, and notes which these were.
template <class Real>
void ClothGuard<Real>::drop_pairs_of_strays() {
  dropped_keys_.clear();
  for (const Index k : strays_) {
    const auto i = static_cast<std::size_t>(k);
    if (!is_active_[i]) continue;
    for_pairs_of(i, [&](GuardedPair<Real>& pair) {
      pair.gone = true;
      dropped_keys_.push_back(key_of(pair));
    });
    pairs_end_[i] = pairs_begin_[i];
    later_[i] = kNone;
  }
  std::sort(dropped_keys_.begin(), dropped_keys_.end());
  if (open_pairs_ == 0) return;
  // Nobody lists the open ones.
  for (GuardedPair<Real>& pair : pairs_) {
    if (!pair.open || pair.gone) continue;
    pair.gone = std::any_of(pair.particle.begin(), pair.particle.end(),
                            [&](Index i) { return changed_[static_cast<std::size_t>(i)] != 0; });
    open_pairs_ -= pair.gone ? 1 : 0;
  }
}

/// Gives room to particles that had no pairs, and lists for anchoring whoever has more than a new
/// pair allows.
/// @param first  new pair
template <class Real>
void ClothGuard<Real>::admit_pairs(std::size_t first) {
  const auto for_new = [&](auto&& visit) {
    for (std::size_t k = first; k < pairs_.size(); ++k) {
      if (!pairs_[k].open) visit(pairs_[k]);
    }
  };
  for_new([&](const GuardedPair<Real>& pair) {
    for (const Index k : pair.particle) {
      const auto i = static_cast<std::size_t>(k);
      if (is_active_[i]) continue;
      anchor_[i] = legal_[i];
      x_rows_[i] = legal_[i];
      room_[i] = std::numeric_limits<Real>::infinity();
    }
  });
  for (std::size_t k = first; k < pairs_.size(); ++k)
    columns_[pairs_[k].kind].add(static_cast<Index>(k), 0, pairs_[k].particle);
  for (PairColumns<Real>& columns : columns_) {
    separate_pairs(anchor_, anchor_, columns, executor_);
    for (std::size_t k = 0; k < columns.size(); ++k)
      pairs_[static_cast<std::size_t>(columns.a[k])].bound = columns.certified_gap(k, anchor_);
    columns.clear();
  }
  measure_steps();
  for_new([&](GuardedPair<Real>& pair) {
    const Real room = std::max(Real(0), pair.bound - smallest_gap_);
    const auto [one, other] = speeds(pair);
    const Real share = one / (one + other);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(pair.particle[k]);
      if (is_active_[i]) continue;
      room_[i] = std::min(room_[i], room * (k < first_side(pair.kind) ? share : 1 - share));
    }
  });
  for_new([&](const GuardedPair<Real>& pair) {
    Real side[2] = {0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
      Real& most = side[k < first_side(pair.kind) ? 0 : 1];
      most = std::max(most, room_[static_cast<std::size_t>(pair.particle[k])]);
    }
    if (side[0] + side[1] + smallest_gap_ <= pair.bound) return;
    dirty_.insert(dirty_.end(), pair.particle.begin(), pair.particle.end());
  });
}

/// Velocity of a predicted path, which has to hold at least for the coming step [m/s].
template <class Real>
Quad<Real> ClothGuard<Real>::path_velocity(std::size_t particle, Real dt) const {
  const Quad<Real> now = step_[particle] * (Real(1) / dt), v = steady(now, particle, dt);
  const Quad<Real> off = step_[particle] - v * dt;
  return dot(off, off) > reach_ * reach_ / 4 ? now : v;
}

/// What of a velocity is not jitter: the smaller of it and of the mean velocity since the path
/// began, by components, and nothing where they disagree.
template <class Real>
Quad<Real> ClothGuard<Real>::steady(const Quad<Real>& v, std::size_t particle, Real dt) const {
  const Real time = elapsed_ - dt - since_[particle];
  if (!collected_ || !(time > 0)) return v;
  const Quad<Real> mean = (legal_[particle] - from_[particle]) * (Real(1) / time);
  Quad<Real> result;
  for (int k = 0; k < 3; ++k) {
    if (v[k] * mean[k] > 0) result.lanes[k] = std::abs(v[k]) < std::abs(mean[k]) ? v[k] : mean[k];
  }
  return result;
}

/// Lists the pairs of each particle.
template <class Real>
void ClothGuard<Real>::join_pairs() {
  const std::size_t n = legal_.size();
  pairs_begin_.assign(n + 1, 0);
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open) continue;
    for (const Index i : pair.particle) ++pairs_begin_[static_cast<std::size_t>(i) + 1];
  }
  active_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (pairs_begin_[i + 1] > 0) active_.push_back(static_cast<Index>(i));
    pairs_begin_[i + 1] += pairs_begin_[i];
  }
  pairs_of_.resize(static_cast<std::size_t>(pairs_begin_[n]));
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    if (pairs_[k].open) continue;
    // Filled from the back of each particle's list, whose begin then stands where it shall.
    for (const Index i : pairs_[k].particle)
      pairs_of_[static_cast<std::size_t>(--pairs_begin_[static_cast<std::size_t>(i) + 1])] =
          static_cast<Index>(k);
  }
  pairs_end_.resize(n);
  for (std::size_t i = 0; i < n; ++i) pairs_begin_[i] = pairs_begin_[i + 1];
  pairs_begin_[n] = static_cast<Index>(pairs_of_.size());
  for (std::size_t i = 0; i < n; ++i) {
    pairs_end_[i] = pairs_begin_[i + 1];
    is_active_[i] = pairs_end_[i] > pairs_begin_[i] ? 1 : 0;
  }
  later_.assign(n, kNone);
}

/// Lists later pairs with their particles.
template <class Real>
void ClothGuard<Real>::list_pairs(std::size_t first) {
  for (std::size_t k = first; k < pairs_.size(); ++k) {
    GuardedPair<Real>& pair = pairs_[k];
    if (pair.open) continue;
    for (std::size_t m = 0; m < 4; ++m) {
      const auto i = static_cast<std::size_t>(pair.particle[m]);
      pair.next[m] = std::exchange(later_[i], static_cast<Index>(4 * k + m));
      if (!std::exchange(is_active_[i], 1)) active_.push_back(pair.particle[m]);
    }
  }
}

/// Shares the gap of each pair by the speeds of its sides.
template <class Real>
void ClothGuard<Real>::share_all_gaps() {
  measure_steps();
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    room_[i] = std::numeric_limits<Real>::infinity();
  }
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open || pair.gone) continue;
    const Real room = std::max(Real(0), pair.bound - smallest_gap_);
    const auto [first, second] = speeds(pair);
    const Real share = first / (first + second);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(pair.particle[k]);
      room_[i] = std::min(room_[i], room * (k < first_side(pair.kind) ? share : 1 - share));
    }
  }
  dirty_.clear();
}

#define WEFT_INSTANTIATE(Real)                                                              \
  template void ClothGuard<Real>::collect(const ClothState<Real>&, Real, Profile&);         \
  template void ClothGuard<Real>::collect_strays(Real, Profile&);                           \
  template void ClothGuard<Real>::admit_pairs(std::size_t);                                 \
  template Quad<Real> ClothGuard<Real>::path_velocity(std::size_t, Real) const;             \
  template Quad<Real> ClothGuard<Real>::steady(const Quad<Real>&, std::size_t, Real) const; \
  template void ClothGuard<Real>::drop_pairs_of_strays();                                   \
  template void ClothGuard<Real>::list_pairs(std::size_t);                                  \
  template void ClothGuard<Real>::predict(Real);                                            \
  template void ClothGuard<Real>::join_pairs();                                             \
  template void ClothGuard<Real>::share_all_gaps();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
