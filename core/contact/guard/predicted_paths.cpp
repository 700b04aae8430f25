// Predicts how particles go on, and finds those that do not.

#include "core/contact/guard/predicted_paths.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
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
                 Real finest, Executor* executor, PredictedPaths<Real>& paths) {
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
  run_ranges(executor, step.from.size(), kCopiesAtLeast, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      paths.velocity[i] = path_velocity(paths, step, i, dt, reach);
  });
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
void predict(Real past, Executor* executor, PredictedPaths<Real>& paths,
             PredictedMotion<Real>& motion) {
  assert(motion.start.size() == paths.from.size() && motion.end.size() == paths.from.size());
  const Quad<Real> gone = paths.common_velocity * past;
  const Quad<Real> common = paths.common_velocity * paths.horizon;
  std::array<Real, kMostParts> fastest2{};
  const std::size_t count = paths.from.size();
  run_parts(executor, count, parts_of(count, kCopiesAtLeast),
            [&](std::size_t part, std::size_t first, std::size_t end) {
              for (std::size_t i = first; i < end; ++i) {
                motion.start[i] = paths.at(i, past) - gone;
                motion.end[i] = paths.at(i, paths.horizon) - common;
                fastest2[part] =
                    std::max(fastest2[part], dot(paths.velocity[i], paths.velocity[i]));
              }
            });
  paths.fastest = std::sqrt(*std::max_element(fastest2.begin(), fastest2.end()));
}

template <class Real>
Real find_strays(const ClothState<Real>& state, Real dt, Real reach, const AwakeParticles& awake,
                 Executor* executor, GuardedStep<Real>& step, PredictedPaths<Real>& paths) {
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
  paths.parts.resize(kMostParts);
  const auto look = [&](std::size_t first, std::size_t end, bool awake_ones) {
    const std::size_t count = end - first, parts = parts_of(count, kCopiesAtLeast);
    run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
      StrayPart<Real>& part = paths.parts[n];
      part.strays.clear();
      part.found = look_for_strays(pass, first + from, first + to, part.strays);
    });
    for (std::size_t n = 0; n < parts; ++n) {
      const StrayPart<Real>& part = paths.parts[n];
      paths.strays.insert(paths.strays.end(), part.strays.begin(), part.strays.end());
      farthest2 = std::max(farthest2, part.found.farthest2);
      left |= part.found.left;
      if (awake_ones) sum += part.found.sum;
    }
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
