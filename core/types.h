#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

// Scalars, vectors and index types shared by the whole physics.
//
// Units are SI everywhere: metres, kilograms, seconds, newtons, radians. The y axis points up.
// `Real` is float in use and double in tests and references.

namespace weft {

template <class Real>
using Vec3 = Eigen::Matrix<Real, 3, 1>;

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

/// Index of a particle, edge, triangle or hinge. Signed, so that -1 can mean "none".
using Index = std::int32_t;
inline constexpr Index kNone = -1;

/// An index as standard containers take it.
constexpr std::size_t at_index(Index i) {
  assert(i >= 0);
  return static_cast<std::size_t>(i);
}

/// Corner particles of a triangle, counter-clockwise seen from the side its normal points to.
using Triangle = std::array<Index, 3>;

/// End particles of an edge, smaller index first.
using Edge = std::array<Index, 2>;

/// Vectors without Eigen's alignment requirement, safe in std::vector.
template <class Real>
using Vec3Array = std::vector<Vec3<Real>>;

}  // namespace weft
