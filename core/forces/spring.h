#pragma once

#include <cmath>

#include "core/cloth/cloth_model.h"
#include "core/forces/constants.h"
#include "core/types.h"

// Force of a spring.

namespace weft {

/// Force on end i of a spring from x_i to x_j (the opposite force acts on j) [N]: k d (1 - L/l) + c
/// (d . dv) d / l^2, with d = x_j - x_i and l = |d|.
template <class Real>
inline Vec3<Real> spring_force(const Spring<Real>& s, const Vec3<Real>& d, const Vec3<Real>& dv) {
  const Real l2 = d.squaredNorm() + Real(kSmallestSquaredLength);
  const Real elastic = s.stiffness * (Real(1) - s.rest_length / std::sqrt(l2));
  const Real damping = s.damping * (d.dot(dv) / l2);
  return d * (elastic + damping);
}

}  // namespace weft
