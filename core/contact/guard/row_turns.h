#pragma once

#include <cassert>
#include <vector>

#include "core/contact/feature_pair.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/row_making.h"
#include "core/math/quad.h"
#include "core/types.h"

// How a row lies between its features, and how it goes on from the one before.

namespace weft {

/// Sets the direction and weights of a row from the separation of its features.
/// @return whether any of its particles can move in it
template <class Real>
bool weigh(const std::vector<Real>& inverse_mass, const PairSeparation<Real>& s,
           GuardRow<Real>& row) {
  Real mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    row.weight[k] = s.weight[k];
    row.share[k] = s.weight[k] * inverse_mass[static_cast<std::size_t>(row.particle[k])];
    mobility += row.share[k] * row.weight[k];
  }
  assert(!(mobility < 0));
  row.inertia = mobility > 0 ? 1 / mobility : Real(0);
  row.normal = to_quad(s.normal);
  return mobility > 0;
}

/// Goes on with the impulses and the anchor of the row before, which are passed on once.
/// @param x  positions [m]
template <class Real>
void remember(const QuadArray<Real>& x, RowMaking<Real>& making, GuardRow<Real>& row);

}  // namespace weft
