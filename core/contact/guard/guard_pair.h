#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/contact/feature_pair.h"
#include "core/math/quad.h"
#include "core/types.h"

// A pair of features that the guard watches.

namespace weft {

/// Two features of cloths that could meet before pairs are collected again.
template <class Real>
struct GuardedPair {
  PairKind kind = PairKind::vertex_triangle;
  bool open = false;  ///< not apart, or free to part (ClothTangles): nothing is promised about it
  bool gone = false;  ///< collected again since, as one of its particles left its path
  std::array<Index, 4> particle = {0, 0, 0, 0};
  Index a = 0, b = 0;        ///< particle and triangle, or two edges, the lower one first
  Real bound = 0;            ///< the features at their anchors are at least this far apart [m]
  std::uint64_t listed = 0;  ///< last listing that met it; see GuardedPairs
};

/// Names a pair.
template <class Real>
std::uint64_t key_of(const GuardedPair<Real>& pair) {
  return (static_cast<std::uint64_t>(pair.kind == PairKind::edge_edge) << 63) |
         (static_cast<std::uint64_t>(pair.a) << 31) | static_cast<std::uint64_t>(pair.b);
}

/// Positions of its particles [m].
/// @param x  of all particles [m]
template <class Real>
PairPoints<Real> points_of(const GuardedPair<Real>& pair, const QuadArray<Real>& x) {
  PairPoints<Real> points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = to_vector(x[at_index(pair.particle[k])]);
  return points;
}

/// One number for each side of a pair.
template <class Real>
struct BothSides {
  Real first = 0, second = 0;
};

/// The largest value(particle) on each side of a pair, and at least 0.
template <class Real>
[[gnu::always_inline]] inline BothSides<Real> largest_on_sides(const GuardedPair<Real>& pair,
                                                               auto&& value) {
  const auto of = [&](std::size_t k) { return value(at_index(pair.particle[k])); };
  const Real second = std::max({Real(0), of(2), of(3)}), first = std::max(Real(0), of(0)),
             either = of(1);
  if (pair.kind == PairKind::vertex_triangle) return {first, std::max(second, either)};
  return {std::max(first, either), second};
}

}  // namespace weft
