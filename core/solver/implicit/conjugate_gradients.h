#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/spring_grid.h"
#include "core/stop_signal.h"

// Preconditioned conjugate gradients.

namespace weft {

/// Outcome of a linear system.
struct LinearSolution {
  int iterations = 0;
  double start = 0;     ///< sqrt(r^T z) at the start
  bool solved = false;  ///< false: not positive definite, not finite, or not converged in time
};

/// How well a system has to be solved.
struct LinearEffort {
  double tolerance = 1;  ///< as a fraction of that of the settings
  int iterations = kMostLinearIterations;
};

/// Vectors of a system, all of equal size.
template <class Real>
struct LinearVectors {
  Real* residual;  ///< initially the right-hand side
  Real* solution;  ///< out
  Real *direction, *product, *preconditioned;
  std::size_t count;
};

/// Preconditioned conjugate gradients from zero until sqrt(r^T z) falls to `tolerance` of its
/// initial value or to `enough`.
/// @param most          iterations
/// @param apply         y = A p
/// @param precondition  z approximates A^-1 r; symmetric and positive definite
template <class Real, class Apply, class Precondition>
LinearSolution solve_linear(const LinearVectors<Real>& v, double tolerance, double enough, int most,
                            Apply&& apply, Precondition&& precondition) {
  assert(tolerance > 0 && tolerance < 1 && most > 0);
  assert(v.count > 0 && v.count % static_cast<std::size_t>(kGridMargin) == 0);
  LinearSolution result;
  for (std::size_t n = 0; n < v.count; ++n) v.solution[n] = 0;
  precondition(v.residual, v.preconditioned);
  double rz = dot(v.residual, v.preconditioned, v.count);
  if (!std::isfinite(rz) || rz < 0) return result;
  result.start = std::sqrt(rz);
  const double limit = std::max(tolerance * result.start, enough);
  for (std::size_t n = 0; n < v.count; ++n) v.direction[n] = v.preconditioned[n];
  for (; result.iterations < most; ++result.iterations) {
    stop_point();
    if (std::sqrt(rz) <= limit) {
      result.solved = true;
      return result;
    }
    apply(v.direction, v.product);
    const double curvature = dot(v.direction, v.product, v.count);
    if (!(curvature > 0) || !std::isfinite(curvature)) return result;
    const auto length = static_cast<Real>(rz / curvature);
    add_scaled(length, v.direction, v.solution, v.count);
    add_scaled(-length, v.product, v.residual, v.count);
    precondition(v.residual, v.preconditioned);
    const double next = dot(v.residual, v.preconditioned, v.count);
    if (!std::isfinite(next) || next < 0) return result;
    scale_and_add(static_cast<Real>(next / rz), v.preconditioned, v.direction, v.count);
    rz = next;
  }
  return result;
}

}  // namespace weft
