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

// What a quad of Regions::sizes holds of a particle [m]: one comparison finds the largest of each
// for a side of a pair.

/// Radius of its region, 0 while it is being anchored; length of its displacement in the coming
/// step; room that bounds should leave it if it is being anchored, otherwise -1; displacement of
/// its anchor in this wave.
inline constexpr int kRadiusLane = 0, kLengthLane = 1, kAheadLane = 2, kMovedLane = 3;

/// A pair of a particle that is being anchored.
template <class Real>
struct AnchorClaim {
  Index pair = 0;
  bool ample = false;     ///< the bound is far more than any of its particles needs
  bool measured = false;  ///< the bound is measured anew
  Real bound = 0;         ///< of the pair's gap after the anchors moved, if it is not [m]
  /// Radii of the particles that keep their anchors, on its side and across [m].
  Real own = 0, other = 0;
  /// How far the sides want to move in the coming step, its own and the other [m].
  Real own_length = 0, other_length = 0;
};

/// A pair whose bound falls by the displacements of its anchors.
template <class Real>
struct LoweredBound {
  Index pair = 0;
  Real bound = 0;  ///< [m]
};

/// Some of the particles that are anchored together.
template <class Real>
struct AnchorPart {
  ColumnsByKind<Real> columns;              ///< of pairs whose bounds are to be measured
  std::vector<LoweredBound<Real>> lowered;  ///< the others whose anchors moved
  std::vector<AnchorClaim<Real>> claims;    ///< of its particles, in their order
  std::vector<std::size_t> ends;            ///< of each particle's claims
  std::vector<Real> radii;                  ///< that each particle gets [m]
  std::vector<Index> next;                  ///< particles to be anchored besides
};

/// The region of each particle. While all stay inside theirs, nothing crosses.
template <class Real>
struct Regions {
  Real smallest_gap = 0;                   ///< left between features after every step [m]
  QuadArray<Real> anchor;                  ///< centres [m]
  QuadArray<Real> sizes;                   ///< of each particle, see kRadiusLane
  std::uint64_t measured = 0;              ///< step in which lengths were measured last
  std::vector<std::uint64_t> anchored_at;  ///< step in which each was anchored last
  std::vector<Index> anchored;             ///< particles anchored in this step
  std::vector<Index> dirty;                ///< particles to be anchored in any case
  std::vector<Index> loose;                ///< particles that would leave their regions
  std::uint64_t wave = 0;                  ///< number of the last pass that marks particles
  std::vector<std::uint64_t> wave_of;      ///< the last pass that marked each
  std::vector<Index> in_wave;              ///< particles of this wave of anchoring
  std::vector<AnchorPart<Real>> parts;     ///< of a wave
  ColumnsByKind<Real> columns;             ///< pairs that are measured together
  std::vector<std::vector<Real>> radii;    ///< that parts of the pairs leave to all particles [m]

  Real radius(std::size_t particle) const { return sizes[particle][kRadiusLane]; }
  Real length(std::size_t particle) const { return sizes[particle][kLengthLane]; }
};

/// Anchors all particles in pairs where they are.
template <class Real>
void anchor_anew(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 Regions<Real>& regions);

/// Shares the gap of each pair by the speeds of its sides.
template <class Real>
void share_all_gaps(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                    Executor* executor, Regions<Real>& regions);

/// Gives regions to particles that had no pairs, and marks as dirty those with larger ones than a
/// new pair allows. Call before the new pairs are listed.
/// @param first  number of the first new pair
template <class Real>
void admit_pairs(std::size_t first, const GuardedStep<Real>& step, Executor* executor,
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
void anchor_loose(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Regions<Real>& regions,
                  Executor* executor, GuardCounts& counts);

}  // namespace weft
