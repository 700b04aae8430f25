#pragma once

#include "core/cloth/cloth_model.h"
#include "core/math/sine.h"
#include "core/types.h"

// Moment and energy of a hinge.

namespace weft {

/// Moment of the hinge [N m]: -k (theta - theta_0) - c dtheta/dt, or in the sine form -2k
/// (sin(theta/2) - sin(theta_0/2)) - c dtheta/dt, which is the force of Bridson, Marino, Fedkiw
/// 2003 with k_e = 4B and the edge and areas at rest. Both agree for small angles; the sine form
/// weakens towards pi. The force on corner a is the moment times gradient[a].
template <class Real>
inline Real hinge_moment(const Hinge<Real>& hinge, Real theta, Real theta_rate) {
  Real bend = theta - hinge.rest_angle;
  if (hinge.sine_form) {
    const auto half = [](Real angle) { return sine_cosine(0.5 * static_cast<double>(angle)).sine; };
    bend = static_cast<Real>(2 * (half(theta) - half(hinge.rest_angle)));
  }
  return -hinge.stiffness * bend - hinge.damping * theta_rate;
}

/// Elastic energy [J]: k/2 (theta - theta_0)^2, or in the sine form
/// 4k (cos(theta_0/2) - cos(theta/2)) - 2k (theta - theta_0) sin(theta_0/2).
template <class Real>
inline Real hinge_energy(const Hinge<Real>& hinge, Real theta) {
  const Real bend = theta - hinge.rest_angle;
  if (!hinge.sine_form) return Real(0.5) * hinge.stiffness * bend * bend;
  // The difference of the cosines as a product, which avoids cancellation.
  const auto t = static_cast<double>(theta), rest = static_cast<double>(hinge.rest_angle);
  const double cosines = 2 * sine_cosine((t + rest) / 4).sine * sine_cosine((t - rest) / 4).sine;
  const double line = (t - rest) * sine_cosine(rest / 2).sine;
  return static_cast<Real>(static_cast<double>(hinge.stiffness) * (4 * cosines - 2 * line));
}

}  // namespace weft
