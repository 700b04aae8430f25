#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/awake_particles.h"
#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/guarded_step.h"
#include "core/contact/guard/pair_separation.h"
#include "core/contact/guard/predicted_paths.h"
#include "core/contact/guard/regions.h"
#include "core/contact/guard/stopped_particles.h"
#include "core/executor.h"
#include "core/types.h"

// Steps that are longer than their regions: certified pair by pair, or stopped.

namespace weft {

/// A pair whose coming step is certified by itself.
template <class Real>
struct CriticalPair {
  Index pair = kNone;
  Vec3<Real> normal = Vec3<Real>::Zero();
  Real gap = 0;                               ///< along the normal [m]
  std::array<Real, 4> weight = {0, 0, 0, 0};  ///< of the closest points
  bool fixed = false;                         ///< stopped at planes
  std::uint64_t held_at = 0;                  ///< number of stops when it was last found to hold
};

/// What one step had no region for.
template <class Real>
struct CriticalSteps {
  std::vector<CriticalPair<Real>> pairs;
  std::vector<Index> tight;    ///< particles whose displacement is longer than their region
  std::vector<char> is_tight;  ///< of each particle
  std::vector<Real> fraction;  ///< of each one's displacement that is allowed
  std::uint64_t stops = 0;     ///< how often a fraction was lowered
  std::vector<std::uint64_t> stopped_at;  ///< of each particle the number of its last stop
  ColumnsByKind<Real> columns;            ///< pairs to be measured
};

/// Notes the displacement and velocity of the centre of mass, if all particles are awake, free, and
/// have room to move by it. What is stopped as seen from there keeps what all have in common.
/// @param room  see ClothGuard::certify
template <class Real>
void find_common(const AwakeParticles& awake, const std::vector<Real>& inverse_mass, Real dt,
                 const std::function<Real()>& room, GuardedStep<Real>& step);

/// Certifies or stops the displacements of particles that are too long for their regions. Particles
/// of pairs that these endanger are anchored first.
template <class Real>
void stop_crossings(GuardedPairs<Real>& pairs, GuardedStep<Real>& step, Regions<Real>& regions,
                    CriticalSteps<Real>& critical, Executor* executor, GuardCounts& counts);

/// Applies to the state what was not allowed, for the coming drift. Particles stopped off their
/// predicted paths are listed as strays, which ask for pairs around a new one; what the others may
/// do then is examined anew.
/// @param stay  strays stay where they are, so that none is stopped a second time
template <class Real>
void truncate(const GuardedPairs<Real>& pairs, const GuardedCloths<Real>& cloths, Real dt,
              bool stay, CriticalSteps<Real>& critical, GuardedStep<Real>& step,
              Regions<Real>& regions, PredictedPaths<Real>& paths, StoppedParticles<Real>& stopped,
              ClothState<Real>& state);

/// Forgets what was found in a step that was ended from outside; keeps the memory.
template <class Real>
void forget_critical(CriticalSteps<Real>& critical);

}  // namespace weft
