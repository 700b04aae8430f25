// Finds an origin from which places are seen without rounding.

#include "core/geometry/exact_origin.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/instantiate.h"

namespace weft {

template <class Real>
Vec3<Real> exact_origin(std::span<const Vec3<Real>> places) {
  assert(!places.empty());
  Vec3<Real> least = places[0], most = places[0], origin = Vec3<Real>::Zero();
  for (const Vec3<Real>& place : places) {
    least = least.cwiseMin(place);
    most = most.cwiseMax(place);
  }
  for (int k = 0; k < 3; ++k) {
    if (!(least[k] * most[k] > 0) || !std::isfinite(least[k] * most[k])) continue;
    const Real near = std::min(std::abs(least[k]), std::abs(most[k]));
    const Real far = std::max(std::abs(least[k]), std::abs(most[k]));
    const Real step = std::ldexp(Real(1), std::ilogb(far) - std::numeric_limits<Real>::digits + 1);
    const Real between = std::min(2 * near, (near + far) / 2);
    origin[k] = std::copysign(std::floor(between / step) * step, least[k]);
  }
  return origin;
}

WEFT_INSTANTIATE_FUNCTIONS(exact_origin)

}  // namespace weft
