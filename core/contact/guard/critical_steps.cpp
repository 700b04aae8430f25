// Finds one axis for each endangered pair that separates it throughout the step, or two planes in
// its gap at which its particles stop.

#include "core/contact/guard/critical_steps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/guard/constants.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// How far a pair's features must be apart, if its particles may move as their regions let them, or
/// by their displacements if these are longer [m].
template <class Real>
Real needed_gap(const GuardedStep<Real>& step, const Regions<Real>& regions,
                const std::vector<char>& is_tight, const GuardedPair<Real>& pair) {
  const auto [first, second] = largest_on_sides(
      pair, [&](std::size_t i) { return is_tight[i] ? step.farthest(i) : regions.radius(i); });
  return first + second + regions.smallest_gap;
}

/// Lists the particles whose displacement is longer than their region.
template <class Real>
void find_tight(const GuardedStep<Real>& step, const Regions<Real>& regions,
                CriticalSteps<Real>& critical) {
  for (const Index i : regions.anchored) critical.is_tight[at_index(i)] = 0;
  critical.tight.clear();
  for (const Index k : regions.anchored) {
    const auto i = at_index(k);
    if (step.farthest(i) <= regions.radius(i)) continue;
    critical.is_tight[i] = 1;
    critical.tight.push_back(k);
  }
}

/// Measures the gaps of the listed pairs anew, and keeps those that are too small.
template <class Real>
void measure_critical(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                      const Regions<Real>& regions, CriticalSteps<Real>& critical) {
  critical.pairs.clear();
  for (PairColumns<Real>& columns : critical.columns) {
    separate_pairs(regions.anchor, regions.anchor, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      GuardedPair<Real>& pair = pairs[columns.a[k]];
      const PairSeparation<Real> s = columns.separation(k, regions.anchor);
      pair.bound = s.gap;
      if (pair.bound >= needed_gap(step, regions, critical.is_tight, pair)) continue;
      critical.pairs.push_back({columns.a[k], s.normal, s.gap, s.weight});
    }
    columns.clear();
  }
}

/// Lists the tight particles and the pairs that these endanger.
/// @return whether some particle of such a pair has to be anchored first; regions.loose lists them.
///         If none has, the pairs' gaps are those where the particles are
template <class Real>
bool find_critical(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Regions<Real>& regions,
                   CriticalSteps<Real>& critical) {
  find_tight(step, regions, critical);
  std::vector<Index>& loose = regions.loose;
  loose.clear();
  ++pairs.listing;
  for (const Index k : critical.tight) {
    for_pairs_of(pairs, at_index(k), [&](GuardedPair<Real>& pair) {
      if (std::exchange(pair.listed, pairs.listing) == pairs.listing) return;
      if (!(pair.bound >= needed_gap(step, regions, critical.is_tight, pair)))
        critical.columns[pair.kind].add(pairs.number_of(pair), 0, pair.particle);
    });
  }
  measure_critical(pairs, step, regions, critical);
  for (const CriticalPair<Real>& c : critical.pairs) {
    for (const Index k : pairs[c.pair].particle) {
      if (regions.anchored_at[at_index(k)] != step.number) loose.push_back(k);
    }
  }
  std::sort(loose.begin(), loose.end());
  loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
  return !loose.empty();
}

/// Whether the displacements, as far as they are allowed, cannot make the sides of a pair meet.
/// @param fraction  of each particle's displacement that is allowed
template <class Real>
bool holds(const CriticalPair<Real>& c, const GuardedPair<Real>& pair,
           const GuardedStep<Real>& step, const std::vector<Real>& fraction, Real smallest_gap) {
  if (!(c.gap > 0)) return false;
  Real side[2] = {0, 0};
  PairPoints<Real> end;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    const Quad<Real> allowed = step.moved(i, fraction[i]), own = allowed - step.common;
    Real& most = side[k < first_side(pair.kind) ? 0 : 1];
    most = std::max(most, dot(own, own));
    end[k] = to_vector(step.from[i] + allowed);
  }
  if (std::sqrt(side[0]) + std::sqrt(side[1]) + smallest_gap <= c.gap) return true;
  // One axis that has the sides apart at both ends has them apart all along straight lines. What
  // is nearer than the smallest gap must not come nearer, rounding included.
  const Real least = std::min(c.gap + smallest_gap / 16, smallest_gap);
  return gap_along(pair.kind, end, c.normal) >= least;
}

/// A pair's particles along its normal, from the first one, both sides towards the other, as seen
/// from what moves by the common displacement [m].
template <class Real>
struct PairHeights {
  std::array<Real, 4> height;        ///< where they are
  std::array<Real, 4> displacement;  ///< how far they want to go
  std::array<Real, 2> front;         ///< least height of each side
  std::array<Real, 2> wish;          ///< by how much each side wants that to fall
};

template <class Real>
PairHeights<Real> heights_of(const CriticalPair<Real>& c, const GuardedPair<Real>& pair,
                             const GuardedStep<Real>& step, const std::vector<Real>& fraction) {
  constexpr Real kFar = std::numeric_limits<Real>::infinity();
  const Quad<Real> normal = to_quad(c.normal);
  const Quad<Real>& origin = step.from[at_index(pair.particle[0])];
  PairHeights<Real> h;
  h.front = {kFar, kFar};
  Real goal[2] = {kFar, kFar};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    const std::size_t s = k < first_side(pair.kind) ? 0 : 1;
    const Real sign = s == 0 ? Real(1) : Real(-1);
    h.height[k] = sign * dot(normal, step.from[i] - origin);
    h.displacement[k] = -sign * dot(normal, step.displacement[i] - step.common);
    h.front[s] = std::min(h.front[s], h.height[k]);
    goal[s] = std::min(goal[s], h.height[k] - h.displacement[k] * fraction[i]);
  }
  h.wish = {std::max(Real(0), h.front[0] - goal[0]), std::max(Real(0), h.front[1] - goal[1])};
  return h;
}

/// Allows a particle no more than a fraction of its displacement.
template <class Real>
void allow(Real fraction, std::size_t particle, CriticalSteps<Real>& critical) {
  if (!(fraction < critical.fraction[particle])) return;
  critical.fraction[particle] = fraction;
  critical.stopped_at[particle] = ++critical.stops;
}

/// Whether a particle of a pair was stopped since the pair was found to hold.
template <class Real>
bool is_changed(const CriticalPair<Real>& c, const GuardedPair<Real>& pair,
                const CriticalSteps<Real>& critical) {
  return std::any_of(pair.particle.begin(), pair.particle.end(),
                     [&](Index k) { return critical.stopped_at[at_index(k)] > c.held_at; });
}

/// Stops the particles of a pair at two planes in its gap, which is shared as they wanted it. The
/// planes move by the common displacement, so that cloth that flies is not held up by itself.
template <class Real>
void stop_at_planes(const CriticalPair<Real>& c, const GuardedPair<Real>& pair,
                    const GuardedStep<Real>& step, Real smallest_gap,
                    CriticalSteps<Real>& critical) {
  std::vector<Real>& fraction = critical.fraction;
  const PairHeights<Real> h = heights_of(c, pair, step, fraction);
  const Real spare = c.gap - smallest_gap;
  const Real both = h.wish[0] + h.wish[1];
  Real part = both > 0 ? h.wish[0] / both : Real(0.5);
  part = std::clamp(part, static_cast<Real>(kLeastPart), static_cast<Real>(1 - kLeastPart));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    const std::size_t s = k < first_side(pair.kind) ? 0 : 1;
    const Real wanted = h.displacement[k];
    if (!(spare > 0)) {
      // No step that rounding could turn into an approach.
      if (!(c.gap > 0) || wanted > -smallest_gap / 16) allow(Real(0), i, critical);
      continue;
    }
    const Real allowed = h.height[k] - h.front[s] + spare * (s == 0 ? part : 1 - part);
    if (wanted * fraction[i] > allowed) allow(allowed / wanted * Real(1 - kStopShort), i, critical);
  }
}

/// Stops the particles of all critical pairs that would not hold otherwise.
/// @return whether those that are stopped have room for rounding, and may move in common
template <class Real>
bool share_gaps(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Real smallest_gap,
                CriticalSteps<Real>& critical) {
  bool have_room = true;
  for (int round = 0;; ++round) {
    stop_point();
    bool changed = false;
    for (CriticalPair<Real>& c : critical.pairs) {
      const GuardedPair<Real>& pair = pairs[c.pair];
      if (c.fixed) continue;
      if (round > 0 && round < kRounds && !is_changed(c, pair, critical)) continue;
      if (round < kRounds && holds(c, pair, step, critical.fraction, smallest_gap)) {
        c.held_at = critical.stops;
        continue;
      }
      stop_at_planes(c, pair, step, smallest_gap, critical);
      c.fixed = changed = true;
      have_room = have_room && c.gap > smallest_gap;
    }
    if (!changed) return have_room;
  }
}

}  // namespace

template <class Real>
void find_common(const AwakeParticles& awake, const std::vector<Real>& inverse_mass, Real dt,
                 const std::function<Real()>& room, GuardedStep<Real>& step) {
  assert(dt > 0 && !step.is_free);
  if (awake.count < inverse_mass.size()) return;
  Vec3d sum = Vec3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < inverse_mass.size(); ++i) {
    if (inverse_mass[i] == 0) return;
    const double own = 1 / static_cast<double>(inverse_mass[i]);
    sum += to_vector(step.displacement[i]).template cast<double>() * own;
    mass += own;
  }
  const Vec3d mean = sum / mass;
  step.is_free = mean.norm() <= static_cast<double>(room());
  if (!step.is_free) return;
  step.common = to_quad<Real>(mean.cast<Real>());
  step.mean_velocity = mean / static_cast<double>(dt);
}

template <class Real>
void stop_crossings(GuardedPairs<Real>& pairs, GuardedStep<Real>& step, Regions<Real>& regions,
                    CriticalSteps<Real>& critical, Executor* executor, GuardCounts& counts) {
  while (find_critical(pairs, step, regions, critical)) {
    stop_point();
    anchor_loose(pairs, step, regions, executor, counts);
  }
  counts.critical += critical.pairs.size();
  const bool flies = dot(step.common, step.common) > 0;
  if (share_gaps(pairs, step, regions.smallest_gap, critical) || !flies) return;
  step.common = {};
  for (CriticalPair<Real>& c : critical.pairs) {
    c.fixed = false;
    for (const Index k : pairs[c.pair].particle) critical.fraction[at_index(k)] = 1;
  }
  share_gaps(pairs, step, regions.smallest_gap, critical);
}

template <class Real>
void truncate(const GuardedPairs<Real>& pairs, const GuardedCloths<Real>& cloths, Real dt,
              bool stay, CriticalSteps<Real>& critical, GuardedStep<Real>& step,
              Regions<Real>& regions, PredictedPaths<Real>& paths, StoppedParticles<Real>& stopped,
              ClothState<Real>& state) {
  assert(dt > 0);
  paths.strays.clear();
  ++regions.wave;
  const Real most_back = cloths.finest * Real(kMostBack) / dt;
  const Vec3<Real> v_common = to_vector(step.common) / dt;
  const auto visit = [&](Index k) {
    const auto i = at_index(k);
    if (regions.wave_of[i] == regions.wave) return;
    regions.wave_of[i] = regions.wave;
    critical.is_tight[i] = 0;
    regions.dirty.push_back(k);
    const Real fraction = std::exchange(critical.fraction[i], Real(1));
    assert(fraction >= 0);
    if (fraction >= 1) return;
    const Quad<Real> allowed = step.moved(i, fraction);
    step.lost += static_cast<double>(length(step.displacement[i] - allowed));
    const Quad<Real> off = step.from[i] + allowed - paths.at(i, paths.elapsed) - paths.off_now;
    const bool off_path = !(dot(off, off) <= cloths.reach * cloths.reach);
    if (off_path) paths.strays.push_back(k);
    step.displacement[i] = off_path && stay ? step.common : allowed;
    state.x[i] = to_vector(step.from[i]);
    const Vec3<Real> v_drift = to_vector(step.displacement[i]) / dt;
    const Vec3<Real> own = state.v[i] - v_common;
    const Vec3<Real> v_back = v_common + own * std::min(Real(1), most_back / own.norm());
    note_stopped<Real>(k, v_back, v_drift, stopped);
    state.v[i] = v_drift;
  };
  for (const CriticalPair<Real>& c : critical.pairs) {
    if (c.fixed) {
      const GuardedPair<Real>& pair = pairs[c.pair];
      stopped.pairs.push_back({pair.particle, c.weight, c.normal, key_of(pair)});
    }
    for (const Index k : pairs[c.pair].particle) visit(k);
  }
  for (const Index k : critical.tight) visit(k);
  critical.pairs.clear();
  critical.tight.clear();
}

template <class Real>
void forget_critical(CriticalSteps<Real>& critical) {
  critical.pairs.clear();
  critical.tight.clear();
  critical.columns.clear();
  std::fill(critical.is_tight.begin(), critical.is_tight.end(), 0);
  std::fill(critical.fraction.begin(), critical.fraction.end(), Real(1));
}

WEFT_INSTANTIATE_FUNCTIONS(forget_critical, find_common, stop_crossings, truncate)

}  // namespace weft
