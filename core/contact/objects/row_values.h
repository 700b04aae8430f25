#pragma once

#include <cassert>
#include <cstddef>

#include "core/contact/objects/contact_row.h"
#include "core/types.h"

// Means over the particles of a row of contact, and changes shared among them.

namespace weft {

/// sum w values: a position or velocity of the row's point of the cloth. Most rows have one
/// particle, of weight 1.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> weighted(const ContactRow<Real>& row,
                                                  const Vec3Array<Real>& values) {
  const auto at = [&](std::size_t k) -> const Vec3<Real>& {
    return values[at_index(row.particle[k])];
  };
  assert(row.count >= 1 && row.count <= 3);
  if (row.count == 1) return at(0);
  const Vec3<Real> two = at(0) * row.weight[0] + at(1) * row.weight[1];
  return row.count == 2 ? two : (two + at(2) * row.weight[2]).eval();
}

/// Moves the row's point by `change`, shared by mass.
template <class Real>
void share_out(const ContactRow<Real>& row, const Vec3<Real>& change, Vec3Array<Real>& values) {
  for (std::size_t k = 0; k < row.count; ++k)
    values[at_index(row.particle[k])] += change * row.share[k];
}

}  // namespace weft
