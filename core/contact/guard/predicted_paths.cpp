// Predicts how particles go on, and finds those that do not.

#include "core/contact/guard/predicted_paths.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/stray_pass.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Steady part of a velocity, without jitter: per component, the smaller of it and of the mean
/// velocity since the path began, or 0 where their signs differ.
template <class Real>
Quad<Real> steady(const PredictedPaths<Real>& paths, const QuadArray<Real>& x, const Quad<Real>& v,
                  std::size_t particle, Real dt) {
  const Real time = paths.elapsed - dt - paths.since[particle];
  if (!paths.collected || !(time > 0)) return v;
  const Quad<Real> mean = (x[particle] - paths.from[particle]) * (Real(1) / time);
  typename Quad<Real>::Lanes size = v.lanes, other = mean.lanes, none = {};
  size = size < Real(0) ? -size : size;
  other = other < Real(0) ? -other : other;
  const typename Quad<Real>::Lanes smaller = size < other ? v.lanes : mean.lanes;
  return {v.lanes * mean.lanes > Real(0) ? smaller : none};
}

/// Velocity of a new path, which has to hold at least for the coming step [m/s].
template <class Real>
Quad<Real> path_velocity(const PredictedPaths<Real>& paths, const GuardedStep<Real>& step,
                         std::size_t particle, Real dt, Real reach) {
  const Quad<Real> now = step.displacement[particle] * (Real(1) / dt);
  const Quad<Real> v = steady(paths, step.from, now, particle, dt);
  const Quad<Real> off = step.displacement[particle] - v * dt;
  return dot(off, off) > reach * reach / 4 ? now : v;
}

}  // namespace

template <class Real>
void begin_paths(const GuardedStep<Real>& step, const AwakeParticles& awake, Real dt, Real reach,
                 Real finest, PredictedPaths<Real>& paths) {
  assert(dt > 0 && reach > 0 && finest > 0);
  // A motion common to all changes nothing between them.
  const Quad<Real> common =
      mean_awake<Real>(awake, [&](std::size_t i) { return step.displacement[i]; });
  paths.common_velocity = common * (Real(1) / dt);
  const Quad<Real> mean_squares = mean_awake<Real>(awake, [&](std::size_t i) {
    const Quad<Real> own = step.displacement[i] - common;
    return Quad<Real>{own.lanes * own.lanes};
  });
  const Real speed = std::sqrt(mean_squares[0] + mean_squares[1] + mean_squares[2]) / dt;
  const Real shortest = dt * Real(kFewestSubsteps);
  const Real way = std::max(finest * Real(kHorizonPart), reach * Real(kHorizonReach));
  paths.horizon = std::clamp(way / std::max(speed, Real(1e-6)), shortest,
                             std::max(static_cast<Real>(kLongestHorizon), shortest));
  for (std::size_t i = 0; i < step.from.size(); ++i)
    paths.velocity[i] = path_velocity(paths, step, i, dt, reach);
  paths.from = step.from;
  paths.since.assign(step.from.size(), 0);
  paths.off = paths.off_now = paths.off_before = {};
}

template <class Real>
void begin_paths_of_strays(const GuardedStep<Real>& step, Real dt, Real reach,
                           PredictedPaths<Real>& paths) {
  assert(paths.collected);
  for (const Index k : paths.strays) {
    const auto i = at_index(k);
    paths.velocity[i] = path_velocity(paths, step, i, dt, reach);
    paths.from[i] = step.from[i] - paths.off_before;
    paths.since[i] = paths.elapsed - dt;
  }
}

template <class Real>
void predict(Real past, PredictedPaths<Real>& paths, PredictedMotion<Real>& motion) {
  assert(motion.start.size() == paths.from.size() && motion.end.size() == paths.from.size());
  const Quad<Real> gone = paths.common_velocity * past;
  const Quad<Real> common = paths.common_velocity * paths.horizon;
  Real fastest2 = 0;
  for (std::size_t i = 0; i < paths.from.size(); ++i) {
    motion.start[i] = paths.at(i, past) - gone;
    motion.end[i] = paths.at(i, paths.horizon) - common;
    fastest2 = std::max(fastest2, dot(paths.velocity[i], paths.velocity[i]));
  }
  paths.fastest = std::sqrt(fastest2);
}

template <class Real>
Real find_strays(const ClothState<Real>& state, Real dt, Real reach, const AwakeParticles& awake,
                 GuardedStep<Real>& step, PredictedPaths<Real>& paths) {
  assert(state.x.size() == step.from.size() && state.v.size() == step.from.size());
  const Real limit2 = reach * reach;
  const StrayPass<Real> pass{state.x.data()->data(),
                             state.v.data()->data(),
                             dt,
                             step.from.data(),
                             step.displacement.data(),
                             paths.from.data(),
                             paths.velocity.data(),
                             paths.since.data(),
                             paths.elapsed,
                             paths.off,
                             limit2 * static_cast<Real>(kSoon * kSoon),
                             limit2};
  paths.strays.clear();
  Quad<Real> sum;
  Real farthest2 = 0;
  bool left = false;
  const auto look = [&](std::size_t first, std::size_t end, bool awake_ones) {
    const StrayLook<Real> found = look_for_strays(pass, first, end, paths.strays);
    farthest2 = std::max(farthest2, found.farthest2);
    left |= found.left;
    if (awake_ones) sum += found.sum;
  };
  std::size_t i = 0;
  for (const IndexRange& range : awake.ranges) {
    const auto first = at_index(range.first), end = at_index(range.end());
    look(i, first, false);
    look(first, end, true);
    i = end;
  }
  look(i, step.displacement.size(), false);
  if (!left || !paths.hold()) paths.strays.clear();
  if (paths.hold()) {
    paths.off_before = paths.off_now;
    paths.off_now = paths.off;
    paths.off = sum * (Real(1) / static_cast<Real>(std::max<std::size_t>(awake.count, 1)));
  }
  // a - b >= (a^2 - b^2) / 2a for 0 <= b <= a.
  return (limit2 - farthest2) / (2 * reach);
}

template <class Real>
bool allows_for_common(const PredictedPaths<Real>& paths, Real reach) {
  const Quad<Real> more = paths.off_now - paths.off_before;
  return dot(more, more) <= reach * reach / 4;
}

WEFT_INSTANTIATE_FUNCTIONS(begin_paths, begin_paths_of_strays, predict, find_strays,
                           allows_for_common)

}  // namespace weft
