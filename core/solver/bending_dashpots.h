#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/math/quad.h"
#include "core/profile.h"
#include "core/solver/held_forces.h"

// Dashpots of quadratic bending, which act between ticks.

namespace weft {

/// Dashpots of quadratic bending between two ticks. A stencil's value c = sum w x is damped along
/// the cloth's normal N at its place: b = N . c, the curvature, is a function of the positions that
/// no motion of the whole changes, and its dashpot's force on a particle is -tau k db/dt times the
/// gradient of b there. So momentum and angular momentum are kept. (Along c itself a flat cloth
/// would be damped in whatever direction the strains in its plane give c; along all of dc/dt a bent
/// cloth would resist turning as a whole.)
///
/// Over a tick of length D they solve dv/dt = -M^-1 K v, K = sum tau k g g^T, by a stabilised
/// explicit method: the second order one of Runge, Kutta and Legendre (Meyer, Balsara, Aslam 2014,
/// eqs. 16 to 18). Its s stages are stable for D rho <= (s^2 + s - 2) / 2 with rho the largest
/// rate, so their number grows as the root of the relaxation time, where substeps grow as itself.
/// Slow modes decay by tau omega^2, to second order in D tau omega^2; the fastest lose half of
/// their velocity in a tick.
template <class Real>
class BendingDashpots {
 public:
  /// Lists the stencils of all parts that damp bending. Call again when bending changed.
  void prepare(const ClothModel<Real>& model);

  bool empty() const { return parts_.empty(); }

  /// Most stages that a part takes over some time [s]: odd, at least 3; 0 if no part damps bending.
  int stages(const ClothModel<Real>& model, double seconds) const;
  /// Estimated work, in updates of a particle by the springs of a grid [1], of the part that takes
  /// most.
  double updates(const ClothModel<Real>& model, double seconds) const;

  /// Damps the velocities of all parts that are awake, over some time. Throws Stopped.
  /// @param seconds  positive
  /// @param held     receives the impulses on fixed particles; may be null
  void act(const ClothModel<Real>& model, double seconds, ClothState<Real>& state,
           HeldForces<Real>* held, Profile& profile);

 private:
  /// Stencils of a part, one behind the other. Particles are those of the model.
  struct Part {
    std::size_t number = 0;
    std::vector<std::size_t> begin;  ///< of each one's particles, and the last one's end
    std::vector<Index> particles;
    std::vector<Real> weights;    ///< of each particle; 0 if it only defines the normal
    std::vector<Real> viscosity;  ///< tau k of each stencil
    /// Places in each stencil's list: the normal is that of the lines from the first to the second
    /// and from the third to the fourth.
    std::vector<std::array<std::size_t, 4>> plane;
  };

  void list(const ClothModel<Real>& model, const ClothPart<Real>& part, Part& list) const;
  void aim(const Part& part, const Vec3Array<Real>& x);
  void multiply(const Part& part, const QuadArray<Real>& v, QuadArray<Real>& product) const;
  void pass(const Part& part, const IndexRange& range, int stages, Real seconds,
            const ClothState<Real>& state);

  std::vector<Part> parts_;
  QuadArray<Real>
      gradient_;  ///< of b sqrt(tau k) at each particle of each stencil of the present part
  // Of each particle:
  QuadArray<Real> start_;         ///< K times the velocities at the start [N]
  QuadArray<Real> now_, before_;  ///< impulses after a stage and the one before it [N s]
  QuadArray<Real> change_;        ///< velocities, and then how far they change by these [m/s]
  QuadArray<Real> product_;       ///< K times these [N]
};

extern template class BendingDashpots<float>;
extern template class BendingDashpots<double>;

}  // namespace weft
