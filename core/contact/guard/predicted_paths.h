#pragma once

#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/awake_particles.h"
#include "core/contact/guard/guarded_step.h"
#include "core/contact/guard/patch_tree.h"
#include "core/contact/guard/stray_pass.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// Straight paths along which particles are expected to go on: pairs are collected around them.

namespace weft {

/// What a look at some of the particles found.
template <class Real>
struct StrayPart {
  StrayLook<Real> found;
  std::vector<Index> strays;
};

/// The paths of all particles. Each is followed by a ball, which its particle must not leave.
template <class Real>
struct PredictedPaths {
  bool collected = false;              ///< pairs were collected around them
  QuadArray<Real> from;                ///< where each begins [m]
  std::vector<Real> since;             ///< and when, after all pairs were collected [s]
  QuadArray<Real> velocity;            ///< along each [m/s]
  Real fastest = 0;                    ///< of these [m/s]
  Quad<Real> common_velocity;          ///< of all when pairs were collected [m/s]
  Real horizon = 0, elapsed = 0;       ///< how long the pairs hold, and how old they are [s]
  Quad<Real> off;                      ///< mean displacement off the paths after the last step [m]
  Quad<Real> off_now;                  ///< with which this step is examined [m]
  Quad<Real> off_before;               ///< and the step before [m]
  std::vector<Index> strays;           ///< particles that leave the balls around their paths
  std::vector<StrayPart<Real>> parts;  ///< of a look at all

  bool hold() const { return collected && elapsed <= horizon; }
  /// Where a path is at a time after all pairs were collected [m].
  Quad<Real> at(std::size_t i, Real time) const {
    return from[i] + velocity[i] * (time - since[i]);
  }
};

/// Begins a path for every particle, which goes on as it moves now.
/// @param dt      of the coming step [s]
/// @param reach   radius of the balls [m]
/// @param finest  smallest edge length, which decides how long the paths hold [m]
template <class Real>
void begin_paths(const GuardedStep<Real>& step, const AwakeParticles& awake, Real dt, Real reach,
                 Real finest, Executor* executor, PredictedPaths<Real>& paths);

/// Begins new paths for the strays at the start of the coming step; the others go on.
template <class Real>
void begin_paths_of_strays(const GuardedStep<Real>& step, Real dt, Real reach,
                           PredictedPaths<Real>& paths);

/// Motion along the paths until they end, without the common one.
/// @param past  time of its start [s]
template <class Real>
void predict(Real past, Executor* executor, PredictedPaths<Real>& paths,
             PredictedMotion<Real>& motion);

/// Determines the displacements of the coming step. Lists the particles that leave the balls around
/// their paths in it, together with those that soon will. What all leave their paths by in common
/// changes nothing between them, and is known from the step before.
/// @return by how much any particle may yet move before one leaves its ball, at least [m]
template <class Real>
Real find_strays(const ClothState<Real>& state, Real dt, Real reach, const AwakeParticles& awake,
                 Executor* executor, GuardedStep<Real>& step, PredictedPaths<Real>& paths);

/// Whether new paths of strays allow for the displacement from the paths that is common to all. A
/// path begins with the common displacement of the step before, and leaves half of its reach for
/// the increase since then.
template <class Real>
bool allows_for_common(const PredictedPaths<Real>& paths, Real reach);

}  // namespace weft
