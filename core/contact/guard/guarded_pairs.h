#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "core/contact/feature_pair.h"
#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// The pairs that the guard watches, and those of each particle.

namespace weft {

/// Two features of cloths that could meet before pairs are collected again.
template <class Real>
struct GuardedPair {
  PairKind kind = PairKind::vertex_triangle;
  bool open = false;  ///< not apart, or free to part (ClothTangles): nothing is promised about it
  bool gone = false;  ///< collected again since, as one of its particles left its path
  std::array<Index, 4> particle = {0, 0, 0, 0};
  Index a = 0, b = 0;        ///< particle and triangle, or two edges, the lower one first
  Real bound = 0;            ///< the features at their anchors are at least this far apart [m]
  std::uint64_t listed = 0;  ///< last listing that met it; see GuardedPairs
};

/// Names a pair.
template <class Real>
std::uint64_t key_of(const GuardedPair<Real>& pair) {
  return (static_cast<std::uint64_t>(pair.kind == PairKind::edge_edge) << 63) |
         (static_cast<std::uint64_t>(pair.a) << 31) | static_cast<std::uint64_t>(pair.b);
}

/// Positions of its particles [m].
/// @param x  of all particles [m]
template <class Real>
PairPoints<Real> points_of(const GuardedPair<Real>& pair, const QuadArray<Real>& x) {
  PairPoints<Real> points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = to_vector(x[at_index(pair.particle[k])]);
  return points;
}

/// One number for each side of a pair.
template <class Real>
struct BothSides {
  Real first = 0, second = 0;
};

/// The largest value(particle) on each side of a pair, and at least 0.
template <class Real>
[[gnu::always_inline]] inline BothSides<Real> largest_on_sides(const GuardedPair<Real>& pair,
                                                               auto&& value) {
  const auto of = [&](std::size_t k) { return value(at_index(pair.particle[k])); };
  const Real second = std::max({Real(0), of(2), of(3)}), first = std::max(Real(0), of(0)),
             either = of(1);
  if (pair.kind == PairKind::vertex_triangle) return {first, std::max(second, either)};
  return {std::max(first, either), second};
}

/// Pairs since all were collected, in the order in which they were found.
template <class Real>
struct GuardedPairs {
  std::vector<GuardedPair<Real>> all;
  std::size_t open = 0;               ///< of them
  std::size_t most = 0;               ///< beyond this number, with those that are gone, all are
                                      ///< collected anew
  std::vector<Index> begin, end, of;  ///< of each particle its pairs, as a range of `of`
  std::vector<Index> later;           ///< of each particle its last one that came later, as `links`
  std::size_t listed = 0;             ///< how many did not: the others have links
  /// Of each that came later its particles' next ones: number x 4 + place, or kNone.
  std::vector<std::array<Index, 4>> links;
  std::vector<Index> active;                ///< particles in pairs
  std::vector<char> is_active;              ///< of each particle
  std::uint64_t listing = 0;                ///< number of the last pass that visits each pair once
  std::vector<std::uint64_t> dropped_keys;  ///< of those that went last, ascending
  std::vector<std::uint64_t> open_keys;     ///< of those that went last and were open, ascending
  std::vector<GuardedPair<Real>> arrived;   ///< came since rows were made
  /// Of each part of a listing, for each particle: how many pairs, then where its next one goes.
  std::vector<std::vector<Index>> places;

  const GuardedPair<Real>& operator[](Index number) const {
    assert(at_index(number) < all.size());
    return all[at_index(number)];
  }
  GuardedPair<Real>& operator[](Index number) {
    assert(at_index(number) < all.size());
    return all[at_index(number)];
  }
  Index number_of(const GuardedPair<Real>& pair) const {
    return static_cast<Index>(&pair - all.data());
  }

  /// Drops all pairs, and notes the keys of those that were open.
  void drop_all();
  /// Lists all pairs with their particles, in their order.
  /// @param particles  number of all
  /// @param executor   may be null
  void list_all(std::size_t particles, Executor* executor);
  /// Lists pairs that came later with their particles.
  /// @param first  number of the first of them
  void list_from(std::size_t first);
  /// Drops the pairs of particles that get new paths, and notes their keys.
  /// @param changed  of each particle one number, not 0 for those in the list
  void drop_of(const std::vector<Index>& particles, const std::vector<char>& changed);
  /// Notes as arrived those that were not there before the last drop: the rows of the others hold.
  /// @param first  number of the first that was found since
  void note_arrivals(std::size_t first);
};

/// Into how many parts passes over all pairs are divided that keep a number for each particle.
inline std::size_t parts_of_pairs(std::size_t pairs) {
  return std::min(kMostPairParts, parts_of(pairs, kListedAtLeast));
}

/// Pairs of a particle that are fetched ahead of the one that is visited: they lie anywhere in
/// memory.
inline constexpr std::size_t kPairsAhead = 8;

/// Calls visit(pair) for each pair of a particle that is not gone or open.
/// @param pairs  GuardedPairs, const or not
template <class Pairs, class Visit>
void for_pairs_of(Pairs& pairs, std::size_t particle, Visit&& visit) {
  assert(particle < pairs.end.size() && particle < pairs.later.size());
  const auto end = at_index(pairs.end[particle]);
  for (auto k = at_index(pairs.begin[particle]); k < end; ++k) {
    if (k + kPairsAhead < end) __builtin_prefetch(&pairs.all[at_index(pairs.of[k + kPairsAhead])]);
    auto& pair = pairs.all[at_index(pairs.of[k])];
    if (!pair.gone) visit(pair);
  }
  for (Index link = pairs.later[particle]; link != kNone;) {
    auto& pair = pairs.all[at_index(link / 4)];
    link = pairs.links[at_index(link / 4) - pairs.listed][at_index(link % 4)];
    if (!pair.gone) visit(pair);
  }
}

/// Calls visit(pair) for each pair from number `first` to `last`, exclusive, that is neither open
/// nor gone.
template <class Pairs, class Visit>
void for_pairs_between(Pairs& pairs, std::size_t first, std::size_t last, Visit&& visit) {
  assert(last <= pairs.all.size());
  for (std::size_t k = first; k < last; ++k) {
    auto& pair = pairs.all[k];
    if (!pair.open && !pair.gone) visit(pair);
  }
}

/// The same from number `first` on.
template <class Pairs, class Visit>
void for_pairs_from(Pairs& pairs, std::size_t first, Visit&& visit) {
  for_pairs_between(pairs, first, pairs.all.size(), visit);
}

/// Forgets all pairs; keeps the memory.
template <class Real>
void forget_pairs(GuardedPairs<Real>& pairs);

extern template struct GuardedPairs<float>;
extern template struct GuardedPairs<double>;

}  // namespace weft
