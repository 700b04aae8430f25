#pragma once

#include <cmath>
#include <cstdint>

#include "core/types.h"

namespace weft {

namespace gust_detail {

/// Three independent numbers in [-1, 1) for a lattice point (mixing after SplitMix64's finaliser).
template <class Real>
inline Vec3<Real> lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto bits = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull +
              static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full +
              static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ull;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
  bits ^= bits >> 31;
  const auto part = [&](int shift) {
    const auto low = static_cast<std::int32_t>((bits >> shift) & 0x1FFFFF);
    return static_cast<Real>(low - 0x100000) * Real(1.0 / 0x100000);
  };
  return Vec3<Real>(part(0), part(21), part(42));
}

/// Weight with zero slope and curvature at both ends, so that the field has continuous curvature.
template <class Real>
inline Real fade(Real t) {
  return t * t * t * (t * (t * Real(6) - Real(15)) + Real(10));
}

}  // namespace gust_detail

/// Smooth noise in space, each component within [-1, 1] and of mean 0, with features of size one.
/// The same point gives the same value on any machine.
/// @param p  position in units of the eddy size; every finite value is fine
template <class Real>
inline Vec3<Real> smooth_noise(const Vec3d& p) {
  using gust_detail::fade;
  using gust_detail::lattice_value;
  const double fx = std::floor(p[0]), fy = std::floor(p[1]), fz = std::floor(p[2]);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy),
             iz = static_cast<std::int64_t>(fz);
  const Real tx = fade(static_cast<Real>(p[0] - fx)), ty = fade(static_cast<Real>(p[1] - fy)),
             tz = fade(static_cast<Real>(p[2] - fz));
  Vec3<Real> layer[2];
  for (int k = 0; k < 2; ++k) {
    const Vec3<Real> a = lattice_value<Real>(ix, iy, iz + k),
                     b = lattice_value<Real>(ix + 1, iy, iz + k);
    const Vec3<Real> c = lattice_value<Real>(ix, iy + 1, iz + k),
                     d = lattice_value<Real>(ix + 1, iy + 1, iz + k);
    const Vec3<Real> low = a + (b - a) * tx, high = c + (d - c) * tx;
    layer[k] = low + (high - low) * ty;
  }
  return layer[0] + (layer[1] - layer[0]) * tz;
}

}  // namespace weft
