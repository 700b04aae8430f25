#pragma once

#include <array>
#include <cmath>

#include "core/cloth/membrane_gradient.h"
#include "core/cloth/membrane_triangle.h"
#include "core/forces/constants.h"
#include "core/types.h"

// Strain, force and energy of a membrane triangle.
//
// The strains are those of Baraff and Witkin 1998, "Large steps in cloth simulation", with the
// fabric's tensor in place of their penalties: linear in the length of a thread, as yarns and
// tensile tests are, and for small strains those of linear elasticity.

namespace weft {

/// Derivatives of the position in the fabric's axes, and the strains from them.
template <class Real>
struct MembraneStrain {
  Vec3<Real> w_u, w_v;           ///< 1 long at rest
  Real per_u = 0, per_v = 0;     ///< 1 / |w_u|, 1 / |w_v|
  Real u = 0, v = 0, shear = 0;  ///< |w_u| - 1, |w_v| - 1, w_u . w_v
};

template <class Real>
MembraneStrain<Real> membrane_strain(const MembraneTriangle<Real>& t, const Vec3<Real>& d1,
                                     const Vec3<Real>& d2) {
  MembraneStrain<Real> e;
  e.w_u = gradient_u(t, d1, d2);
  e.w_v = gradient_v(t, d1, d2);
  const Real u2 = e.w_u.squaredNorm() + Real(kSmallestSquaredStretch),
             v2 = e.w_v.squaredNorm() + Real(kSmallestSquaredStretch);
  e.per_u = 1 / std::sqrt(u2);
  e.per_v = 1 / std::sqrt(v2);
  e.u = u2 * e.per_u - 1;
  e.v = v2 * e.per_v - 1;
  e.shear = e.w_u.dot(e.w_v);
  return e;
}

/// Elastic energy [J].
template <class Real>
double membrane_energy(const MembraneTensor<Real>& c, const MembraneTriangle<Real>& t,
                       const MembraneStrain<Real>& e) {
  const auto u = static_cast<double>(e.u), v = static_cast<double>(e.v),
             shear = static_cast<double>(e.shear);
  return static_cast<double>(t.area) *
         (0.5 * static_cast<double>(c.warp) * u * u + 0.5 * static_cast<double>(c.weft) * v * v +
          static_cast<double>(c.coupling) * u * v +
          0.5 * static_cast<double>(c.shear) * shear * shear);
}

/// Forces on threads of unit width, times the triangle's area: the derivatives of the energy by w_u
/// and w_v, and the dashpot's share [N m].
template <class Real>
struct MembraneStress {
  Real u = 0, v = 0, shear = 0;  ///< of the strains
  Vec3<Real> along_u, along_v;   ///< of w_u and w_v
};

/// @param rate_u,rate_v  rates of w_u and w_v [1/s]
template <class Real>
MembraneStress<Real> membrane_stress(const MembraneTensor<Real>& c, const MembraneTriangle<Real>& t,
                                     const MembraneStrain<Real>& e, const Vec3<Real>& rate_u,
                                     const Vec3<Real>& rate_v) {
  const Real tau = c.stretch_time;
  const Real u = e.u + tau * (e.w_u.dot(rate_u) * e.per_u);
  const Real v = e.v + tau * (e.w_v.dot(rate_v) * e.per_v);
  const Real shear = e.shear + c.shear_time * (e.w_v.dot(rate_u) + e.w_u.dot(rate_v));
  MembraneStress<Real> s;
  s.u = t.area * (c.warp * u + c.coupling * v);
  s.v = t.area * (c.weft * v + c.coupling * u);
  s.shear = t.area * c.shear * shear;
  s.along_u = e.w_u * (s.u * e.per_u) + e.w_v * s.shear;
  s.along_v = e.w_v * (s.v * e.per_v) + e.w_u * s.shear;
  return s;
}

/// Forces on the corners [N].
template <class Real>
std::array<Vec3<Real>, 3> membrane_forces(const MembraneTriangle<Real>& t,
                                          const MembraneStress<Real>& s) {
  const Vec3<Real> f1 = -(s.along_u * t.u1 + s.along_v * t.v1),
                   f2 = -(s.along_u * t.u2 + s.along_v * t.v2);
  return {-(f1 + f2), f1, f2};
}

/// The larger of the principal strains |lambda - 1|, where lambda is the length of a thread that
/// was 1 long, in the direction in which it is greatest or least.
template <class Real>
Real principal_strain(const MembraneStrain<Real>& e) {
  const Real uu = e.w_u.squaredNorm(), vv = e.w_v.squaredNorm();
  const Real mean = (uu + vv) / 2, half = (uu - vv) / 2;
  const Real radius = std::sqrt(half * half + e.shear * e.shear);
  const Real longest = std::sqrt(mean + radius) - 1;
  const Real shortest = 1 - std::sqrt(std::fmax(Real(0), mean - radius));
  // Not a maximum, which would hide a number that is not finite.
  return longest < shortest ? shortest : longest;
}

}  // namespace weft
