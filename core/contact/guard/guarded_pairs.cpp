// Lists pairs with their particles, and drops those of particles that get new paths.

#include "core/contact/guard/guarded_pairs.h"

#include <algorithm>
#include <utility>

#include "core/instantiate.h"

namespace weft {

template <class Real>
void GuardedPairs<Real>::drop_all() {
  open_keys.clear();
  if (open > 0) {
    for (const GuardedPair<Real>& pair : all) {
      if (pair.open && !pair.gone) open_keys.push_back(key_of(pair));
    }
    std::sort(open_keys.begin(), open_keys.end());
  }
  all.clear();
  open = 0;
}

/// Each part counts its pairs of each particle; so the parts know where to put them.
template <class Real>
void GuardedPairs<Real>::list_all(std::size_t n, Executor* executor) {
  const std::size_t parts = parts_of_pairs(all.size());
  places.resize(std::max(places.size(), parts));
  const auto visit = [&](std::size_t first, std::size_t last, auto&& note) {
    for_pairs_between(*this, first, last, [&](const GuardedPair<Real>& pair) {
      for (const Index i : pair.particle) note(at_index(i), number_of(pair));
    });
  };
  run_parts(executor, all.size(), parts, [&](std::size_t p, std::size_t first, std::size_t last) {
    places[p].assign(n, 0);
    visit(first, last, [&count = places[p]](std::size_t i, Index) { ++count[i]; });
  });
  begin.resize(n + 1);
  end.resize(n);
  active.clear();
  Index total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    begin[i] = total;
    for (std::size_t p = 0; p < parts; ++p) total += std::exchange(places[p][i], total);
    end[i] = total;
    is_active[i] = total > begin[i] ? 1 : 0;
    if (is_active[i]) active.push_back(static_cast<Index>(i));
  }
  begin[n] = total;
  of.resize(at_index(total));
  run_parts(executor, all.size(), parts, [&](std::size_t p, std::size_t first, std::size_t last) {
    visit(first, last,
          [&, &next = places[p]](std::size_t i, Index k) { of[at_index(next[i]++)] = k; });
  });
  later.assign(n, kNone);
  links.clear();
  listed = all.size();
  most = 2 * all.size() + n;
}

template <class Real>
void GuardedPairs<Real>::list_from(std::size_t first) {
  assert(listed <= first && first <= all.size());
  links.resize(all.size() - listed);
  for_pairs_from(*this, first, [&](GuardedPair<Real>& pair) {
    const Index number = number_of(pair);
    for (std::size_t m = 0; m < 4; ++m) {
      const auto i = at_index(pair.particle[m]);
      links[at_index(number) - listed][m] =
          std::exchange(later[i], 4 * number + static_cast<Index>(m));
      if (!std::exchange(is_active[i], 1)) active.push_back(pair.particle[m]);
    }
  });
}

template <class Real>
void GuardedPairs<Real>::drop_of(const std::vector<Index>& particles,
                                 const std::vector<char>& changed) {
  assert(changed.size() == is_active.size());
  dropped_keys.clear();
  open_keys.clear();
  for (const Index k : particles) {
    const auto i = at_index(k);
    assert(changed[i] != 0);
    if (!is_active[i]) continue;
    for_pairs_of(*this, i, [&](GuardedPair<Real>& pair) {
      pair.gone = true;
      dropped_keys.push_back(key_of(pair));
    });
    end[i] = begin[i];
    later[i] = kNone;
  }
  std::sort(dropped_keys.begin(), dropped_keys.end());
  if (open == 0) return;
  // Open pairs stand in no list.
  for (GuardedPair<Real>& pair : all) {
    if (!pair.open || pair.gone) continue;
    pair.gone = std::any_of(pair.particle.begin(), pair.particle.end(),
                            [&](Index i) { return changed[at_index(i)] != 0; });
    if (!pair.gone) continue;
    --open;
    open_keys.push_back(key_of(pair));
  }
  std::sort(open_keys.begin(), open_keys.end());
}

template <class Real>
void GuardedPairs<Real>::note_arrivals(std::size_t first) {
  for_pairs_from(*this, first, [&](const GuardedPair<Real>& pair) {
    const bool known = std::binary_search(dropped_keys.begin(), dropped_keys.end(), key_of(pair));
    if (!known) arrived.push_back(pair);
  });
}

template <class Real>
void forget_pairs(GuardedPairs<Real>& pairs) {
  for (std::vector<GuardedPair<Real>>* list : {&pairs.all, &pairs.arrived}) list->clear();
  pairs.active.clear();
  pairs.open_keys.clear();
  pairs.open = 0;
}

WEFT_INSTANTIATE_FUNCTIONS(forget_pairs)
template struct GuardedPairs<float>;
template struct GuardedPairs<double>;

}  // namespace weft
