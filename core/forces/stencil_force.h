#pragma once

#include "core/forces/constants.h"
#include "core/types.h"

// The force of one stencil of quadratic bending, and of its dashpot.

namespace weft {

/// Particles and weights of a stencil whose value is sum_k w_k x_k.
struct StencilView {
  const Index* corners;
  const double* weights;
  int count;
};

/// Its value.
template <class To, class Stored>
Vec3<To> stencil_value(const StencilView& stencil, const Vec3Array<Stored>& x) {
  Vec3<To> sum = Vec3<To>::Zero();
  for (int n = 0; n < stencil.count; ++n)
    sum += x[static_cast<std::size_t>(stencil.corners[n])].template cast<To>() *
           static_cast<To>(stencil.weights[n]);
  return sum;
}

/// The same from differences, because the weights sum to zero.
template <class To, class Stored>
Vec3<To> stencil_difference(const StencilView& stencil, const Vec3Array<Stored>& of) {
  const auto at = [&](int n) -> const Vec3<Stored>& {
    return of[static_cast<std::size_t>(stencil.corners[n])];
  };
  Vec3<To> sum = Vec3<To>::Zero();
  for (int n = 1; n < stencil.count; ++n)
    sum += (at(n) - at(0)).template cast<To>() * static_cast<To>(stencil.weights[n]);
  return sum;
}

/// Adds `pull` times each weight to the forces of the particles [N].
template <class Real>
void share_pull(const StencilView& stencil, const Vec3<Real>& pull, Vec3Array<Real>& force) {
  for (int n = 0; n < stencil.count; ++n)
    force[static_cast<std::size_t>(stencil.corners[n])] +=
        pull * static_cast<Real>(stencil.weights[n]);
}

/// Rate of a stencil's value along itself, over its square [1/s].
template <class Real>
Real stencil_growth(const Vec3<Real>& c, const Vec3<Real>& rate) {
  return c.dot(rate) / (c.squaredNorm() + static_cast<Real>(kSmallestSquaredBend));
}

/// Adds the force of the energy k/2 |value|^2.
/// @param k  its stiffness
template <class Real>
void add_stencil_force(double k, const StencilView& stencil, const Vec3Array<Real>& x,
                       Vec3Array<Real>& force) {
  share_pull<Real>(stencil, stencil_value<Real>(stencil, x) * -static_cast<Real>(k), force);
}

/// Adds the force of the stencil's dashpot; see bending_damping.h.
/// @param time  tau [s]
template <class Real>
void add_stencil_damping(double k, Real time, const StencilView& stencil, const Vec3Array<Real>& x,
                         const Vec3Array<Real>& v, Vec3Array<Real>& force) {
  const Vec3<Real> c = stencil_difference<Real>(stencil, x);
  const Vec3<Real> rate = stencil_difference<Real>(stencil, v);
  share_pull<Real>(stencil, c * (-static_cast<Real>(k) * time * stencil_growth(c, rate)), force);
}

}  // namespace weft
