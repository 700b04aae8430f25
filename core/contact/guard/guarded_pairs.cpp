// Lists pairs with their particles, and drops those of particles that get new paths.

#include "core/contact/guard/guarded_pairs.h"

#include <algorithm>
#include <utility>

#include "core/instantiate.h"

namespace weft {

template <class Real>
void drop_all_pairs(GuardedPairs<Real>& pairs) {
  pairs.open_keys.clear();
  if (pairs.open > 0) {
    for (const GuardedPair<Real>& pair : pairs.all) {
      if (pair.open && !pair.gone) pairs.open_keys.push_back(key_of(pair));
    }
    std::sort(pairs.open_keys.begin(), pairs.open_keys.end());
  }
  pairs.all.clear();
  pairs.open = 0;
}

template <class Real>
void list_all_pairs(std::size_t n, GuardedPairs<Real>& pairs) {
  std::vector<Index>&begin = pairs.begin, &end = pairs.end;
  begin.assign(n + 1, 0);
  for_pairs_from(pairs, 0, [&](const GuardedPair<Real>& pair) {
    for (const Index i : pair.particle) ++begin[at_index(i) + 1];
  });
  pairs.active.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (begin[i + 1] > 0) pairs.active.push_back(static_cast<Index>(i));
    begin[i + 1] += begin[i];
  }
  pairs.of.resize(at_index(begin[n]));
  for (std::size_t k = pairs.all.size(); k-- > 0;) {
    if (pairs.all[k].open) continue;
    // Filled from the back of each particle's list, whose begin then stands where it shall.
    for (const Index i : pairs.all[k].particle)
      pairs.of[at_index(--begin[at_index(i) + 1])] = static_cast<Index>(k);
  }
  end.resize(n);
  for (std::size_t i = 0; i < n; ++i) begin[i] = begin[i + 1];
  begin[n] = static_cast<Index>(pairs.of.size());
  for (std::size_t i = 0; i < n; ++i) {
    end[i] = begin[i + 1];
    pairs.is_active[i] = end[i] > begin[i] ? 1 : 0;
  }
  pairs.later.assign(n, kNone);
  pairs.links.clear();
  pairs.listed = pairs.all.size();
  pairs.most = 2 * pairs.all.size() + n;
}

template <class Real>
void list_pairs_from(std::size_t first, GuardedPairs<Real>& pairs) {
  assert(pairs.listed <= first && first <= pairs.all.size());
  pairs.links.resize(pairs.all.size() - pairs.listed);
  for_pairs_from(pairs, first, [&](GuardedPair<Real>& pair) {
    const Index number = pairs.number_of(pair);
    for (std::size_t m = 0; m < 4; ++m) {
      const auto i = at_index(pair.particle[m]);
      pairs.links[at_index(number) - pairs.listed][m] =
          std::exchange(pairs.later[i], 4 * number + static_cast<Index>(m));
      if (!std::exchange(pairs.is_active[i], 1)) pairs.active.push_back(pair.particle[m]);
    }
  });
}

template <class Real>
void drop_pairs_of(const std::vector<Index>& particles, const std::vector<char>& changed,
                   GuardedPairs<Real>& pairs) {
  assert(changed.size() == pairs.is_active.size());
  pairs.dropped_keys.clear();
  pairs.open_keys.clear();
  for (const Index k : particles) {
    const auto i = at_index(k);
    assert(changed[i] != 0);
    if (!pairs.is_active[i]) continue;
    for_pairs_of(pairs, i, [&](GuardedPair<Real>& pair) {
      pair.gone = true;
      pairs.dropped_keys.push_back(key_of(pair));
    });
    pairs.end[i] = pairs.begin[i];
    pairs.later[i] = kNone;
  }
  std::sort(pairs.dropped_keys.begin(), pairs.dropped_keys.end());
  if (pairs.open == 0) return;
  // Open pairs stand in no list.
  for (GuardedPair<Real>& pair : pairs.all) {
    if (!pair.open || pair.gone) continue;
    pair.gone = std::any_of(pair.particle.begin(), pair.particle.end(),
                            [&](Index i) { return changed[at_index(i)] != 0; });
    if (!pair.gone) continue;
    --pairs.open;
    pairs.open_keys.push_back(key_of(pair));
  }
  std::sort(pairs.open_keys.begin(), pairs.open_keys.end());
}

template <class Real>
void note_arrivals(std::size_t first, GuardedPairs<Real>& pairs) {
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    const bool known =
        std::binary_search(pairs.dropped_keys.begin(), pairs.dropped_keys.end(), key_of(pair));
    if (!known) pairs.arrived.push_back(pair);
  });
}

WEFT_INSTANTIATE_FUNCTIONS(drop_all_pairs, list_all_pairs, list_pairs_from, drop_pairs_of,
                           note_arrivals)

}  // namespace weft
