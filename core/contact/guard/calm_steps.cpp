// Certifies a step by the largest displacement of any particle from where it is expected.

#include "core/contact/guard/calm_steps.h"

#include <cassert>

#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/contact/travel.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// A bound of how far any particle is off its straight path after the drift [m].
/// @param base      where the paths are at time 0 [m]
/// @param velocity  along them [m/s]
/// @param time      at the end of the drift [s]
template <class Real>
Real farthest_off(const ClothState<Real>& state, Real dt, const Vec3Array<Real>& base,
                  const Vec3Array<Real>& velocity, Real time, Executor* executor) {
  assert(base.size() == state.x.size() && velocity.size() == state.x.size());
  const PathPass<Real> pass{state.x.size(),
                            state.x.data()->data(),
                            state.v.data()->data(),
                            dt,
                            base.data()->data(),
                            velocity.data()->data(),
                            time};
  return largest_deviation(pass, executor) * static_cast<Real>(kDiagonal);
}

}  // namespace

template <class Real>
bool stays_calm(const CalmPaths<Real>& calm, const PredictedPaths<Real>& paths,
                const ClothState<Real>& state, Real dt, Executor* executor) {
  return paths.hold() &&
         farthest_off(state, dt, calm.base, calm.velocity, paths.elapsed, executor) <= calm.reach;
}

template <class Real>
void note_calm_paths(const PredictedPaths<Real>& paths, Executor* executor,
                     CalmSteps<Real>& steps) {
  assert(paths.collected);
  CalmPaths<Real>& calm = steps.paths;
  steps.noted_off = paths.off;
  run_ranges(executor, calm.base.size(), kCopiesAtLeast, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      calm.base[i] = to_vector(paths.at(i, 0) + paths.off);
      calm.velocity[i] = to_vector(paths.velocity[i]);
    }
  });
  calm.fastest = paths.fastest;
  calm.time = paths.elapsed;
  calm.horizon = paths.horizon;
  ++calm.number;
}

template <class Real>
bool has_slack(const Slack<Real>& slack, const PredictedPaths<Real>& paths,
               const ClothState<Real>& state, Real dt, Executor* executor) {
  if (!(slack.left > 0) || !paths.hold()) return false;
  const Real along_paths =
      (paths.fastest + length(paths.common_velocity)) * (paths.elapsed - slack.time);
  return farthest_off(state, dt, slack.ends, slack.ends, Real(0), executor) + along_paths <=
         slack.left;
}

template <class Real>
void note_ends(const ClothState<Real>& state, Real dt, Real elapsed, Executor* executor,
               Slack<Real>& slack) {
  assert(slack.ends.size() == state.x.size());
  slack.time = elapsed;
  if (!(slack.left > 0)) return;
  run_ranges(executor, slack.ends.size(), kCopiesAtLeast, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) slack.ends[i] = state.x[i] + state.v[i] * dt;
  });
}

WEFT_INSTANTIATE_FUNCTIONS(stays_calm, note_calm_paths, has_slack, note_ends)

}  // namespace weft
