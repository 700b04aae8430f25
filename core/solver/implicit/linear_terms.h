#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cloth/cloth_model.h"
#include "core/forces/spring.h"
#include "core/types.h"

// Forces and derivatives of single springs.

namespace weft {

/// Symmetric 3 x 3 matrix as xx xy xz yy yz zz.
template <class Real>
using SymmetricBlock = std::array<Real, 6>;

/// a I + b u u^T
template <class Real>
SymmetricBlock<Real> along_and_across(Real a, Real b, const Vec3<Real>& u) {
  const Vec3<Real> s = u * b;
  return {a + s[0] * u[0], s[0] * u[1], s[0] * u[2], a + s[1] * u[1], s[1] * u[2], a + s[2] * u[2]};
}

template <class Real>
Vec3<Real> times(const SymmetricBlock<Real>& a, const Vec3<Real>& u) {
  return {a[0] * u[0] + a[1] * u[1] + a[2] * u[2], a[1] * u[0] + a[3] * u[1] + a[4] * u[2],
          a[2] * u[0] + a[4] * u[1] + a[5] * u[2]};
}

/// Force of a spring on its first end, and its derivative by the relative displacement of the ends,
/// without the indefinite part: alpha I + (k + c rate - alpha) u u^T with alpha = k max(0, 1 -
/// L/l). It is exact in tension, except for the rotation of the dashpot's force; in compression the
/// direction of the force is treated as constant.
/// @param rate  derivative of velocities by positions [1/s]
template <class Real>
struct SpringTerm {
  Vec3<Real> force;
  SymmetricBlock<Real> block;

  SpringTerm(const Spring<Real>& s, const Vec3<Real>& d, const Vec3<Real>& dv, Real rate) {
    const Real l2 = d.squaredNorm() + Real(kSmallestSquaredLength);
    const Real inverse = 1 / std::sqrt(l2);
    const Real elastic = s.stiffness * (Real(1) - s.rest_length * inverse);
    force = d * (elastic + s.damping * (d.dot(dv) / l2));
    const Real across = std::max(Real(0), elastic);
    block = along_and_across<Real>(across, s.stiffness + s.damping * rate - across, d * inverse);
  }
};

}  // namespace weft
