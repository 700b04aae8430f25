#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/guarded_step.h"
#include "core/contact/guard/pair_separation.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// Regions: balls around anchors in which particles are free, as they share out the gaps of pairs.

namespace weft {

/// A pair of a particle that is being anchored.
template <class Real>
struct AnchorClaim {
  Index pair = 0;
  bool ample = false;  ///< the bound is far more than any of its particles needs
  /// Radii of the particles that keep their anchors, on its side and across [m].
  Real own = 0, other = 0;
  /// How far the sides want to move in the coming step, its own and the other [m].
  Real own_length = 0, other_length = 0;
};

/// Some of the particles that are anchored together.
template <class Real>
struct AnchorPart {
  ColumnsByKind<Real> columns;            ///< of pairs whose bounds are to be measured
  std::vector<AnchorClaim<Real>> claims;  ///< of its particles, in their order
  std::vector<std::size_t> ends;          ///< of each particle's claims
  std::vector<Index> next;                ///< particles to be anchored besides
};

/// The region of each particle. While all stay inside theirs, nothing crosses.
template <class Real>
struct Regions {
  Real smallest_gap = 0;                   ///< left between features after every step [m]
  QuadArray<Real> anchor;                  ///< centres [m]
  std::vector<Real> radius;                ///< [m]
  std::vector<std::uint64_t> anchored_at;  ///< step in which each was anchored last
  std::vector<Index> anchored;             ///< particles anchored in this step
  std::vector<Index> dirty;                ///< particles to be anchored in any case
  std::vector<Index> loose;                ///< particles that would leave their regions
  std::uint64_t wave = 0;                  ///< number of the last pass that marks particles
  std::vector<std::uint64_t> wave_of;      ///< the last pass that marked each
  std::vector<Index> in_wave;              ///< particles of this wave of anchoring
  std::vector<AnchorPart<Real>> parts;     ///< of a wave
  ColumnsByKind<Real> columns;             ///< pairs that are measured together
};

/// Anchors all particles in pairs where they are.
template <class Real>
void anchor_anew(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 Regions<Real>& regions);

/// Shares the gap of each pair by the speeds of its sides.
template <class Real>
void share_all_gaps(const GuardedPairs<Real>& pairs, GuardedStep<Real>& step,
                    Regions<Real>& regions);

/// Gives regions to particles that had no pairs, and marks as dirty those with larger ones than a
/// new pair allows. Call before the new pairs are listed.
/// @param first  number of the first new pair
template <class Real>
void admit_pairs(std::size_t first, GuardedStep<Real>& step, Executor* executor,
                 GuardedPairs<Real>& pairs, Regions<Real>& regions);

/// Lists the dirty particles and those that would leave their regions in the coming step.
/// @return by how much any other particle may yet move before it leaves its region, at least [m]
template <class Real>
Real find_loose(const std::vector<Index>& active, const GuardedStep<Real>& step,
                Regions<Real>& regions);

/// Measures the bound of a pair anew.
template <class Real>
void measure(const Regions<Real>& regions, GuardedPair<Real>& pair);

/// Anchors the loose particles where they are, and gives them new regions. Particles that are in
/// their way, with larger regions than the gap now allows, are anchored anew as well.
template <class Real>
void anchor_loose(GuardedPairs<Real>& pairs, GuardedStep<Real>& step, Regions<Real>& regions,
                  Executor* executor, GuardCounts& counts);

}  // namespace weft
