#pragma once

#include <algorithm>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Energy that a grid's springs have only because they are chords, and its removal.
//
// The cloth's plane has three strains, and the springs of a cell have four: s_u and s_v of its
// sides, the means of two each, and s_1 and s_2 of its diagonals. Where the strain is uniform they
// fit: q = s_1 + s_2 - 2 (a_u s_u + a_v s_v) = 0 with a_u = h_u^2/d^2 and a_v = h_v^2/d^2. Where
// cloth bends obliquely they cannot: chords are shorter than arcs. With strains (l^2/L^2 - 1)/2, q
// is -w, w = |t|^2/(2 d^2), where t = x_00 - x_01 - x_10 + x_11 is the cell's twist: the squares of
// a quadrangle's diagonals are less than those of its sides by |t|^2.
//
// Springs with this misfit have at least an energy whose slope over w is, as a series,
//
//     E p,  p = w + 3 s w^2 + (18 s^2 - 2 m) w^3 + (135 s^3 - 30 s m + 5/2 n) w^4,
//     1/E = sum c^2/K,  s = sum c r^2 / 2,  m = sum c r^3,  n = sum c r^4,  r = E c/K,
//     K = k L^2,  c = 1, 1, -2 a_u, -2 a_v:
//
// least is where all pull alike, K e = -lambda c (1 + e) with elongations e, so that the slope is
// lambda, with w = sum c (1 - (1 + lambda c/K)^-2)/2. In a fold of radius R at 45 degrees that is
// h^4/(256 R^2 B (1/G + ...)) times the energy of bending, 3 times in a fold of silk of
// 6.5e-7 N m whose radius is its bending length, with cells of 7.5 mm. It is subtracted, so that
// folds have the energy of their bending alone in all directions:
//
//     U = -E f^2 integral of p dw,  f = 1 - (w/w_1)^4 up to w_1 = 0.8, and 0 beyond.
//
// A fold whose radius is 1.4 cells has w = 1/8. Where cloth is crumpled the springs keep all their
// energy, which opens its tucks. The series is off by at most 1/200 at w = 0.3; 255/256 of it is
// subtracted, so that the energy of springs with U is never negative. Homogeneous strains have no
// twist, and U is of its fourth order, so that moduli, waves and stability bounds do not change.

namespace weft {

inline constexpr double kMisfitEnd = 0.8;           ///< w_1
inline constexpr double kMisfitPart = 255.0 / 256;  ///< of E that is subtracted
/// 1/w_1^4, by which f falls.
inline constexpr double kMisfitFall = 1 / (kMisfitEnd * kMisfitEnd * kMisfitEnd * kMisfitEnd);

/// Constants of the formulas above.
template <class Real>
struct MisfitLaw {
  Real stiffness = 0;                      ///< E [N m], the part of it; 0: no springs of the fabric
  Real per_d2 = 0;                         ///< 1/(2 d^2) [1/m^2]
  Real second = 0, third = 0, fourth = 0;  ///< coefficients of p / w
  /// Of twice the integral of p, over w^2.
  Real mean_second = 0, mean_third = 0, mean_fourth = 0;

  MisfitLaw() = default;
  explicit MisfitLaw(const GridSprings<Real>& springs) {
    if (springs.misfit == 0) return;
    const double u2 = square(springs.rest_warp), v2 = square(springs.rest_weft),
                 d2 = square(springs.rest_shear), whole = springs.misfit;
    double s = 0, m = 0, n = 0;
    const auto add = [&](double c, double k) {
      const double r = whole * c / k;
      s += c * r * r / 2;
      m += c * r * r * r;
      n += c * r * r * r * r;
    };
    for (int k = 0; k < 2; ++k) add(1, springs.shear * d2);
    add(-2 * u2 / d2, springs.warp * u2);
    add(-2 * v2 / d2, springs.weft * v2);
    stiffness = static_cast<Real>(kMisfitPart * whole);
    per_d2 = static_cast<Real>(1 / (2 * d2));
    second = static_cast<Real>(3 * s);
    third = static_cast<Real>(18 * s * s - 2 * m);
    fourth = static_cast<Real>(135 * s * s * s - 30 * s * m + 2.5 * n);
    mean_second = second / Real(1.5);
    mean_third = third / 2;
    mean_fourth = fourth / Real(2.5);
  }

  /// p / w.
  Real rise(Real w) const { return 1 + w * (second + w * (third + w * fourth)); }
  /// Twice the integral of p, over w^2.
  Real mean_rise(Real w) const {
    return 1 + w * (mean_second + w * (mean_third + w * mean_fourth));
  }

 private:
  static double square(Real length) { return static_cast<double>(length) * length; }
};

/// Decrease of the stiffness of a cell's twist, -2 dU/d|t|^2 [N/m].
/// @param squared  |t|^2 [m^2]
template <class Real>
Real misfit_softening(const MisfitLaw<Real>& law, Real squared) {
  const Real w = std::min(law.per_d2 * squared, Real(kMisfitEnd)), w2 = w * w;
  const Real fade = 1 - Real(kMisfitFall) * w2 * w2;
  const Real p = w * law.rise(w), twice = w2 * law.mean_rise(w);
  return 2 * law.stiffness * law.per_d2 * fade *
         (p * fade - 4 * Real(kMisfitFall) * w2 * w * twice);
}

/// -2 U [J].
template <class Real>
Real doubled_misfit_energy(const MisfitLaw<Real>& law, Real squared) {
  const Real w = std::min(law.per_d2 * squared, Real(kMisfitEnd)), w2 = w * w;
  const Real fade = 1 - Real(kMisfitFall) * w2 * w2;
  return law.stiffness * w2 * law.mean_rise(w) * fade * fade;
}

/// Adds the forces of all cells of a part [N]; none if it has no regular springs.
template <class Real>
void add_misfit_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                       Vec3Array<Real>& force);

/// Their energy, not positive [J].
template <class Real>
double misfit_energy(const ClothPart<Real>& part, const Vec3Array<Real>& x);

}  // namespace weft
