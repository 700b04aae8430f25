#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/particle_fields.h"
#include "core/forces/elastic_energy.h"

namespace weft {

/// Adds the elastic and dashpot forces of all springs to `force` [N]; the formula is in spring.h.
/// @param x,v  positions [m] and velocities [m/s]
template <class Real>
void add_spring_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                       const ParticleFields<Real>& v, ParticleFields<Real>& force);

/// Adds the stretch energy and the largest strain to `energy`. NaN is kept and seen.
template <class Real>
void add_stretch_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                        ElasticEnergy& energy);

/// Strain |l - L| / L of every structural and shear spring, into `strain` (cleared first).
template <class Real>
void collect_strains(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                     std::vector<Real>& strain);

}  // namespace weft
