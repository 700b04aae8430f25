#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/particle_fields.h"
#include "core/forces/elastic_energy.h"

namespace weft {

/// Adds the elastic and damping forces of all hinges to `force` [N]; the formula is in hinge.h.
template <class Real>
void add_hinge_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                      const ParticleFields<Real>& v, ParticleFields<Real>& force);

/// Adds the forces of the quadratic bending form to `force` [N]: -k w^T (w x) for each stencil w.
template <class Real>
void add_quadratic_bending_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                                  ParticleFields<Real>& force);

/// Stencils of the quadratic form that one evaluation visits; 0 if there is none.
template <class Real>
std::size_t quadratic_stencil_count(const ClothModel<Real>& model);

/// Adds the bending energy of whichever form the model has to `energy`.
template <class Real>
void add_bending_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                        ElasticEnergy& energy);

}  // namespace weft
