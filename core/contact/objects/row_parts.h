#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/parts.h"
#include "core/executor.h"

// Rows are made in parts, and joined in the order in which one part alone makes them.

namespace weft {

/// Appends the rows of a part.
template <class Real>
void append_part(const RowList<Real>& part, RowList<Real>& rows) {
  assert(part.exits.empty() && "whoever leaves an object is not made in parts");
  const std::size_t first = rows.all.size();
  rows.all.insert(rows.all.end(), part.all.begin(), part.all.end());
  for (MovingRow<Real> moving : part.moving) {
    rows.all[first + moving.row].mover = static_cast<Index>(rows.moving.size());
    moving.row += first;
    rows.moving.push_back(moving);
  }
}

/// Makes the rows of `amount` features by make(first, last, part, rows), which appends to `rows`
/// and counts the closest points that it computes in part.tests. A cloth that leaves an object in
/// which it started does so in a direction that is chosen once, and what follows depends on it: it
/// is made in one part, again if that shows only then.
/// @param executor  makes many on its threads; may be null
/// @return closest points computed
template <class Real, class Make>
std::uint64_t make_in_parts(Executor* executor, std::size_t amount, RowScratch<Real>& scratch,
                            RowList<Real>& rows, Make&& make) {
  const bool alone = !executor || !rows.exits.empty();
  std::size_t count = alone ? 1 : parts_of(amount, kMadeAtLeast);
  const auto make_part = [&](std::size_t number, std::size_t first, std::size_t last) {
    ObjectRowPart<Real>& part = scratch.parts[number];
    part.rows.all.clear();
    part.rows.moving.clear();
    part.rows.exits.clear();
    part.tests = 0;
    make(first, last, part, count > 1 ? part.rows : rows);
  };
  run_parts(executor, amount, count, make_part);
  const auto begin = scratch.parts.begin();
  const auto leaves = [](const ObjectRowPart<Real>& part) { return !part.rows.exits.empty(); };
  if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count), leaves)) {
    count = 1;
    run_parts(executor, amount, count, make_part);
  }
  std::uint64_t tests = 0;
  for (std::size_t n = 0; n < count; ++n) {
    tests += scratch.parts[n].tests;
    if (count > 1) append_part(scratch.parts[n].rows, rows);
  }
  return tests;
}

}  // namespace weft
