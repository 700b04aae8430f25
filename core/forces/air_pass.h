#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/particle_fields.h"

namespace weft {

/// Adds the force of the air on all triangles, a third to each corner [N]; the formula is in air.h.
/// @param wind     velocity of the air at each particle [m/s]
/// @param density  of the air [kg/m^3]
template <class Real>
void add_air_forces(const ClothModel<Real>& model, const ParticleFields<Real>& wind, double density,
                    const ParticleFields<Real>& x, const ParticleFields<Real>& v,
                    ParticleFields<Real>& force);

}  // namespace weft
