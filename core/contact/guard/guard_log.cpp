// Adds up what pairs of features push in a tick.

#include "core/contact/guard/guard_log.h"

#include <utility>

#include "core/instantiate.h"

namespace weft {
namespace {

/// Number of a pair in the log, or kNone.
Index find(const GuardLog& log, std::uint64_t key, Index first) {
  if (at_index(first) >= log.first.size()) return kNone;
  Index at = log.first[at_index(first)];
  while (at != kNone && log.pairs[at_index(at)].key != key) at = log.pairs[at_index(at)].next;
  return at;
}

/// A pair with its geometry of now, new or old.
/// @param from  a row, or a stopped pair
LoggedPair& pair_of(const auto& from, const Vec3d& normal, GuardLog& log) {
  const Index first = from.particle[0];
  const auto update = [&](LoggedPair& pair) -> LoggedPair& {
    for (std::size_t k = 0; k < 4; ++k) pair.weight[k] = static_cast<double>(from.weight[k]);
    pair.normal = normal;
    return pair;
  };
  if (const Index at = find(log, from.key, first); at != kNone)
    return update(log.pairs[at_index(at)]);
  if (at_index(first) >= log.first.size()) log.first.resize(at_index(first) + 1, kNone);
  LoggedPair& pair = log.pairs.emplace_back();
  pair.key = from.key;
  pair.particle = from.particle;
  pair.next = std::exchange(log.first[at_index(first)], static_cast<Index>(log.pairs.size()) - 1);
  return update(pair);
}

}  // namespace

void clear_log(GuardLog& log) {
  for (const LoggedPair& pair : log.pairs) log.first[at_index(pair.particle[0])] = kNone;
  log.pairs.clear();
  log.begun = false;
}

template <class Real>
void log_impulse(const GuardRow<Real>& row, const Vec3d& impulse, GuardLog& log) {
  pair_of(row, to_vector(row.normal).template cast<double>(), log).impulse += impulse;
}

template <class Real>
void log_meetings(const std::vector<StoppedPair<Real>>& pairs, GuardLog& log) {
  for (const StoppedPair<Real>& pair : pairs) {
    const Vec3d normal = pair.normal.template cast<double>();
    if (pair.pushed > 0)
      pair_of(pair, normal, log).impulse += normal * static_cast<double>(pair.pushed);
  }
}

bool is_logged(const GuardLog& log, std::uint64_t key, Index first) {
  return find(log, key, first) != kNone;
}

WEFT_INSTANTIATE_FUNCTIONS(log_impulse, log_meetings)

}  // namespace weft
