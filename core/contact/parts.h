#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/executor.h"

// Work of contact is done in parts that do not depend on each other, on whatever threads there
// are. The number of parts depends on the amount of work alone, and their results are merged in
// order: threads make no difference.

namespace weft {

/// Work is done in at most this many parts.
inline constexpr std::size_t kMostParts = 16;

/// How many parts work is done in, with at least `each` of `amount` in one.
inline std::size_t parts_of(std::size_t amount, std::size_t each) {
  assert(each > 0);
  return std::clamp<std::size_t>(amount / each, 1, kMostParts);
}

/// Calls work(part, first, last) for each of the parts that items are shared out to.
/// @param executor  does them on its threads; may be null
template <class Work>
void run_parts(Executor* executor, std::size_t amount, std::size_t parts, Work&& work) {
  assert(parts >= 1 && parts <= kMostParts);
  run_chunks(parts > 1 ? executor : nullptr, static_cast<int>(parts), [&](int chunk) {
    const auto part = static_cast<std::size_t>(chunk);
    work(part, amount * part / parts, amount * (part + 1) / parts);
  });
}

/// Calls work(first, last) for ranges of items, of at least `each`.
template <class Work>
void run_ranges(Executor* executor, std::size_t amount, std::size_t each, Work&& work) {
  run_parts(executor, amount, parts_of(amount, each),
            [&](std::size_t, std::size_t first, std::size_t last) { work(first, last); });
}

}  // namespace weft
