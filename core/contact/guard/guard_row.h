#pragma once

#include <array>
#include <cstdint>

#include "core/contact/feature_pair.h"
#include "core/math/quad.h"
#include "core/types.h"

// One row of the guard's velocity problem, and what is computed from it.

namespace weft {

/// A contact of two features of cloths, frozen for a few substeps: gap = n . sum w x.
template <class Real>
struct GuardRow {
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<Real, 4> weight = {0, 0, 0, 0};
  std::array<Real, 4> share = {0, 0, 0, 0};  ///< change of velocity by a unit impulse [1/kg]
  Quad<Real> normal;                         ///< from the second feature to the first
  Quad<Real> drag;                           ///< friction's impulse in a substep [N s]
  Quad<Real> slip;                           ///< displacement since it sticks [m]
  Quad<Real> apart;                          ///< sum w x when it was last aimed [m]
  // Blocks take over the rest four numbers at a time, in this order.
  Real inertia = 0;  ///< 1 / (sum of weight x share) [kg]
  Real radius = 0;   ///< that the gap shall keep [m]
  Real friction = 0;
  Real room = 0;          ///< of the gap above the radius, now [m]
  Real least_speed = 0;   ///< that the normal velocity must reach now [m/s]
  Real push = 0;          ///< impulse along the normal in a substep [N s]
  std::uint64_t key = 0;  ///< of the pair
};

/// Steps between two looks at the rows: which particles have moved, which rows are busy, and how
/// those that push lie. Between looks none changes but by its responses.
inline constexpr int kStepsBetweenLooks = 4;

/// sum w of what the particles of a row have.
template <class Real>
Quad<Real> weighted(const GuardRow<Real>& row, const QuadArray<Real>& values) {
  Quad<Real> sum = values[at_index(row.particle[0])] * row.weight[0];
  for (std::size_t k = 1; k < 4; ++k) sum += values[at_index(row.particle[k])] * row.weight[k];
  return sum;
}

/// Component of a vector tangential to the contact.
template <class Real>
Quad<Real> tangential(const GuardRow<Real>& row, const Quad<Real>& v) {
  return v - row.normal * dot(row.normal, v);
}

/// Kind of a pair by its key (see key_of in guarded_pairs.h).
inline PairKind kind_of_key(std::uint64_t key) {
  return (key >> 63) != 0 ? PairKind::edge_edge : PairKind::vertex_triangle;
}
template <class Real>
PairKind kind_of(const GuardRow<Real>& row) {
  return kind_of_key(row.key);
}

/// The triangle, if it is a pair of one and a particle.
template <class Real>
Index triangle_of(const GuardRow<Real>& row) {
  return static_cast<Index>(row.key & 0x7fffffff);
}

}  // namespace weft
