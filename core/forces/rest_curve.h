#pragma once

#include "core/cloth/cloth_model.h"

// Forces of a mesh that is curved at rest, besides those of its links.

namespace weft {

/// Adds the forces of the energy -n . p of each triangle, p = sum pull_i x_i [N]: pull_i n on each
/// particle, and what turns the normal n towards p on the corners. The normal of a crumpled
/// triangle is shorter than 1, so that its forces stay finite.
template <class Real>
void add_rest_curve_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                           Vec3Array<Real>& force);

/// The energy that the links of a part lack [J]; 0 if it is flat at rest.
template <class Real>
double rest_curve_energy(const ClothPart<Real>& part, const Vec3Array<Real>& x);

}  // namespace weft
