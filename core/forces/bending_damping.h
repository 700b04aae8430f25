#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// The dashpots of quadratic bending.

namespace weft {

/// Adds the damping forces of a part's quadratic bending to `force` [N]: of a stencil whose value c
/// = sum w x has the energy k/2 |c|^2, the force -tau k (dc/dt . c) c / |c|^2 per weight. It is the
/// length of c that is damped, which is the curvature. A dashpot along all of dc/dt would resist a
/// bent cloth that turns as a whole too, because c turns with it. What c lacks is that a stretched
/// cloth whose strain changes along it has a part of c in its plane: bends that are slighter than
/// that are not damped.
template <class Real>
void add_bending_damping_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                                const Vec3Array<Real>& v, Vec3Array<Real>& force);

/// Energy that these dashpots take over small displacements, at the velocities v [J], in double.
template <class Real>
double bending_loss(const ClothPart<Real>& part, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                    const Vec3Array<double>& displacement);

}  // namespace weft
