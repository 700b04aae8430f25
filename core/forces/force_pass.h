#pragma once

#include "core/cloth/cloth_model.h"
#include "core/types.h"

namespace weft {

// Forces element by element, in the order of the model's lists. They work for every cloth and are
// the reference for the row-wise form of grid_pass.h. Each function handles one part of the model;
// those without a part handle all parts in order.

/// Elastic energies at one instant [J], summed in double.
struct ElasticEnergy {
  double stretch = 0;
  double bending = 0;
  double largest_strain = 0;  ///< largest |l - L| / L of the structural and shear springs, and
                              ///< principal strain of the membrane triangles
};

/// Adds the elastic and dashpot forces of all springs to `force` [N], with a grid's misfit;
/// formulas in spring.h and cell_misfit.h.
/// @param x,v  positions [m] and velocities [m/s] of all particles
template <class Real>
void add_spring_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                       const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force);

/// Adds the elastic and dashpot forces of all membrane triangles to `force` [N]; see membrane.h.
template <class Real>
void add_membrane_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                         const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                         Vec3Array<Real>& force);

/// Adds the forces of threads that are locked [N]; formula in thread_lock.h.
template <class Real>
void add_locking_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                        const Vec3Array<Real>& x, Vec3Array<Real>& force);

/// Adds the elastic and damping forces of all hinges to `force` [N]; formula in hinge.h.
template <class Real>
void add_hinge_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                      const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force);

/// Adds the forces of the quadratic bending form to `force` [N]: -k w^T (w x) per stencil w.
template <class Real>
void add_quadratic_bending_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                                  Vec3Array<Real>& force);

/// Adds the force of the air on all triangles, a third to each corner [N]; formula in air_force.h.
/// @param wind     velocity of the air at each particle [m/s]
/// @param density  of the air [kg/m^3]
template <class Real>
void add_air_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                    const Vec3Array<Real>& wind, double density, const Vec3Array<Real>& x,
                    const Vec3Array<Real>& v, Vec3Array<Real>& force);

/// Number of quadratic stencils that one evaluation of a part visits; 0 without the form.
template <class Real>
std::size_t quadratic_stencil_count(const ClothPart<Real>& part);

/// Energies of membrane and bending of a part, and its largest strain. NaN propagates.
template <class Real>
ElasticEnergy elastic_energy(const ClothModel<Real>& model, const ClothPart<Real>& part,
                             const Vec3Array<Real>& x);

/// Adds energies and keeps the larger strain; NaN propagates.
void add(const ElasticEnergy& part, ElasticEnergy& sum);

template <class Real>
ElasticEnergy elastic_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x) {
  ElasticEnergy sum;
  for (const ClothPart<Real>& part : model.parts) add(elastic_energy(model, part, x), sum);
  return sum;
}

template <class Real>
void add_spring_forces(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                       const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  for (const ClothPart<Real>& part : model.parts) add_spring_forces(model, part, x, v, force);
}

template <class Real>
void add_membrane_forces(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                         const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  for (const ClothPart<Real>& part : model.parts) add_membrane_forces(model, part, x, v, force);
}

template <class Real>
void add_hinge_forces(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                      const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  for (const ClothPart<Real>& part : model.parts) add_hinge_forces(model, part, x, v, force);
}

template <class Real>
void add_quadratic_bending_forces(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                                  Vec3Array<Real>& force) {
  for (const ClothPart<Real>& part : model.parts) add_quadratic_bending_forces(part, x, force);
}

template <class Real>
void add_air_forces(const ClothModel<Real>& model, const Vec3Array<Real>& wind, double density,
                    const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  for (const ClothPart<Real>& part : model.parts)
    add_air_forces(model, part, wind, density, x, v, force);
}

}  // namespace weft
