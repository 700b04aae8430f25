#pragma once

#include <cstddef>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/executor.h"
#include "core/math/aligned_vector.h"
#include "core/profile.h"
#include "core/solver/dashpot_kernels.h"
#include "core/solver/dashpot_passes.h"
#include "core/solver/held_forces.h"

// Dashpots of quadratic bending, which act between substeps.

namespace weft {

/// Dashpots of quadratic bending, which act a few times in a tick (dashpot_passes.h). A stencil's
/// value c = sum w x is damped along the cloth's normal N at its place: b = N . c, the curvature,
/// is a function of the positions that no motion of the whole changes, and its dashpot's force on a
/// particle is -tau k db/dt times the gradient of b there. So momentum and angular momentum are
/// kept. (Along c itself a flat cloth would be damped in whatever direction the strains in its
/// plane give c; along all of dc/dt a bent cloth would resist turning as a whole.)
///
/// Over the time D since the last pass they solve dv/dt = -M^-1 K v, K = sum tau k g g^T, by a
/// stabilised explicit method: the second order one of Runge, Kutta and Legendre (Meyer, Balsara,
/// Aslam 2014, eqs. 16 to 18). Its s stages are stable for D rho <= (s^2 + s - 2) / 2 with rho the
/// largest rate, so their number grows as the root of the relaxation time, where substeps grow as
/// itself. Slow modes decay by tau omega^2, to second order in D tau omega^2; the fastest lose half
/// of their velocity in a pass.
template <class Real>
class BendingDashpots {
 public:
  /// Lists the stencils of all parts that damp bending. Call again when bending changed.
  void prepare(const ClothModel<Real>& model);

  bool empty() const { return parts_.empty(); }

  /// When they act in a tick of so many seconds: as the part needs that needs most.
  DashpotPasses passes(const ClothModel<Real>& model, double seconds) const;
  /// Most stages that a part takes over some time [s]: odd, at least 3; 0 if no part damps bending.
  int stages(const ClothModel<Real>& model, double seconds) const;
  /// Longest relaxation time that a part may have [s]: with kMostDashpotStages.
  double longest_time(const ClothModel<Real>& model, std::size_t part, double seconds) const;
  /// Estimated work of a tick of so many seconds, in updates of a particle by the springs of a grid
  /// [1], of the part that takes most.
  double updates(const ClothModel<Real>& model, double seconds) const;

  /// Damps the velocities of all parts that are awake, over some time. Throws Stopped.
  /// @param seconds   positive
  /// @param held      receives the impulses on fixed particles; may be null
  /// @param executor  runs bands of particles on its threads; may be null, with the same result
  void act(const ClothModel<Real>& model, double seconds, ClothState<Real>& state,
           HeldForces<Real>* held, Executor* executor, Profile& profile);

 private:
  /// Consecutive particles, which one thread works on. A batch on a border is evaluated by all
  /// bands that it touches, and each adds to its own particles: in the same order, whatever the
  /// bands are.
  struct Band {
    std::size_t first = 0, end = 0;  ///< of its particles
    std::vector<DashpotRun> shares;  ///< its share of all batches, by family
    /// Batches that touch it, by family, ascending.
    std::vector<std::vector<DashpotRun>> touching;
  };
  struct Part {
    std::size_t number = 0;
    std::vector<DashpotFamily<Real>> families;
    std::size_t stencils = 0;
    bool planar = false;      ///< a grid, whose vectors are in planes (dashpot_groups.h)
    Band whole;               ///< all particles
    std::vector<Band> bands;  ///< the same in several; empty if that is not worth it

    /// Where component k of a particle's vectors is.
    std::size_t at(std::size_t particle, std::size_t k) const {
      if (!planar) return 4 * particle + k;
      return 4 * whole.first + k * (whole.end - whole.first) + (particle - whole.first);
    }
  };

  void divide(Part& part) const;
  void load(const Part& part, const Band& band, const Vec3Array<Real>& from);
  void begin(const Part& part, const Band& band, const ClothState<Real>& state);
  void multiply(Part& part, const Band& band, AlignedVector<Real>& product);
  void open(Part& part, const Band& band, Real by_start);
  void advance(Part& part, const Band& band, const StageFactors<Real>& by);
  void aim(Part& part, Executor* executor, const Vec3Array<Real>& x);
  void pass(Part& part, int stages, Real seconds, Executor* executor, ClothState<Real>& state);
  Vec3<Real> impulse_on(const Part& part, std::size_t particle) const;
  StageNumbers<Real> numbers();

  std::vector<Part> parts_;
  // Four numbers for each particle:
  AlignedVector<Real> inverse_mass_;  ///< for each number [1/kg]
  AlignedVector<Real> start_;         ///< K times the velocities at the start [N]
  AlignedVector<Real> now_, before_;  ///< impulses after a stage and the one before it [N s]
  /// Velocities, and then how far they change by these, for this stage and the next one [m/s].
  AlignedVector<Real> change_, next_change_;
  AlignedVector<Real> product_;  ///< K times these [N]
};

extern template class BendingDashpots<float>;
extern template class BendingDashpots<double>;

}  // namespace weft
