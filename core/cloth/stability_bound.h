#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/constants.h"

// The stability bound of the explicit solver.

namespace weft {

/// Bounds that determine the largest stable substep of the explicit solver.
struct StabilityBound {
  double omega2 = 0;        ///< bound of the highest squared frequency, summed over terms [1/s^2]
  double damping_rate = 0;  ///< bound of the corresponding damping rate 2 zeta omega [1/s]
};

/// The largest stable leapfrog substep with lagged damping [s]: the positive root of dt^2 omega^2 +
/// 2 dt c = 4, which is (sqrt(1 + zeta^2) - zeta) 2/omega for c = 2 zeta omega. Infinite without
/// forces.
double largest_stable_substep(const StabilityBound& bound);

/// Number of stable substeps in a tick of `tick_seconds` [s], at least `fewest`. Above
/// `kMostSubsteps` if the cloth is too stiff for the explicit solver.
long substeps_for(const StabilityBound& bound, double tick_seconds, int fewest);

/// Computes the bounds of a part's springs: omega^2 = max_i 2 sum_j k_ij / m_i (Gershgorin rows of
/// the spring matrix), and the rate of their dashpots.
template <class Real>
void bound_springs(const ClothModel<Real>& model, ClothPart<Real>& part);

/// The same of its hinges, by the Gershgorin rows of their rest-state matrix k g g^T.
template <class Real>
void bound_hinges(const ClothModel<Real>& model, ClothPart<Real>& part);

/// The same of its quadratic form, in place of hinges: each stencil w with energy k/2 |w x|^2
/// adds k |w_i| sum|w| to the Gershgorin rows of its particles; the links of a mesh are those rows,
/// to which rest curves add theirs.
/// Its dashpots have a bound of their own.
template <class Real>
void bound_quadratic_bending(const ClothModel<Real>& model, ClothPart<Real>& part);

/// Bounds how fast the air damps a part, per unit of its force on an area: the largest eigenvalue
/// of D v = lambda M v, where D has a ninth of each triangle's area for each two of its corners,
/// because the mean of their velocities counts and each gets a third of the force. It is 1 / sigma
/// where a triangle's thirds are the masses, 10/9 of that on a grid, whose diagonals alternate and
/// whose masses do not, and more with equal masses.
template <class Real>
void bound_damped_area(const ClothModel<Real>& model, ClothPart<Real>& part);

/// Relaxation time that gives a part's highest membrane mode the damping ratio of its fabric, 2
/// zeta / omega [s]. Without it a shaken cloth keeps the energy of its high modes forever
/// (tests/laws/shaking_test.cpp).
template <class Real>
double least_relaxation_time(const ClothPart<Real>& part);

/// c/k of springs by their kind [s].
struct SpringTimes {
  double warp = 0, weft = 0, shear = 0;
};

/// Gives the springs of a part their dashpots, and bounds the rate of these. Springs that are
/// neither warp, weft nor shear have the warp's.
template <class Real>
void add_spring_damping(const SpringTimes& times, ClothModel<Real>& model, ClothPart<Real>& part);

}  // namespace weft
