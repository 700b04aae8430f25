#pragma once

#include <variant>
#include <vector>

#include "core/attachments/grabs.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/stability_bound.h"
#include "core/definition.h"
#include "core/forces/energy_pass.h"
#include "core/profile.h"
#include "core/solver/collision.h"
#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/element_system.h"
#include "core/solver/implicit/grid_system.h"
#include "core/solver/implicit/status.h"
#include "core/solver/verlet.h"

// The implicit solver.

namespace weft {

/// Settings of the solver `implicit`.
struct ImplicitDef {
  int substeps = 1;         ///< per tick; at least kFewestInContact if the cloth can meet anything
  int iterations = 2;       ///< of Newton's method per substep; one is 2 to 30 % off on stiff cloth
  double tolerance = 0.02;  ///< of each linear system, relative to its initial residual
};

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_implicit(Def& s, Visitor&& visit) {
  visit(FieldInfo{"substeps", 1, kMostSubsteps, "", "fewest substeps per tick"}, s.substeps);
  visit(FieldInfo{"iterations", 1, 20, "", "iterations of Newton's method per substep"},
        s.iterations);
  visit(FieldInfo{"tolerance", 1e-10, 0.5, "", "relative tolerance of each linear system"},
        s.tolerance);
}

/// Contribution of a live hand to the linear system: stiffness (sum w x) w.
template <class Real>
struct HandTerm {
  std::size_t grab = 0;                            ///< its index in the list
  std::size_t part = 0;                            ///< the held part of the model
  Real stiffness = 0;                              ///< [N/m]
  std::vector<std::array<std::size_t, 3>> places;  ///< of the held particles in a vector
  std::vector<Real> weights;                       ///< 0 for pinned ones
  Vec3d given = Vec3d::Zero();                     ///< to the cloth in this substep [N s]
};

/// Positions [m] and velocities [m/s] of one instant.
template <class Real>
struct Instant {
  Vec3Array<Real> x, v;
};

/// Arrays that live across ticks.
template <class Real>
struct ImplicitWorkspace {
  using System = std::variant<GridSystem<Real>, ElementSystem<Real>>;

  std::vector<System> systems;  ///< of each part
  EnergyPass<Real> energy;
  Vec3Array<Real> displacement, x, v;         ///< displacement, final positions and velocities
  Vec3Array<Real> start_near, near;           ///< positions at start and end from near the part [m]
  Vec3Array<Real> force, air;                 ///< [N]
  Vec3Array<Real> last_displacement, last_v;  ///< of the previous substep
  Instant<Real> last_end;                     ///< at the end of the previous tick
  Instant<Real> start;                        ///< of a divided substep
  std::vector<char> history;  ///< per particle: whether last_displacement and last_v count
  std::vector<Real> inertia;  ///< see NewtonPoint
  std::vector<SymmetricBlock<Real>> air_blocks;  ///< see NewtonPoint
  std::vector<HandTerm<Real>> hands;             ///< the first hand_count are valid
  std::size_t hand_count = 0;
  std::vector<double> starts;  ///< of each part's first linear system in a substep
  GridVector<Real> residual, step, direction, product, preconditioned;
  double last_dt = 0;    ///< [s]; 0: no history
  double credit = 0;     ///< recently lost energy that may return [J]
  bool refuses = false;  ///< the coming tick ends if it is violent or touches
  ImplicitStatus status = ImplicitStatus::done;  ///< of the last tick
  double violent_energy = 0;                     ///< least energy of a violent substep [J]
  double far_displacement = 0;                   ///< see moves_far() [m]

  void prepare(const ClothModel<Real>& model);

  /// Call when something has changed the velocities after a tick. Those of the previous substep
  /// change by as much, so that the history stays valid.
  void take_over(const Vec3Array<Real>& velocities);

  /// Makes the coming substep independent of the previous one.
  void forget();
};

/// One tick of the implicit solver: BDF2 with a few Newton iterations and conjugate gradients, on
/// grids preconditioned by multigrid (multigrid.h),
///   v' = (3x' - 4x + x_before) / 2h,   M (3v' - 4v + v_before) / 2h = f(x', v') - alpha M v',
/// or backward Euler where the previous substep does not count: at the start, for particles that
/// contact or pins stopped or pushed, or that moved between ticks, and after a change of the
/// substep. Springs, dashpots, bending, air, damping and hands all act at the substep's end, so no
/// stiffness bounds the substep. The matrix is kept positive definite: the forces are exact, some
/// of their derivatives are not (linear_terms.h). Contact corrects the mean velocities of a
/// substep.
///
/// A substep that ends with more energy than it had and received from hands and air, or whose
/// linear systems are not solved, is repeated by backward Euler in 1, 2, 4 ... pieces;
/// AdvanceResult::damped_substeps counts these. A substep is violent if it adds or loses a tenth of
/// the energy of a fast and strongly stretched cloth: one long step damps the waves in it, and it
/// comes to rest in tucks that they would have shaken out. Nor does a long step suit contact.
/// Because contact acts after the linear systems, held cloth yields for a whole substep to the
/// forces on it; friction, which depends on the pressure, then lets a strip slip over a bar that
/// should hold it. And cloth cannot be kept off cloth whose particles move far relative to each
/// other in one step. If `refuses` is set, ticks end at each of these, for another solver to step
/// them.
///
/// @param dt        substep [s]
/// @param substeps  at least 1
template <class Real>
AdvanceResult advance_implicit(const ClothModel<Real>& model,
                               const Surroundings<Real>& surroundings, const ImplicitDef& solver,
                               double dt, int substeps, Grabs<Real>& grabs,
                               const Collision<Real>& collision, ClothState<Real>& state,
                               ImplicitWorkspace<Real>& work, Profile& profile);

}  // namespace weft
