#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/types.h"

// Noise for gusts of wind.

namespace weft {

namespace gust_detail {

/// Three independent numbers in [-1, 1) for a lattice point (mixed like SplitMix64's finaliser).
template <class Real>
inline Vec3<Real> lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto bits = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull +
              static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full +
              static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ull;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
  bits ^= bits >> 31;
  const auto number = [&](int shift) {
    const auto low = static_cast<std::int32_t>((bits >> shift) & 0x1FFFFF);
    return static_cast<Real>(low - 0x100000) * Real(1.0 / 0x100000);
  };
  return Vec3<Real>(number(0), number(21), number(42));
}

/// Blending weight with zero slope and curvature at both ends, so that the field's curvature is
/// continuous.
template <class Real>
inline Real fade(Real t) {
  return t * t * t * (t * (t * Real(6) - Real(15)) + Real(10));
}

}  // namespace gust_detail

/// Smooth spatial noise, each component within [-1, 1] with mean 0 and features of size one. The
/// same point gives the same value on every machine. The corners of the last cell are cached,
/// because neighbouring particles mostly need the same ones.
template <class Real>
class SmoothNoise {
 public:
  SmoothNoise() { enter({0, 0, 0}); }

  /// @param p  position in units of the eddy size; any finite value
  Vec3<Real> at(const Vec3d& p) {
    using gust_detail::fade;
    const std::array<double, 3> low = {std::floor(p[0]), std::floor(p[1]), std::floor(p[2])};
    if (low != low_) enter(low);
    const Real tx = fade(static_cast<Real>(p[0] - low[0])),
               ty = fade(static_cast<Real>(p[1] - low[1])),
               tz = fade(static_cast<Real>(p[2] - low[2]));
    std::array<Vec3<Real>, 2> layer;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& [a, b, c, d] = corners_[k];
      const Vec3<Real> below = a + (b - a) * tx, above = c + (d - c) * tx;
      layer[k] = below + (above - below) * ty;
    }
    return layer[0] + (layer[1] - layer[0]) * tz;
  }

 private:
  void enter(const std::array<double, 3>& low) {
    using gust_detail::lattice_value;
    const auto x = static_cast<std::int64_t>(low[0]), y = static_cast<std::int64_t>(low[1]),
               z = static_cast<std::int64_t>(low[2]);
    for (std::int64_t k = 0; k < 2; ++k) {
      corners_[static_cast<std::size_t>(k)] = {
          lattice_value<Real>(x, y, z + k), lattice_value<Real>(x + 1, y, z + k),
          lattice_value<Real>(x, y + 1, z + k), lattice_value<Real>(x + 1, y + 1, z + k)};
    }
    low_ = low;
  }

  std::array<double, 3> low_ = {};
  std::array<std::array<Vec3<Real>, 4>, 2> corners_;  ///< by z; x fastest, then y
};

}  // namespace weft
