#pragma once

#include <string>
#include <vector>

#include "core/world/world.h"

// Damping of a fabric on the mesh of its cloth, and the substeps that it takes.

namespace weft {

/// A cloth whose mesh needs more damping than its fabric has, or a grid whose diagonals damp
/// stretch by more, or a cloth whose damping takes substeps.
struct MeshDamping {
  std::string cloth;
  double asked = 0;  ///< relaxation time of stretch or shear that the fabric has [s]
  double given = 0;  ///< and that which stability needs [s]; 0: no more than the fabric has
  double loss = 0;   ///< by that, of the energy of the first stretch wave along the warp, a second
  double of_shear = 0;  ///< relaxation time that the diagonals of a grid, damped as shear, give the
                        ///< stretch of a thread beyond its own [s]; 0: none
  double own = 0;       ///< which is this [s]
  int substeps = 0;     ///< per tick
  int undamped = 0;     ///< and with no more damping than stability needs
};

/// The cloths of a world at its start whose fabric has relaxation times of its own, if these are
/// less than stability needs or take substeps; none with the solver relaxation, whose membrane has
/// no dashpots. The first stretch wave has half its length from one side of the fabric to the
/// other.
template <class Real>
std::vector<MeshDamping> damping_of_meshes(const World<Real>& world);

/// A sentence for people.
std::string describe(const MeshDamping& damping);

}  // namespace weft
