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

/// The relaxation time of a mode whose amplitude falls to 1/e in a time [s], 2 / (omega^2 T), or
/// the reverse: the formula is its own inverse.
/// @param omega  angular frequency of the mode [1/s], positive
double relaxation_of_decay(double omega, double decay_time);

/// The relaxation time of a mode with a loss factor, the energy that it loses in a cycle over 2 pi
/// times what it has, eta / omega [s].
double relaxation_of_loss(double omega, double loss_factor);

}  // namespace weft
