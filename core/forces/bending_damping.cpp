// Dashpots of quadratic bending, along the curvature of each stencil.

#include "core/forces/bending_damping.h"

#include <cassert>

#include "core/cloth/bending_stencil.h"
#include "core/forces/stencil_force.h"

namespace weft {
template <class Real>
void add_bending_damping_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                                const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  assert(v.size() == x.size() && force.size() == x.size());
  visit_damped_stencils(
      part, [&](double k, const Index* corners, const double* weights, int count) {
        add_stencil_damping(k, part.bending_time, {corners, weights, count}, x, v, force);
      });
}

template <class Real>
double bending_loss(const ClothPart<Real>& part, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                    const Vec3Array<double>& displacement) {
  assert(v.size() == x.size() && displacement.size() == x.size());
  double sum = 0;
  visit_damped_stencils(part, [&](double k, const Index* corners, const double* weights,
                                  int count) {
    const StencilView stencil{corners, weights, count};
    const Vec3d c = stencil_difference<double>(stencil, x);
    const Vec3d rate = stencil_difference<double>(stencil, v);
    sum += k * stencil_growth(c, rate) * c.dot(stencil_difference<double>(stencil, displacement));
  });
  return static_cast<double>(part.bending_time) * sum;
}

#define WEFT_INSTANTIATE(Real)                                                             \
  template void add_bending_damping_forces(const ClothPart<Real>&, const Vec3Array<Real>&, \
                                           const Vec3Array<Real>&, Vec3Array<Real>&);      \
  template double bending_loss(const ClothPart<Real>&, const Vec3Array<Real>&,             \
                               const Vec3Array<Real>&, const Vec3Array<double>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
