// Anchors particles in waves, and shares the gaps of their pairs.

#include "core/contact/guard/regions.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>

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

/// Bounds the regions of a pair's particles by their side's share of its gap.
/// @param takes  whether particle i takes part
template <class Real, class Takes>
void share_gap(const GuardedPair<Real>& pair, const GuardedStep<Real>& step, Regions<Real>& regions,
               Takes&& takes) {
  const Real gap = std::max(Real(0), pair.bound - regions.smallest_gap);
  const auto [first, second] =
      largest_on_sides(pair, [&](std::size_t i) { return step.length[i]; });
  const Real share = share_of(first, second);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    if (!takes(i)) continue;
    const Real own = gap * (k < first_side(pair.kind) ? share : 1 - share);
    regions.radius[i] = std::min(regions.radius[i], own);
  }
}

/// Lists the pairs of a particle with the radii that others have in them. Pairs whose bound may be
/// too small for a particle that is being anchored are listed for measuring. Of a pair's particles
/// in the wave, only the first asks for the measurement.
template <class Real>
void list_claims(Index particle, const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 const Regions<Real>& regions, AnchorPart<Real>& part) {
  const auto ahead_of = [&](Real length) {
    return length * Real(2 * kStepsOfRoom) + regions.smallest_gap;
  };
  const Real ahead = ahead_of(step.length[at_index(particle)]);
  for_pairs_of(pairs, at_index(particle), [&](const GuardedPair<Real>& pair) {
    // Those that are being anchored have none yet.
    const auto [first, second] =
        largest_on_sides(pair, [&](std::size_t i) { return regions.radius[i]; });
    const auto [first_length, second_length] =
        largest_on_sides(pair, [&](std::size_t i) { return step.length[i]; });
    const std::array<Index, 4>& p = pair.particle;
    const bool on_first =
        particle == p[0] || (pair.kind == PairKind::edge_edge && particle == p[1]);
    const Real most = std::max(first, second), other = on_first ? second : first;
    AnchorClaim<Real>& claim = part.claims.emplace_back();
    claim.pair = pairs.number_of(pair);
    claim.ample = pair.bound > most + other + ahead;
    claim.own = on_first ? first : second;
    claim.other = other;
    claim.own_length = on_first ? first_length : second_length;
    claim.other_length = on_first ? second_length : first_length;
    Real ahead_on[2] = {-1, -1};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto j = at_index(p[k]);
      if (regions.wave_of[j] != regions.wave) continue;
      if (ahead_on[0] < 0 && ahead_on[1] < 0 && p[k] != particle) return;
      Real& side = ahead_on[k < first_side(pair.kind) ? 0 : 1];
      side = std::max(side, ahead_of(step.length[j]));
    }
    const bool enough = (ahead_on[0] < 0 || pair.bound > most + second + ahead_on[0]) &&
                        (ahead_on[1] < 0 || pair.bound > most + first + ahead_on[1]);
    if (!enough) part.columns[pair.kind].add(claim.pair, 0, p);
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
                  const GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                  const Regions<Real>& regions, std::vector<Index>& next) {
  Real radius = std::numeric_limits<Real>::infinity();
  const Real length = step.length[at_index(particle)];
  for (const AnchorClaim<Real>& claim : claims) {
    const GuardedPair<Real>& pair = pairs[claim.pair];
    const Real gap = std::max(Real(0), pair.bound - regions.smallest_gap);
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
    for (const Index j : pair.particle) {
      if (regions.wave_of[at_index(j)] != regions.wave &&
          (regions.radius[at_index(j)] > 0 || greedy))
        next.push_back(j);
    }
    next.push_back(particle);
  }
  return radius;
}

/// Moves the anchors of a wave's particles to where these are.
template <class Real>
void move_anchors(GuardedPairs<Real>& pairs, const GuardedStep<Real>& step, Regions<Real>& regions,
                  GuardCounts& counts) {
  for (const Index k : regions.in_wave) {
    const auto i = at_index(k);
    regions.wave_of[i] = regions.wave;
    regions.radius[i] = 0;
    if (regions.anchored_at[i] == step.number) continue;
    regions.anchored_at[i] = step.number;
    regions.anchored.push_back(k);
    ++counts.anchored;
    // The bound of a gap falls by no more than the displacement of an anchor.
    const Real moved = length(step.from[i] - regions.anchor[i]);
    regions.anchor[i] = step.from[i];
    if (moved == 0) continue;
    for_pairs_of(pairs, i, [&](GuardedPair<Real>& pair) { pair.bound -= moved; });
  }
}

/// Anchors the particles of a wave, and puts those of the next one in their place.
/// @param first  it is the first wave
template <class Real>
void anchor_wave(bool first, GuardedPairs<Real>& pairs, const GuardedStep<Real>& step,
                 Regions<Real>& regions, Executor* executor, GuardCounts& counts) {
  move_anchors(pairs, step, regions, counts);
  std::vector<Index>& in_wave = regions.in_wave;
  const std::size_t count = in_wave.size(), parts = parts_of(count, kAnchoredAtLeast);
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    AnchorPart<Real>& part = regions.parts[n];
    part.claims.clear();
    part.ends.clear();
    for (std::size_t k = from; k < to; ++k) list_claims(in_wave[k], pairs, step, regions, part);
    measure_claimed(regions.anchor, part);
  });
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t, std::size_t) {
    for (PairColumns<Real>& columns : regions.parts[n].columns) {
      for (std::size_t k = 0; k < columns.size(); ++k) pairs[columns.a[k]].bound = columns.gap[k];
      columns.clear();
    }
  });
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    AnchorPart<Real>& part = regions.parts[n];
    const std::span<const AnchorClaim<Real>> claims = part.claims;
    for (std::size_t k = from, begin = 0; k < to; ++k) {
      const std::size_t end = part.ends[k - from];
      regions.radius[at_index(in_wave[k])] = share_claims<Real>(
          in_wave[k], claims.subspan(begin, end - begin), first, pairs, step, regions, part.next);
      begin = end;
    }
  });
  in_wave.clear();
  for (std::size_t n = 0; n < parts; ++n) {
    std::vector<Index>& next = regions.parts[n].next;
    in_wave.insert(in_wave.end(), next.begin(), next.end());
    next.clear();
  }
  std::sort(in_wave.begin(), in_wave.end());
  in_wave.erase(std::unique(in_wave.begin(), in_wave.end()), in_wave.end());
}

/// Anchors and measures everything.
template <class Real>
void anchor_all(GuardedPairs<Real>& pairs, GuardedStep<Real>& step, Regions<Real>& regions) {
  ++regions.wave;
  for (const Index k : pairs.active) {
    const auto i = at_index(k);
    if (regions.anchored_at[i] != step.number) regions.anchored.push_back(k);
    regions.anchored_at[i] = step.number;
    regions.anchor[i] = step.from[i];
  }
  for_pairs_from(pairs, 0, [&](GuardedPair<Real>& pair) { measure(regions, pair); });
  share_all_gaps(pairs, step, regions);
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

template <class Real>
void share_all_gaps(const GuardedPairs<Real>& pairs, GuardedStep<Real>& step,
                    Regions<Real>& regions) {
  step.measure_lengths();
  for (const Index k : pairs.active)
    regions.radius[at_index(k)] = std::numeric_limits<Real>::infinity();
  for_pairs_from(pairs, 0, [&](const GuardedPair<Real>& pair) {
    share_gap(pair, step, regions, [](std::size_t) { return true; });
  });
  regions.dirty.clear();
}

template <class Real>
void admit_pairs(std::size_t first, GuardedStep<Real>& step, Executor* executor,
                 GuardedPairs<Real>& pairs, Regions<Real>& regions) {
  assert(first <= pairs.all.size());
  const auto is_new = [&](std::size_t i) { return !pairs.is_active[i]; };
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    for (const Index k : pair.particle) {
      const auto i = at_index(k);
      if (!is_new(i)) continue;
      regions.anchor[i] = step.from[i];
      regions.radius[i] = std::numeric_limits<Real>::infinity();
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
  step.measure_lengths();
  for_pairs_from(pairs, first,
                 [&](const GuardedPair<Real>& pair) { share_gap(pair, step, regions, is_new); });
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    const auto [one, other] =
        largest_on_sides(pair, [&](std::size_t i) { return regions.radius[i]; });
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
    const Real radius = regions.radius[i];
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
void anchor_loose(GuardedPairs<Real>& pairs, GuardedStep<Real>& step, Regions<Real>& regions,
                  Executor* executor, GuardCounts& counts) {
  step.measure_lengths();
  regions.in_wave = regions.loose;
  for (int wave = 0; !regions.in_wave.empty(); ++wave) {
    stop_point();
    if (wave == kMostWaves) {
      anchor_all(pairs, step, regions);
      return;
    }
    ++regions.wave;
    anchor_wave(wave == 0, pairs, step, regions, executor, counts);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(anchor_anew, share_all_gaps, admit_pairs, find_loose, measure,
                           anchor_loose)

}  // namespace weft
