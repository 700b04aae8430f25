#pragma once

#include "core/cloth/fabric.h"
#include "core/definition.h"

// Modes of a strip of fabric by which its damping is measured.

namespace weft {

/// The first mode of a strip along the warp. Neither gravity nor air is part of it.
enum class FabricMode {
  stretch,  ///< along a narrow strip that is held at both ends
  shear,    ///< sideways in the plane of a wide strip that is held at both ends
  bending,  ///< out of the plane of a strip that is held level at one end
};

inline FieldInfo fabric_mode_info() {
  return choice("mode", "stretch|shear|bending", "mode of a strip along the warp");
}

/// Its angular frequency without damping [1/s]: pi / L sqrt(E / sigma) with the uniaxial modulus E
/// along the warp, or with the shear stiffness, and 1.875^2 / L^2 sqrt(B / sigma).
/// @param length  of the strip [m], positive
double angular_frequency(const FabricDef& fabric, FabricMode mode, double length);

/// The relaxation time of what a mode deforms [s].
double relaxation_time(const FabricDef& fabric, FabricMode mode);

/// The relaxation time of the stretch mode on a grid, to first order in the damping [s]. With the
/// dashpots' tensor D it is (D11 - 2 n D12 + n^2 D22) / E, n = C12 / C22. Dashpots between pairs of
/// particles have D12 = D66, so D12 is shear_damping times C12, and not stretch_damping times it.
/// @param cell_u, cell_v  sides of a cell [m]
double stretch_relaxation_on_grid(const FabricDef& fabric, double cell_u, double cell_v);

/// Its reverse: the stretch_damping with which the mode has a relaxation time, where the diagonals
/// leave the springs along both threads something to damp; negative if no stretch_damping does.
double stretch_damping_on_grid(const FabricDef& fabric, double relaxation);

/// The least stretch_damping that a grid can have beside its shear_damping [s]: with less, the
/// diagonals alone damp stretch by more, along a thread at least.
double least_stretch_damping_on_grid(const FabricDef& fabric, double cell_u, double cell_v);

/// The shortest time in which the amplitude of a damped mode falls to 1/e, that of critical damping
/// (a loss factor of 2), 1 / omega [s].
/// @param omega  angular frequency of the mode without damping [1/s], positive
double shortest_decay_time(double omega);

/// Whether a mode creeps back without a swing: omega tau > 2.
bool creeps(double omega, double relaxation);

/// The time in which the amplitude of q'' + omega^2 tau q' + omega^2 q = 0 falls to 1/e [s]:
/// 2 / (omega^2 tau) of a swing. Of a creep it is that of the slower of its two parts, which is
/// left in the end: tau/2 + sqrt(tau^2/4 - 1/omega^2), nearly tau.
/// @param relaxation  tau [s], positive
double decay_time(double omega, double relaxation);

/// The relaxation time of a swing whose amplitude falls to 1/e in a time [s], 2 / (omega^2 T).
/// @param decay_time  [s]; less than the shortest one is possible for no relaxation time
double relaxation_of_decay(double omega, double decay_time);

/// The relaxation time of a mode with a loss factor, the energy that it loses in a cycle over 2 pi
/// times what it has, eta / omega [s].
double relaxation_of_loss(double omega, double loss_factor);

}  // namespace weft
