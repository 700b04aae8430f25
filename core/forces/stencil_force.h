#pragma once

#include "core/types.h"

// The force of one stencil of quadratic bending.

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

/// Adds `pull` times each weight to the forces of the particles [N].
template <class Real>
void share_pull(const StencilView& stencil, const Vec3<Real>& pull, Vec3Array<Real>& force) {
  for (int n = 0; n < stencil.count; ++n)
    force[static_cast<std::size_t>(stencil.corners[n])] +=
        pull * static_cast<Real>(stencil.weights[n]);
}

/// Adds the force of the energy k/2 |value|^2.
/// @param k  its stiffness
template <class Real>
void add_stencil_force(double k, const StencilView& stencil, const Vec3Array<Real>& x,
                       Vec3Array<Real>& force) {
  share_pull<Real>(stencil, stencil_value<Real>(stencil, x) * -static_cast<Real>(k), force);
}

}  // namespace weft
