#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "core/contact/guard/guard_pair.h"
#include "core/types.h"

// The pairs that the guard watches, and those of each particle.

namespace weft {

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
};

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

/// Calls visit(pair) for each pair from number `first` on that is neither open nor gone.
template <class Pairs, class Visit>
void for_pairs_from(Pairs& pairs, std::size_t first, Visit&& visit) {
  for (std::size_t k = first; k < pairs.all.size(); ++k) {
    auto& pair = pairs.all[k];
    if (!pair.open && !pair.gone) visit(pair);
  }
}

/// Drops all pairs, and notes the keys of those that were open.
template <class Real>
void drop_all_pairs(GuardedPairs<Real>& pairs);

/// Lists all pairs with their particles.
/// @param particles  number of all
template <class Real>
void list_all_pairs(std::size_t particles, GuardedPairs<Real>& pairs);

/// Lists pairs that came later with their particles.
/// @param first  number of the first of them
template <class Real>
void list_pairs_from(std::size_t first, GuardedPairs<Real>& pairs);

/// Drops the pairs of particles that get new paths, and notes their keys.
/// @param changed  of each particle one number, not 0 for those in the list
template <class Real>
void drop_pairs_of(const std::vector<Index>& particles, const std::vector<char>& changed,
                   GuardedPairs<Real>& pairs);

/// Notes as arrived those that were not there before the last drop: the rows of the others hold.
/// @param first  number of the first that was found since
template <class Real>
void note_arrivals(std::size_t first, GuardedPairs<Real>& pairs);

}  // namespace weft
