#pragma once

#include <array>

#include "core/forces/membrane.h"
#include "core/types.h"

// Compliant relaxation of a membrane triangle.

namespace weft {

/// Derivatives of the three strains by the position of a corner, row by row.
template <class Real>
struct StrainGradient {
  Vec3<Real> u, v, shear;
};

template <class Real>
std::array<StrainGradient<Real>, 3> strain_gradients(const MembraneTriangle<Real>& t,
                                                     const MembraneStrain<Real>& e) {
  const CornerGradients<Real> b = corner_gradients<Real>(t);
  std::array<StrainGradient<Real>, 3> g;
  for (std::size_t k = 0; k < 3; ++k)
    g[k] = {e.w_u * (b.u[k] * e.per_u), e.w_v * (b.v[k] * e.per_v),
            e.w_v * b.u[k] + e.w_u * b.v[k]};
  return g;
}

/// XPBD of the three strains together, which the tensor couples: the change d of the multipliers
/// solves (K W + 1) d = K e - lambda, with K the tensor times the triangle's area over `softness`
/// and W = J M^-1 J^T. With K on the left, strains that the fabric does not resist need no infinite
/// compliance.
/// @param softness      compliance over dt^2 [1/s^2]
/// @param inverse_mass  of the corners [1/kg]
/// @param e             present strains
/// @param multiplier    lambda, within the substep [kg m^2]; updated
/// @returns displacements of the corners [m]
template <class Real>
std::array<Vec3<Real>, 3> relax_membrane(const MembraneTensor<Real>& c,
                                         const MembraneTriangle<Real>& t, Real softness,
                                         const std::array<Real, 3>& inverse_mass,
                                         const MembraneStrain<Real>& e, Vec3<Real>& multiplier) {
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  const std::array<StrainGradient<Real>, 3> g = strain_gradients(t, e);
  Matrix w = Matrix::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    Matrix j;
    j << g[k].u.transpose(), g[k].v.transpose(), g[k].shear.transpose();
    w += (j * j.transpose()) * inverse_mass[k];
  }
  Matrix stiffness = Matrix::Zero();
  stiffness(0, 0) = c.warp;
  stiffness(1, 1) = c.weft;
  stiffness(0, 1) = stiffness(1, 0) = c.coupling;
  stiffness(2, 2) = c.shear;
  stiffness *= t.area / softness;
  const Vec3<Real> wanted = stiffness * Vec3<Real>(e.u, e.v, e.shear) - multiplier;
  const Vec3<Real> change = (stiffness * w + Matrix::Identity()).inverse() * wanted;
  multiplier += change;
  std::array<Vec3<Real>, 3> moved;
  for (std::size_t k = 0; k < 3; ++k)
    moved[k] =
        (g[k].u * change[0] + g[k].v * change[1] + g[k].shear * change[2]) * -inverse_mass[k];
  return moved;
}

}  // namespace weft
