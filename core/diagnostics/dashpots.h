#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Energy that the cloth's own dashpots take.

namespace weft {

/// Which dashpots act: a solver with constraints in place of springs has only those of hinges.
enum class Dashpots { all, hinges };

/// Energy that dashpots take over small displacements, their forces being those of the velocities
/// `v`: the sum over springs, triangles and hinges of viscosity times rate times displacement [J].
/// In double, element by element.
/// @param x             positions [m]
/// @param v             velocities that the dashpots see [m/s]
/// @param displacement  of each particle [m]
template <class Real>
double dashpot_loss(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                    const Vec3Array<Real>& v, const Vec3Array<double>& displacement,
                    Dashpots which = Dashpots::all);

extern template double dashpot_loss(const ClothModel<float>&, const Vec3Array<float>&,
                                    const Vec3Array<float>&, const Vec3Array<double>&, Dashpots);
extern template double dashpot_loss(const ClothModel<double>&, const Vec3Array<double>&,
                                    const Vec3Array<double>&, const Vec3Array<double>&, Dashpots);

}  // namespace weft
