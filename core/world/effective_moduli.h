#pragma once

#include <string>
#include <vector>

#include "core/world/constants.h"
#include "core/world/world.h"

// How stiff relaxation with compliance (XPBD) makes a cloth, computed from its sweeps.

namespace weft {

/// Moduli of a cloth under XPBD as shares of those asked for, fabric / compliance [1]; 0: the
/// fabric has none, or it is not known.
struct EffectiveModuli {
  std::string cloth;
  int substeps = 0;      ///< per tick
  int sweeps = 0;        ///< per substep
  bool known = false;    ///< else what follows is not: see effective_moduli
  double warp = 0;       ///< uniaxial modulus along u, E_u = C11 - C12^2 / C22
  double weft = 0;       ///< likewise along v
  double shear = 0;      ///< C66
  double poisson = 0;    ///< narrowing along v per strain along u
  double of_fabric = 0;  ///< the fabric's own, C12 / C22
  int needed = 0;  ///< substeps with which no share is less than kLeastModulusShare; 0: too many

  /// The least of the shares; 1 if there is none.
  double least() const;
};

/// Moduli of the cloths of a world at its start under XPBD; none with another solver or with rigid
/// springs. A substep begins with multipliers of zero, and each constraint is relaxed while those
/// before it already pull, so that at rest its force is less than its strain would give. Where the
/// strain is uniform that is so everywhere alike: the sweeps of one substep over a strained cloth
/// at rest move nothing inside, and their multipliers are the stress that XPBD has for that strain.
/// A grid is computed on a square of its cells, a mesh on itself.
///
/// For sheets that hang from a side the modulus is right to 3 % on grids; on meshes to 6 % where
/// half of it is left, and to a sixth where a sixth is. Shear is right to 8 % for a sheet that sags
/// between two sides; beside these sides the sheet is softer still.
///
/// Not known: direct springs, springs along the edges of a mesh, a mesh that is not flat in its own
/// uv, and what would take more than kMostProbedSprings.
template <class Real>
std::vector<EffectiveModuli> effective_moduli(const World<Real>& world);

/// Sentences for people about those that keep less than kLeastModulusShare of a modulus, or may do.
std::vector<std::string> describe(const std::vector<EffectiveModuli>& moduli);

}  // namespace weft
