#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/guard/guard_pair.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/pair_separation.h"
#include "core/contact/guard/patch_boxes.h"
#include "core/executor.h"
#include "core/types.h"

// The work of ClothGuard is done in parts that know nothing of each other, on whatever threads
// there are. How many parts depends on the amount of work alone, and what they find is put together
// in their order: threads make no difference.

namespace weft {

/// Work is done in at most so many parts.
inline constexpr std::size_t kMostParts = 16;

/// How many parts work is done in, with at least `each` of `amount` in one.
inline std::size_t parts_of(std::size_t amount, std::size_t each) {
  return std::clamp<std::size_t>(amount / each, 1, kMostParts);
}

/// Calls work(part, first, last) for each of the parts that items are shared out to.
/// @param executor  does them on its threads; may be null
template <class Work>
void run_parts(Executor* executor, std::size_t amount, std::size_t parts, Work&& work) {
  run_chunks(parts > 1 ? executor : nullptr, static_cast<int>(parts), [&](int chunk) {
    const auto part = static_cast<std::size_t>(chunk);
    work(part, amount * part / parts, amount * (part + 1) / parts);
  });
}

/// What a part of the search for pairs needs for itself, and what it found.
template <class Real>
struct PairSearch {
  ColumnsByKind<Real> columns;  ///< of each kind, to be looked at together
  PatchOverlaps overlaps;       ///< of the patches that are being tested
  std::vector<GuardedPair<Real>> found;
  std::uint64_t tests = 0;
};

/// A pair of a particle that is being anchored.
template <class Real>
struct AnchorClaim {
  Index pair = 0, particle = 0;
  Real own = 0, other = 0;  ///< rooms of those who keep their anchors, on its side and across [m]
  bool on_first = false;    ///< the particle is on the first side
  bool ample = false;       ///< the bound is far more than anybody needs
};

/// Some of the particles that are anchored together.
template <class Real>
struct AnchorPart {
  ColumnsByKind<Real> columns;            ///< of pairs whose bounds are to be measured
  std::vector<AnchorClaim<Real>> claims;  ///< of its particles, in their order
  std::vector<Index> next;                ///< who is to be anchored besides
};

/// Some of the pairs that may have rows, and the rows of each kind.
template <class Real>
struct RowPart {
  ColumnsByKind<Real> columns;
  std::array<std::vector<GuardRow<Real>>, 2> rows;
};

/// Some of the rows that turn with their features.
template <class Real>
struct TurnPart {
  ColumnsByKind<Real> columns;
  std::vector<Index> passed;  ///< particles over the border of the triangle that carries them
};

}  // namespace weft
