#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/math/quad.h"

// Axis-aligned boxes in vector registers.

namespace weft {

/// Axis-aligned bounding box whose corners are processed as vectors [m]. Initially empty.
template <class Real>
struct QuadBox {
  static constexpr Real kFar = std::numeric_limits<Real>::infinity();
  Quad<Real> lower{{kFar, kFar, kFar, kFar}}, upper{{-kFar, -kFar, -kFar, -kFar}};

  void add(const Quad<Real>& p) {
    lower.lanes = p.lanes < lower.lanes ? p.lanes : lower.lanes;
    upper.lanes = p.lanes > upper.lanes ? p.lanes : upper.lanes;
  }
  void add(const QuadBox& box) {
    lower.lanes = box.lower.lanes < lower.lanes ? box.lower.lanes : lower.lanes;
    upper.lanes = box.upper.lanes > upper.lanes ? box.upper.lanes : upper.lanes;
  }
  /// The box with every side moved outwards by `margin` [m].
  QuadBox grown(Real margin) const {
    QuadBox box = *this;
    box.lower.lanes -= margin;
    box.upper.lanes += margin;
    return box;
  }
  bool overlaps(const QuadBox& o) const {
    const auto both = (lower.lanes <= o.upper.lanes) & (o.lower.lanes <= upper.lanes);
    const auto words = std::bit_cast<std::array<std::uint64_t, sizeof(both) / 8>>(both);
    std::uint64_t all = ~std::uint64_t{0};
    for (const std::uint64_t word : words) all &= word;
    return all == ~std::uint64_t{0};
  }
};

}  // namespace weft
