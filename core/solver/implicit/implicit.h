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
#include "core/solver/implicit/element_system.h"
#include "core/solver/implicit/grid_system.h"
#include "core/solver/verlet.h"

namespace weft {

/// Settings of the solver `implicit`.
struct ImplicitDef {
  int substeps = 1;         ///< a tick; where the cloth can meet anything, at least
                            ///< kFewestInContact
  int iterations = 2;       ///< of Newton's method a substep; one is 2 to 30 % off on stiff cloth
  double tolerance = 0.02;  ///< of each linear system, as a part of what it begins with
};

/// Substeps a tick at the least where there is anything to meet: contact acts between them, and
/// what holds the cloth is not part of its equations.
inline constexpr int kFewestInContact = 4;

/// Describes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_implicit(Def& s, Visitor&& visit) {
  visit(FieldInfo{"substeps", 1, kMostSubsteps, "", "fewest substeps a tick"}, s.substeps);
  visit(FieldInfo{"iterations", 1, 20, "", "of Newton's method a substep"}, s.iterations);
  visit(FieldInfo{"tolerance", 1e-10, 0.5, "", "of each linear system, relative"}, s.tolerance);
}

/// What a live hand adds to the linear system: stiffness (sum w x) w.
template <class Real>
struct HandTerm {
  std::size_t grab = 0;                            ///< its number in the list
  std::size_t part = 0;                            ///< of the model, that it holds
  Real stiffness = 0;                              ///< [N/m]
  std::vector<std::array<std::size_t, 3>> places;  ///< of the held particles in a vector
  std::vector<Real> weights;                       ///< 0 of pinned ones
};

/// Arrays that live from tick to tick.
template <class Real>
struct ImplicitWorkspace {
  using System = std::variant<GridSystem<Real>, ElementSystem<Real>>;

  std::vector<System> systems;  ///< of each part
  EnergyPass<Real> energy;
  Vec3Array<Real> way, x, v;                     ///< of the substep, and where and how fast it ends
  Vec3Array<Real> force, air;                    ///< [N]
  Vec3Array<Real> last_way, last_v;              ///< of the substep before
  Vec3Array<Real> end_x, end_v;                  ///< at the end of the tick before
  Vec3Array<Real> start_x, start_v;              ///< of a substep that is gone in pieces
  std::vector<char> history;                     ///< of each particle: whether that substep counts
  std::vector<Real> inertia;                     ///< see NewtonPoint
  std::vector<SymmetricBlock<Real>> air_blocks;  ///< see NewtonPoint
  std::vector<HandTerm<Real>> hands;             ///< the first hand_count of them
  std::size_t hand_count = 0;
  std::vector<double> starts;  ///< of each part's first linear system of a substep
  GridVector<Real> residual, step, direction, product, preconditioned;
  double last_dt = 0;         ///< [s]; 0: no history
  double credit = 0;          ///< energy that was lost not long ago, and may come back [J]
  bool unsolved = false;      ///< a linear system of the last tick found no solution
  bool refuses = false;       ///< the coming tick ends where it is violent or touches
  bool violent = false;       ///< the last tick ended as it was
  bool touching = false;      ///< the last tick ended as something touched
  double violent_energy = 0;  ///< below which nothing is [J]
  double far_way = 0;         ///< see goes_far() [m]

  void prepare(const ClothModel<Real>& model);

  /// The coming substep begins anew: what came before it is not its past.
  void forget();
};

/// One tick of the implicit solver: BDF2 with a few Newton iterations and conjugate gradients,
/// on grids with multigrid as preconditioner (multigrid.h),
///   v' = (3x' - 4x + x_before) / 2h,   M (3v' - 4v + v_before) / 2h = f(x', v') - alpha M v',
/// or backward Euler where the substep before does not count: at the start, for who was stopped or
/// pushed by contact, pins or anybody between ticks, and after a change of the substep. Springs,
/// dashpots, bending, air, drag and hands are all taken at the substep's end, so no stiffness
/// bounds the substep. The matrix is kept positive definite: the forces are exact, their
/// derivatives are not all (linear_terms.h). Contact corrects the mean velocities of a substep.
///
/// A substep that ends with more energy than there was and than hands and air brought, or whose
/// linear systems are not solved, is gone again by backward Euler in 1, 2, 4 ... pieces, which
/// AdvanceResult::damped_substeps tells. A substep is violent that brings or loses a
/// tenth of the energy of a cloth that is fast and stretched far: in one long step the waves in it
/// are lost, and it comes to rest in tucks that they would have shaken out. And as contact acts
/// after the linear systems, what it holds gives way for a whole substep to what pulls at it;
/// friction, which lives on the pressure, then lets a strip slip over a bar that should hold it.
/// Nor can cloth be kept off cloth whose particles go far beside each other in one step. Where
/// `refuses` is set, ticks end at each of these for somebody else to go them.
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
