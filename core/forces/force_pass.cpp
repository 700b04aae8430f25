// Element-wise forces and energies.

#include "core/forces/force_pass.h"

#include <cassert>
#include <cmath>

#include "core/cloth/bending_stencil.h"
#include "core/forces/air/air_force.h"
#include "core/forces/cell_misfit.h"
#include "core/forces/hinge.h"
#include "core/forces/membrane.h"
#include "core/forces/rest_curve.h"
#include "core/forces/spring.h"
#include "core/forces/stencil_force.h"
#include "core/forces/thread_lock.h"
#include "core/geometry/hinge_angle.h"

namespace weft {
namespace {

template <class T>
const T& at(const std::vector<T>& values, Index i) {
  return values[static_cast<std::size_t>(i)];
}

template <class T>
T& at(std::vector<T>& values, Index i) {
  return values[static_cast<std::size_t>(i)];
}

template <class Real>
MembraneStrain<Real> strain_of(const MembraneTriangle<Real>& t, const Vec3Array<Real>& x) {
  const Vec3<Real>& start = at(x, t.x[0]);
  return membrane_strain<Real>(t, at(x, t.x[1]) - start, at(x, t.x[2]) - start);
}

}  // namespace

template <class Real>
void add_spring_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                       const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  assert(v.size() == x.size() && force.size() == x.size());
  assert(part.springs.end() <= static_cast<Index>(model.springs.size()));
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& s = at(model.springs, n);
    const Vec3<Real> f = spring_force<Real>(s, at(x, s.j) - at(x, s.i), at(v, s.j) - at(v, s.i));
    at(force, s.i) += f;
    at(force, s.j) -= f;
  }
  add_misfit_forces(part, x, force);
}

template <class Real>
void add_membrane_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                         const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                         Vec3Array<Real>& force) {
  assert(v.size() == x.size() && force.size() == x.size());
  assert(part.membrane.end() <= static_cast<Index>(model.membrane.size()));
  for (Index n = part.membrane.first; n < part.membrane.end(); ++n) {
    const MembraneTriangle<Real>& t = at(model.membrane, n);
    const Vec3<Real> v1 = at(v, t.x[1]) - at(v, t.x[0]), v2 = at(v, t.x[2]) - at(v, t.x[0]);
    const MembraneStress<Real> stress = membrane_stress<Real>(
        part.membrane_tensor, t, strain_of(t, x), gradient_u(t, v1, v2), gradient_v(t, v1, v2));
    const std::array<Vec3<Real>, 3> forces = membrane_forces(t, stress);
    for (std::size_t k = 0; k < 3; ++k) at(force, t.x[k]) += forces[k];
  }
}

template <class Real>
void add_locking_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                        const Vec3Array<Real>& x, Vec3Array<Real>& force) {
  assert(force.size() == x.size());
  assert(part.locks.end() <= static_cast<Index>(model.locks.size()));
  const auto strain = static_cast<Real>(part.fabric.locking_strain);
  for (Index n = part.locks.first; n < part.locks.end(); ++n)
    add_lock_force(at(model.locks, n), strain, x, force);
}

template <class Real>
void add_hinge_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                      const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  assert(v.size() == x.size() && force.size() == x.size());
  assert(part.hinges.end() <= static_cast<Index>(model.hinges.size()));
  for (Index n = part.hinges.first; n < part.hinges.end(); ++n) {
    const Hinge<Real>& h = at(model.hinges, n);
    const HingeAngle<Real> angle = hinge_angle<Real>(at(x, h.x[0]), at(x, h.x[1]), at(x, h.x[2]),
                                                     at(x, h.x[3]), h.smallest_normal2);
    Real rate = 0;
    for (std::size_t a = 0; a < 4; ++a) rate += angle.gradient[a].dot(at(v, h.x[a]));
    const Real moment = hinge_moment(h, angle.theta, rate);
    for (std::size_t a = 0; a < 4; ++a) at(force, h.x[a]) += angle.gradient[a] * moment;
  }
}

template <class Real>
void add_quadratic_bending_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                                  Vec3Array<Real>& force) {
  assert(force.size() == x.size());
  visit_bending_stencils(part,
                         [&](double k, const Index* corners, const double* weights, int count) {
                           add_stencil_force(k, {corners, weights, count}, x, force);
                         });
}

template <class Real>
void add_air_forces(const ClothModel<Real>& model, const ClothPart<Real>& part,
                    const Vec3Array<Real>& wind, double density, const Vec3Array<Real>& x,
                    const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  assert(density >= 0);
  assert(wind.size() == x.size() && v.size() == x.size() && force.size() == x.size());
  const Real pressure = static_cast<Real>(0.5 * density * part.fabric.air_normal);
  const Real skin = static_cast<Real>(density > 0 ? part.fabric.air_tangential : 0);
  for (Index n = part.triangles.first; n < part.triangles.end(); ++n) {
    const Triangle& t = at(model.triangles, n);
    const Vec3<Real> normal = (at(x, t[1]) - at(x, t[0])).cross(at(x, t[2]) - at(x, t[0]));
    const Vec3<Real> u = ((at(wind, t[0]) - at(v, t[0])) + (at(wind, t[1]) - at(v, t[1])) +
                          (at(wind, t[2]) - at(v, t[2]))) *
                         Real(1.0 / 3.0);
    const Vec3<Real> third = air_force<Real>(normal, u, pressure, skin) * Real(1.0 / 3.0);
    for (const Index corner : t) at(force, corner) += third;
  }
}

template <class Real>
std::size_t quadratic_stencil_count(const ClothPart<Real>& part) {
  const QuadraticBending<Real>& q = part.quadratic_bending;
  if (!part.bending_links.empty()) return part.bending_links.size();
  if (q.along_u == 0 && q.along_v == 0 && q.twist == 0) return 0;
  return part.bending_stencils;
}

void add(const ElasticEnergy& part, ElasticEnergy& sum) {
  sum.stretch += part.stretch;
  sum.bending += part.bending;
  if (!(part.largest_strain <= sum.largest_strain)) sum.largest_strain = part.largest_strain;
}

template <class Real>
ElasticEnergy elastic_energy(const ClothModel<Real>& model, const ClothPart<Real>& part,
                             const Vec3Array<Real>& x) {
  assert(x.size() == model.mass.size());
  assert(model.spring_kinds.size() == model.springs.size());
  ElasticEnergy energy;
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& s = at(model.springs, n);
    const auto stretch = static_cast<double>((at(x, s.j) - at(x, s.i)).norm() - s.rest_length);
    energy.stretch += 0.5 * static_cast<double>(s.stiffness) * stretch * stretch;
    if (at(model.spring_kinds, n) == SpringKind::skip) continue;
    const double strain = std::abs(stretch) / static_cast<double>(s.rest_length);
    if (!(strain <= energy.largest_strain)) energy.largest_strain = strain;
  }
  energy.stretch += misfit_energy(part, x);
  for (Index n = part.membrane.first; n < part.membrane.end(); ++n) {
    const MembraneTriangle<Real>& t = at(model.membrane, n);
    const MembraneStrain<Real> strain = strain_of(t, x);
    energy.stretch += membrane_energy(part.membrane_tensor, t, strain);
    const auto principal = static_cast<double>(principal_strain(strain));
    if (!(principal <= energy.largest_strain)) energy.largest_strain = principal;
  }
  const auto locking = static_cast<Real>(part.fabric.locking_strain);
  for (Index n = part.locks.first; n < part.locks.end(); ++n)
    energy.stretch += lock_energy(at(model.locks, n), locking, x);
  for (Index n = part.hinges.first; n < part.hinges.end(); ++n) {
    const Hinge<Real>& h = at(model.hinges, n);
    const HingeAngle<Real> angle = hinge_angle<Real>(at(x, h.x[0]), at(x, h.x[1]), at(x, h.x[2]),
                                                     at(x, h.x[3]), h.smallest_normal2);
    energy.bending += static_cast<double>(hinge_energy(h, angle.theta));
  }
  energy.bending += rest_curve_energy(part, x);
  if (quadratic_stencil_count(part) == 0) return energy;
  visit_bending_stencils(part, [&](double k, const Index* corners, const double* weights,
                                   int count) {
    energy.bending += 0.5 * k * stencil_value<double>({corners, weights, count}, x).squaredNorm();
  });
  return energy;
}

#define WEFT_INSTANTIATE(Real)                                                               \
  template void add_spring_forces(const ClothModel<Real>&, const ClothPart<Real>&,           \
                                  const Vec3Array<Real>&, const Vec3Array<Real>&,            \
                                  Vec3Array<Real>&);                                         \
  template void add_membrane_forces(const ClothModel<Real>&, const ClothPart<Real>&,         \
                                    const Vec3Array<Real>&, const Vec3Array<Real>&,          \
                                    Vec3Array<Real>&);                                       \
  template void add_locking_forces(const ClothModel<Real>&, const ClothPart<Real>&,          \
                                   const Vec3Array<Real>&, Vec3Array<Real>&);                \
  template void add_hinge_forces(const ClothModel<Real>&, const ClothPart<Real>&,            \
                                 const Vec3Array<Real>&, const Vec3Array<Real>&,             \
                                 Vec3Array<Real>&);                                          \
  template void add_quadratic_bending_forces(const ClothPart<Real>&, const Vec3Array<Real>&, \
                                             Vec3Array<Real>&);                              \
  template void add_air_forces(const ClothModel<Real>&, const ClothPart<Real>&,              \
                               const Vec3Array<Real>&, double, const Vec3Array<Real>&,       \
                               const Vec3Array<Real>&, Vec3Array<Real>&);                    \
  template std::size_t quadratic_stencil_count(const ClothPart<Real>&);                      \
  template ElasticEnergy elastic_energy(const ClothModel<Real>&, const ClothPart<Real>&,     \
                                        const Vec3Array<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
