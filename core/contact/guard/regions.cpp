// Anchors particles in waves, and shares the gaps of their pairs.

#include "core/contact/guard/regions.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <utility>

#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// The part of a gap that a side gets, by how far the sides want to move in the coming step: each
/// at least a little.
/// @param own, other  lengths of their displacements [m]
template <class Real>
Real share_of(Real own, Real other) {
  const Real both = std::max(own, other) * Real(kLeastShare) + Real(1e-9);
  return (own + both) / ((own + both) + (other + both));
}

/// Measures how far all want to move, once a step: gaps are shared by what was wanted at first.
template <class Real>
void measure_lengths(const GuardedStep<Real>& step, Regions<Real>& regions) {
  if (std::exchange(regions.measured, step.number) == step.number) return;
  for (std::size_t i = 0; i < step.displacement.size(); ++i)
    regions.sizes[i].lanes[kLengthLane] = length(step.displacement[i]);
}

/// Tells the particles of a pair their side's share of its gap.
/// @param take  called with each particle and the share [m]
template <class Real, class Take>
[[gnu::always_inline]] inline void share_gap(const GuardedPair<Real>& pair,
                                             const Regions<Real>& regions, Take&& take) {
  const Real gap = std::max(Real(0), pair.bound - regions.smallest_gap);
  const auto [first, second] =
      largest_on_sides(pair, [&](std::size_t i) { return regions.length(i); });
  const Real share = share_of(first, second);
  for (std::size_t k = 0; k < 4; ++k)
    take(at_index(pair.particle[k]), gap * (k < first_side(pair.kind) ? share : 1 - share));
}

template <class Real>
Quad<Real> largest_of(const Quad<Real>& a, const Quad<Real>& b) {
  return {a.lanes > b.lanes ? a.lanes : b.lanes};
}

/// The largest sizes on each side of a pair.
template <class Real>
struct SidesOfPair {
  Quad<Real> first, second;
};

template <class Real>
[[gnu::always_inline]] inline SidesOfPair<Real> sides_of(const GuardedPair<Real>& pair,
                                                         const QuadArray<Real>& sizes) {
  const auto of = [&](std::size_t k) -> const Quad<Real>& {
    return sizes[at_index(pair.particle[k])];
  };
  // Both kinds come in any order, which no branch could guess.
  const Quad<Real> none{{-1, -1, -1, -1}};
  const bool vertex = pair.kind == PairKind::vertex_triangle;
  const Quad<Real>*on_first = vertex ? &none : &of(1), *on_second = vertex ? &of(1) : &none;
  return {largest_of(of(0), *on_first), largest_of(largest_of(of(2), of(3)), *on_second)};
}

/// Whether a particle is the first one of a pair that is being anchored.
template <class Real>
bool asks_for(Index particle, const GuardedPair<Real>& pair, const QuadArray<Real>& sizes) {
  for (const Index k : pair.particle) {
    if (sizes[at_index(k)][kAheadLane] >= 0) return k == particle;
  }
  return false;
}

/// Lists the pairs of a particle with the radii that others have in them. Pairs whose bound may be
/// too small for a particle that is being anchored are listed for measuring. Of a pair's particles
/// in the wave, only the first lists what becomes of the bound.
template <class Real>
void list_claims(Index particle, const GuardedPairs<Real>& pairs, const Regions<Real>& regions,
                 AnchorPart<Real>& part) {
  const Real ahead = regions.sizes[at_index(particle)][kAheadLane];
  assert(ahead >= 0 && "is being anchored");
  for_pairs_of(pairs, at_index(particle), [&](const GuardedPair<Real>& pair) {
    const auto [first, second] = sides_of(pair, regions.sizes);
    const std::array<Index, 4>& p = pair.particle;
    const bool on_first =
        particle == p[0] || (pair.kind == PairKind::edge_edge && particle == p[1]);
    const Quad<Real>&own = on_first ? first : second, &across = on_first ? second : first;
    // The bound of a gap falls by no more than the largest displacements of both sides' anchors.
    const Real moved = first[kMovedLane] + second[kMovedLane], bound = pair.bound - moved;
    const Real most = std::max(first[kRadiusLane], second[kRadiusLane]);
    const auto leaves = [&](const Quad<Real>& side, const Quad<Real>& other) {
      return side[kAheadLane] < 0 || bound > most + other[kRadiusLane] + side[kAheadLane];
    };
    AnchorClaim<Real>& claim = part.claims.emplace_back();
    claim.pair = pairs.number_of(pair);
    claim.ample = bound > most + across[kRadiusLane] + ahead;
    claim.measured = !(leaves(first, second) && leaves(second, first));
    claim.bound = bound;
    claim.own = own[kRadiusLane];
    claim.other = across[kRadiusLane];
    claim.own_length = own[kLengthLane];
    claim.other_length = across[kLengthLane];
    if (!asks_for(particle, pair, regions.sizes)) return;
    if (claim.measured)
      part.columns[pair.kind].add(claim.pair, 0, p);
    else if (moved > 0)
      part.lowered.push_back({claim.pair, bound});
  });
  part.ends.push_back(part.claims.size());
}

/// Measures the gaps of the pairs in the columns.
template <class Real>
void measure_claimed(const QuadArray<Real>& anchor, AnchorPart<Real>& part) {
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(anchor, anchor, columns);
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns.gap[k] = columns.certified_gap(k, anchor);
  }
}

/// The radius that all pairs leave a particle: its side's share of the gap, and no more than what
/// the other side has not taken. Lists particles that have taken too much.
/// @param claims  all of one particle
/// @param first   in the first wave
template <class Real>
Real share_claims(Index particle, std::span<const AnchorClaim<Real>> claims, bool first,
                  const GuardedPairs<Real>& pairs, const Regions<Real>& regions,
                  std::vector<Index>& next) {
  Real radius = std::numeric_limits<Real>::infinity();
  const Real length = regions.length(at_index(particle));
  for (const AnchorClaim<Real>& claim : claims) {
    const Real bound = claim.measured ? pairs[claim.pair].bound : claim.bound;
    const Real gap = std::max(Real(0), bound - regions.smallest_gap);
    const Real left = gap - claim.other;
    // What is far apart, even if its side gets the least share, changes nothing.
    if (gap * Real(kLeastOfGap) >= radius &&
        (claim.ample || (left >= std::max(radius, 2 * length) && left >= claim.own)))
      continue;
    const Real share = gap * share_of(claim.own_length, claim.other_length);
    radius = std::min(radius, std::max(Real(0), std::min(share, left)));
    // The others' radii alone are too much for the gap, or they leave less than the next steps
    // need.
    const bool too_much = claim.own + claim.other > gap;
    const bool greedy = first && left < share && left < 2 * length;
    if (!too_much && !greedy) continue;
    for (const Index j : pairs[claim.pair].particle) {
      const bool keeps_anchor = regions.sizes[at_index(j)][kAheadLane] < 0;
      if (keeps_anchor && (greedy || regions.radius(at_index(j)) > 0)) next.push_back(j);
    }
    next.push_back(particle);
  }
  return radius;
}

/// Moves the anchors of a wave's particles to where these are.
template <class Real>
void move_anchors(const GuardedStep<Real>& step, Regions<Real>& regions, GuardCounts& counts) {
  for (const Index k : regions.in_wave) {
    const auto i = at_index(k);
    Quad<Real>& sizes = regions.sizes[i];
    sizes.lanes[kRadiusLane] = 0;
    sizes.lanes[kAheadLane] = sizes[kLengthLane] * Real(2 * kStepsOfRoom) + regions.smallest_gap;
    if (regions.anchored_at[i] == step.number) continue;
    regions.anchored_at[i] = step.number;
    regions.anchored.push_back(k);
    ++counts.anchored;
    sizes.lanes[kMovedLane] = length(step.from[i] - regions.anchor[i]);
    regions.anchor[i] = step.from[i];
  }
}

/// Lists the claims of a part's particles, and measures the bounds that they need.
template <class Real>
void list_part(std::span<const Index> particles, const GuardedPairs<Real>& pairs,
               const Regions<Real>& regions, AnchorPart<Real>& part) {
  part.claims.clear();
  part.lowered.clear();
  part.ends.clear();
  for (const Index k : particles) list_claims(k, pairs, regions, part);
  measure_claimed(regions.anchor, part);
}

/// Notes the bounds that a part has found.
template <class Real>
void note_bounds(AnchorPart<Real>& part, GuardedPairs<Real>& pairs) {
  for (const LoweredBound<Real>& lowered : part.lowered) pairs[lowered.pair].bound = lowered.bound;
  for (PairColumns<Real>& columns : part.columns) {
    for (std::size_t k = 0; k < columns.size(); ++k) pairs[columns.a[k]].bound = columns.gap[k];
    columns.clear();
  }
}

/// Finds the radii that a part's particles get, and those that have to be anchored besides.
template <class Real>
void share_part(std::span<const Index> particles, bool first, const GuardedPairs<Real>& pairs,
                const Regions<Real>& regions, AnchorPart<Real>& part) {
  part.radii.clear();
  part.next.clear();
  const std::span<const AnchorClaim<Real>> claims = part.claims;
  for (std::size_t k = 0, begin = 0; k < particles.size(); ++k) {
    const std::size_t end = part.ends[k];
    part.radii.push_back(share_claims<Real>(particles[k], claims.subspan(begin, end - begin), first,
                                            pairs, regions, part.next));
    begin = end;
  }
}

template <class Real>
void end_anchoring(Index particle, Real radius, Regions<Real>& regions) {
  Quad<Real>& sizes = regions.sizes[at_index(particle)];
  sizes.lanes[kRadiusLane] = radius;
  sizes.lanes[kAheadLane] = -1;
  sizes.lanes[kMovedLane] = 0;
}

/// Anchors the particles of a wave, and puts those of the next one in their place.
/// @param first  it is the first wave
template <class Real>
void anchor_wave(bool first, GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 Regions<Real>& regions, Executor* executor, GuardCounts& counts) {
  move_anchors(step, regions, counts);
  std::vector<Index>& in_wave = regions.in_wave;
  const std::size_t count = in_wave.size(), parts = parts_of(count, kAnchoredAtLeast);
  const std::span<const Index> wave = in_wave;
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    list_part(wave.subspan(from, to - from), pairs, regions, regions.parts[n]);
  });
  run_parts(executor, count, parts,
            [&](std::size_t n, std::size_t, std::size_t) { note_bounds(regions.parts[n], pairs); });
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    share_part(wave.subspan(from, to - from), first, pairs, regions, regions.parts[n]);
  });
  const std::span<const AnchorPart<Real>> done(regions.parts.data(), parts);
  std::size_t ended = 0;
  for (const AnchorPart<Real>& part : done) {
    for (const Real radius : part.radii) end_anchoring(wave[ended++], radius, regions);
  }
  in_wave.clear();
  for (const AnchorPart<Real>& part : done)
    in_wave.insert(in_wave.end(), part.next.begin(), part.next.end());
  std::sort(in_wave.begin(), in_wave.end());
  in_wave.erase(std::unique(in_wave.begin(), in_wave.end()), in_wave.end());
}

/// Anchors and measures everything.
template <class Real>
void anchor_all(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Executor* executor,
                Regions<Real>& regions) {
  for (const Index k : pairs.active) {
    const auto i = at_index(k);
    if (regions.anchored_at[i] != step.number) regions.anchored.push_back(k);
    regions.anchored_at[i] = step.number;
    regions.anchor[i] = step.from[i];
  }
  for_pairs_from(pairs, 0, [&](GuardedPair<Real>& pair) { measure(regions, pair); });
  share_all_gaps(pairs, step, executor, regions);
}

}  // namespace

template <class Real>
void anchor_anew(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 Regions<Real>& regions) {
  for (const Index k : pairs.active) {
    const auto i = at_index(k);
    regions.anchor[i] = step.from[i];
    regions.anchored_at[i] = 0;
  }
}

/// Parts of the pairs leave radii of their own, whose least one counts, in whatever order.
template <class Real>
void share_all_gaps(const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                    Executor* executor, Regions<Real>& regions) {
  measure_lengths(step, regions);
  const std::size_t n = regions.sizes.size(), parts = parts_of_pairs(pairs.all.size());
  regions.radii.resize(std::max(regions.radii.size(), parts));
  run_parts(
      executor, pairs.all.size(), parts, [&](std::size_t p, std::size_t first, std::size_t last) {
        std::vector<Real>& radii = regions.radii[p];
        radii.assign(n, std::numeric_limits<Real>::infinity());
        for_pairs_between(pairs, first, last, [&](const GuardedPair<Real>& pair) {
          share_gap(pair, regions,
                    [&radii](std::size_t i, Real own) { radii[i] = std::min(radii[i], own); });
        });
      });
  for (const Index k : pairs.active) {
    const auto i = at_index(k);
    Real least = regions.radii[0][i];
    for (std::size_t p = 1; p < parts; ++p) least = std::min(least, regions.radii[p][i]);
    regions.sizes[i].lanes[kRadiusLane] = least;
  }
  regions.dirty.clear();
}

template <class Real>
void admit_pairs(std::size_t first, const GuardedStep<Real>& step, Executor* executor,
                 GuardedPairs<Real>& pairs, Regions<Real>& regions) {
  assert(first <= pairs.all.size());
  const auto is_new = [&](std::size_t i) { return !pairs.is_active[i]; };
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    for (const Index k : pair.particle) {
      const auto i = at_index(k);
      if (!is_new(i)) continue;
      regions.anchor[i] = step.from[i];
      regions.sizes[i].lanes[kRadiusLane] = std::numeric_limits<Real>::infinity();
    }
  });
  for (std::size_t k = first; k < pairs.all.size(); ++k)
    regions.columns[pairs.all[k].kind].add(static_cast<Index>(k), 0, pairs.all[k].particle);
  for (PairColumns<Real>& columns : regions.columns) {
    separate_pairs(regions.anchor, regions.anchor, columns, executor);
    for (std::size_t k = 0; k < columns.size(); ++k)
      pairs[columns.a[k]].bound = columns.certified_gap(k, regions.anchor);
    columns.clear();
  }
  measure_lengths(step, regions);
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    share_gap(pair, regions, [&](std::size_t i, Real own) {
      if (is_new(i)) regions.sizes[i].lanes[kRadiusLane] = std::min(regions.radius(i), own);
    });
  });
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    const auto [one, other] =
        largest_on_sides(pair, [&](std::size_t i) { return regions.radius(i); });
    if (one + other + regions.smallest_gap <= pair.bound) return;
    regions.dirty.insert(regions.dirty.end(), pair.particle.begin(), pair.particle.end());
  });
}

template <class Real>
Real find_loose(const std::vector<Index>& active, const GuardedStep<Real>& step,
                Regions<Real>& regions) {
  Real least = std::numeric_limits<Real>::infinity();
  regions.loose.clear();
  ++regions.wave;
  for (const Index i : regions.dirty) regions.wave_of[at_index(i)] = regions.wave;
  for (const Index k : active) {
    const auto i = at_index(k);
    const Real radius = regions.radius(i);
    const Quad<Real> off = step.from[i] + step.displacement[i] - regions.anchor[i];
    const Real spare2 = radius * radius - dot(off, off);
    if (regions.wave_of[i] == regions.wave || !(spare2 >= 0)) regions.loose.push_back(k);
    least = radius > 0 ? std::min(least, spare2 / (2 * radius)) : Real(0);
  }
  regions.dirty.clear();
  return least;
}

template <class Real>
void measure(const Regions<Real>& regions, GuardedPair<Real>& pair) {
  pair.bound = separate_pair(pair.kind, points_of(pair, regions.anchor)).gap;
}

template <class Real>
void anchor_loose(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Regions<Real>& regions,
                  Executor* executor, GuardCounts& counts) {
  measure_lengths(step, regions);
  regions.in_wave = regions.loose;
  for (int wave = 0; !regions.in_wave.empty(); ++wave) {
    stop_point();
    if (wave == kMostWaves) {
      anchor_all(pairs, step, executor, regions);
      return;
    }
    anchor_wave(wave == 0, pairs, step, regions, executor, counts);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(anchor_anew, share_all_gaps, admit_pairs, find_loose, measure,
                           anchor_loose)

}  // namespace weft
