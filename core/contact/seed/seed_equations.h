#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/types.h"

// The contact equations of H.-H. Cheng, "Interactive Cloth Simulation" (the seed), as pure
// functions: (7) to (12), and the map that keeps folds (after Bridson, Marino, Fedkiw 2003). Where
// the seed has equal masses m, these take inverse masses w: w = 1/m gives its formulas, and w = 0
// is a pinned particle.

namespace weft::seed {

/// Position of a point relative to a triangle.
template <class Real>
struct Proximity {
  bool near = false;           ///< within h of the plane and over the triangle grown by delta
  Real distance = 0;           ///< signed, x43 . n [m]
  Vec3<Real> normal;           ///< unit
  std::array<Real, 3> weight;  ///< barycentric, sum 1
};

/// delta: margin of weights outside a triangle, h over the side of a square of its area.
template <class Real>
Real weight_margin(const Vec3<Real>& doubled_normal, Real h) {
  return h / std::sqrt(Real(0.5) * doubled_normal.norm());
}

/// Proximity of x4 to triangle x1 x2 x3 by (7) and (8). Nothing is near to a triangle without area.
/// @param h  thickness [m]
template <class Real>
Proximity<Real> proximity(const Vec3<Real>& x4, const Vec3<Real>& x1, const Vec3<Real>& x2,
                          const Vec3<Real>& x3, Real h) {
  assert(h > 0);
  Proximity<Real> result;
  const Vec3<Real> x13 = x1 - x3, x23 = x2 - x3, x43 = x4 - x3;
  const Vec3<Real> doubled = x13.cross(x23);
  const Real length = doubled.norm();
  if (!(length > 0)) return result;
  result.normal = doubled / length;
  result.distance = x43.dot(result.normal);
  if (!(std::abs(result.distance) < h)) return result;
  const Real a = x13.dot(x13), b = x13.dot(x23), c = x23.dot(x23);
  const Real p = x13.dot(x43), q = x23.dot(x43), determinant = a * c - b * b;
  if (!(determinant > 0)) return result;
  const Real w1 = (c * p - b * q) / determinant, w2 = (a * q - b * p) / determinant;
  result.weight = {w1, w2, Real(1) - w1 - w2};
  const Real delta = weight_margin(doubled, h);
  result.near = true;
  for (const Real w : result.weight) result.near &= w >= -delta && w <= Real(1) + delta;
  return result;
}

/// (9): the point of the triangle's plane with these weights.
template <class Real>
Vec3<Real> weighted(const std::array<Real, 3>& weight, const Vec3<Real>& a, const Vec3<Real>& b,
                    const Vec3<Real>& c) {
  return a * weight[0] + b * weight[1] + c * weight[2];
}

/// (10): velocity after contact with a surface of unit normal n. The tangential part loses up to
/// k_f |v_N|; the normal part turns into -k_diss v_N.
/// @param friction     k_f >= 0
/// @param dissipation  k_diss, 0 <= k_diss < 1
template <class Real>
Vec3<Real> after_contact(const Vec3<Real>& v, const Vec3<Real>& n, Real friction,
                         Real dissipation) {
  assert(friction >= 0);
  assert(dissipation >= 0 && dissipation < 1);
  const Real normal_speed = v.dot(n);
  const Vec3<Real> v_n = n * normal_speed, v_t = v - v_n;
  const Real slip = v_t.norm(), lost = friction * std::abs(normal_speed);
  Vec3<Real> back = v_n * -dissipation;
  if (slip >= lost && slip > 0) return v_t * (Real(1) - lost / slip) + back;
  return back;
}

/// (11) and (12) with any number of weights: impulse [N s] that removes the approach v_n of two
/// weighted points; 0 if all are pinned. For two particles of mass m (weights 1 and -1) it is m v_n
/// / 2, for a particle and a triangle (1, -w1, -w2, -w3) it is m v_n / (1 + w1^2 + w2^2 + w3^2).
/// Each particle then changes its velocity by (its signed weight) (its inverse mass) (impulse) n.
template <class Real, std::size_t Count>
Real weighted_impulse(Real v_n, const std::array<Real, Count>& weight,
                      const std::array<Real, Count>& inverse_mass) {
  Real mobility = 0;
  for (std::size_t k = 0; k < Count; ++k) mobility += weight[k] * weight[k] * inverse_mass[k];
  return mobility > 0 ? v_n / mobility : Real(0);
}

/// The map that keeps folds: takes signed distances phi, phi_min <= phi < tau, to eps + (phi -
/// phi_min)(tau - eps)/(tau - phi_min). It is monotone: the deepest particle moves to eps, tau
/// stays, and the order of heights is kept. Distances beyond tau, and those that need no lift
/// (phi_min >= eps), stay.
template <class Real>
Real fold_map(Real phi, Real phi_min, Real tau, Real eps) {
  assert(!(phi < phi_min));
  if (!(phi < tau) || !(phi_min < eps)) return phi;
  assert(eps < tau);
  return eps + (phi - phi_min) * (tau - eps) / (tau - phi_min);
}

}  // namespace weft::seed
