// Dashpots of quadratic bending, along the curvature of each stencil.

#include "core/forces/bending_damping.h"

#include <cassert>

#include "core/cloth/bending_stencil.h"
#include "core/forces/constants.h"

namespace weft {
namespace {

/// A stencil's value, from differences because its weights sum to zero.
template <class To, class From>
Vec3<To> value_of(const Vec3Array<From>& of, const Index* corners, const double* weights,
                  int count) {
  const auto at = [&](int n) -> const Vec3<From>& {
    return of[static_cast<std::size_t>(corners[n])];
  };
  Vec3<To> sum = Vec3<To>::Zero();
  for (int n = 1; n < count; ++n)
    sum += (at(n) - at(0)).template cast<To>() * static_cast<To>(weights[n]);
  return sum;
}

/// Rate of a stencil's value along itself, over its square [1/s].
template <class Real>
Real growth(const Vec3<Real>& c, const Vec3<Real>& rate) {
  return c.dot(rate) / (c.squaredNorm() + static_cast<Real>(kSmallestSquaredBend));
}

}  // namespace

template <class Real>
void add_bending_damping_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                                const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  assert(v.size() == x.size() && force.size() == x.size());
  visit_damped_stencils(
      part, [&](double k, const Index* corners, const double* weights, int count) {
        const Vec3<Real> c = value_of<Real>(x, corners, weights, count);
        const Vec3<Real> rate = value_of<Real>(v, corners, weights, count);
        const Vec3<Real> pull = c * (-static_cast<Real>(k) * part.bending_time * growth(c, rate));
        for (int n = 0; n < count; ++n)
          force[static_cast<std::size_t>(corners[n])] += pull * static_cast<Real>(weights[n]);
      });
}

template <class Real>
double bending_loss(const ClothPart<Real>& part, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                    const Vec3Array<double>& displacement) {
  assert(v.size() == x.size() && displacement.size() == x.size());
  double sum = 0;
  visit_damped_stencils(
      part, [&](double k, const Index* corners, const double* weights, int count) {
        const Vec3d c = value_of<double>(x, corners, weights, count);
        const Vec3d rate = value_of<double>(v, corners, weights, count);
        const Vec3d moved = value_of<double>(displacement, corners, weights, count);
        sum += k * growth(c, rate) * c.dot(moved);
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
