#pragma once

#include <cstdint>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/predicted_paths.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// Steps that one bound for all particles certifies: nothing is near, or all lie nearly still.

namespace weft {

/// Straight paths of all particles. While no two features can meet that go along them, all that has
/// to be checked is that every particle stays near its path, but for a displacement common to all.
template <class Real>
struct CalmPaths {
  Vec3Array<Real> base;      ///< where each path is at time 0 [m]
  Vec3Array<Real> velocity;  ///< along it [m/s]
  Real fastest = 0;          ///< the largest of these [m/s]
  Real time = 0;             ///< now [s]
  Real horizon = 0;          ///< until then the paths hold [s]
  Real reach = 0;            ///< no particle may be farther off its path [m]
  std::uint64_t number = 0;  ///< of these paths; others have another one
};

/// Steps without any pair.
template <class Real>
struct CalmSteps {
  bool calm = false;         ///< there was no pair when the step began
  Vec3Array<Real> x_before;  ///< if so, the positions then [m]
  CalmPaths<Real> paths;     ///< if so; their bases include noted_off
  Quad<Real> noted_off;      ///< PredictedPaths::off when these were noted [m]
};

/// By how much particles may move before any has to be examined by itself.
template <class Real>
struct Slack {
  Real left = 0;         ///< every particle may move this far from its end [m]; 0 if not known
  Vec3Array<Real> ends;  ///< where each was after the last step that was examined [m]
  Real time = 0;         ///< when that was, as PredictedPaths::elapsed [s]
};

/// Whether, while there are no pairs, all particles stay near their paths in the coming step.
template <class Real>
bool stays_calm(const CalmPaths<Real>& calm, const PredictedPaths<Real>& paths,
                const ClothState<Real>& state, Real dt, Executor* executor);

/// Notes the predicted paths for steps without pairs.
template <class Real>
void note_calm_paths(const PredictedPaths<Real>& paths, Executor* executor, CalmSteps<Real>& steps);

/// Whether no particle leaves the ball around its path or its region in the coming step, by a bound
/// for all at once: what rests is not examined one by one.
template <class Real>
bool has_slack(const Slack<Real>& slack, const PredictedPaths<Real>& paths,
               const ClothState<Real>& state, Real dt, Executor* executor);

/// Notes where all particles are at the end of a step, if there is slack from there.
template <class Real>
void note_ends(const ClothState<Real>& state, Real dt, Real elapsed, Executor* executor,
               Slack<Real>& slack);

}  // namespace weft
