#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// What the springs of a grid's cells cost only because they are chords, and its removal.
//
// The cloth's plane has three strains, and the springs of a cell have four: s_u and s_v of its
// sides, the means of two each, and s_1 and s_2 of its diagonals. Where the cloth is strained alike
// they fit: q = s_1 + s_2 - 2 (a_u s_u + a_v s_v) = 0 with a_u = h_u^2/d^2 and a_v = h_v^2/d^2.
// Where it bends aslant they cannot, because chords are shorter than arcs. With strains (l^2/L^2 -
// 1)/2, q is -w, w = |t|^2/(2 d^2), where t = x_00 - x_01 - x_10 + x_11 is the cell's twist: the
// squares of a quadrangle's diagonals are less than those of its sides by |t|^2.
//
// Springs with this misfit have at least the energy E g^2/2 with g = w + s w^2 + w^3/8 + ...,
//
//     1/E = sum c^2/K,  s = E^2/2 sum c^3/K^2,  K = k L^2,  c = 1, 1, -2 a_u, -2 a_v:
//
// h^4/(256 R^2 B (1/G + ...)) times that of bending in a fold of radius R at 45 degrees, 3 times in
// a silk fold of its bending length with cells of 7.5 mm. It is taken off again, so that folds cost
// their bending alone in all directions:
//
//     U = -E/2 g^2,  g = (w + s w^2 + w^3/8)/(1 + w^4).
//
// The denominator bounds it where cloth is torn or crumpled. s is between -1/4, where only the
// sides give way, g = 2 (sqrt(1 + w) - 1), and 1/4, where only the diagonals do, with
// g = 2 (1 - sqrt(1 - w)). Homogeneous strains have no twist, and U is of its fourth order, so that
// moduli, waves and stability bounds stay what they are.

namespace weft {

/// Constants of the formulas above.
template <class Real>
struct MisfitLaw {
  Real stiffness = 0;  ///< E [N m]; 0: no springs of the fabric
  Real per_d2 = 0;     ///< 1/(2 d^2) [1/m^2]
  Real growth = 0;     ///< s [1]

  MisfitLaw() = default;
  explicit MisfitLaw(const GridSprings<Real>& springs) {
    if (springs.misfit == 0) return;
    const Real u2 = springs.rest_warp * springs.rest_warp,
               v2 = springs.rest_weft * springs.rest_weft,
               d2 = springs.rest_shear * springs.rest_shear;
    stiffness = springs.misfit;
    per_d2 = 1 / (2 * d2);
    const auto cubed = [](Real weight, Real k) { return weight * weight * weight / (k * k); };
    growth = stiffness * stiffness / 2 *
             (2 * cubed(1, springs.shear * d2) - cubed(2 * u2 / d2, springs.warp * u2) -
              cubed(2 * v2 / d2, springs.weft * v2));
  }
};

/// By how much the stiffness of a cell's twist falls, -2 dU/d|t|^2 [N/m].
/// @param squared  |t|^2 [m^2]
template <class Real>
Real misfit_softening(const MisfitLaw<Real>& law, Real squared) {
  const Real w = law.per_d2 * squared, w3 = w * w * w, per = 1 / (1 + w3 * w);
  const Real g = (w + law.growth * w * w + w3 / 8) * per;
  const Real slope = (1 + 2 * law.growth * w + 3 * w * w / 8 - 4 * g * w3) * per;  // dg/dw
  return 2 * law.stiffness * law.per_d2 * (g * slope);
}

/// -2 U [J].
template <class Real>
Real doubled_misfit_energy(const MisfitLaw<Real>& law, Real squared) {
  const Real w = law.per_d2 * squared, w3 = w * w * w;
  const Real g = (w + law.growth * w * w + w3 / 8) / (1 + w3 * w);
  return law.stiffness * (g * g);
}

/// Adds the forces of all cells of a part [N]; none if it has no regular springs.
template <class Real>
void add_misfit_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                       Vec3Array<Real>& force);

/// Their energy, not positive [J].
template <class Real>
double misfit_energy(const ClothPart<Real>& part, const Vec3Array<Real>& x);

}  // namespace weft
