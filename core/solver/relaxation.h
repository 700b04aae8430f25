#pragma once

#include "core/attachments/grabs.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/stability_bound.h"
#include "core/definition.h"
#include "core/forces/energy_pass.h"
#include "core/profile.h"
#include "core/solver/collision.h"
#include "core/solver/grid_relaxation.h"
#include "core/solver/verlet.h"

namespace weft {

/// Settings of the solver `relaxation`. The defaults are the seed: rigid springs, as few substeps
/// as the forces allow.
struct RelaxationDef {
  int sweeps = 30;        ///< k, over all springs, in each substep
  int substeps = 1;       ///< at least so many a tick; stiff bending or a hand may ask for more
  double damping = 0.01;  ///< c of the seed's eq. (5), a substep
  double compliance = 0;  ///< 0: springs are rigid (the seed); 1: as compliant as the fabric (XPBD)
};

/// Describes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_relaxation(Def& r, Visitor&& visit) {
  visit(FieldInfo{"sweeps", 1, 10000, "", "sweeps over all springs a substep"}, r.sweeps);
  visit(FieldInfo{"substeps", 1, kMostSubsteps, "", "fewest substeps a tick"}, r.substeps);
  visit(FieldInfo{"damping", 0, 0.999, "", "part of the motion lost each substep"}, r.damping);
  visit(FieldInfo{"compliance", 0, 1e6, "", "0: rigid springs; 1: as soft as the fabric"},
        r.compliance);
}

/// Arrays that live from tick to tick so that nothing allocates during a step.
template <class Real>
struct RelaxationWorkspace {
  Vec3Array<Real> force;                    ///< of bending, hands and air [N]
  Vec3Array<Real> external;                 ///< of hands and air alone [N]
  Vec3Array<Real> wanted;                   ///< positions before contact, or the way there [m]
  std::vector<Real> multiplier;             ///< of each spring, over the substep [N s^2]
  std::vector<GridRelaxation<Real>> grids;  ///< for each part the row-wise form of XPBD
  EnergyPass<Real> energy;

  /// Sizes all arrays for a cloth.
  void prepare(const ClothModel<Real>& model);
};

/// One tick of the seed's solver (H.-H. Cheng): a substep predicts by eq. (5),
///   x' = x + (1 - c)(x - x_before) + dt^2 f/m,
/// where x - x_before = v dt and f holds gravity, air, hands and bending, and then sweeps over all
/// springs (Provot 1995), moving both ends of each by half of what it is too long or too short;
/// a pinned end leaves all of it to the other, and unequal masses share it inversely. Sweeps run
/// forwards and backwards in turn, so that no end of the cloth is favoured by its numbers. At last
/// v = (x' - x) / dt.
///
/// With compliance the same sweeps are XPBD (Macklin, Mueller, Chentanez 2016): a spring of
/// stiffness k gives way with compliance/k. Their variable is the way x' - x, so that many small
/// substeps do not lose the velocity in the last bits of the positions, and on grids they run row
/// by row in colours (grid_relaxation.h).
///
/// @param dt        substep [s]
/// @param substeps  at least 1
template <class Real>
AdvanceResult advance_relaxation(const ClothModel<Real>& model,
                                 const Surroundings<Real>& surroundings,
                                 const RelaxationDef& solver, double dt, int substeps,
                                 Grabs<Real>& grabs, const Collision<Real>& collision,
                                 ClothState<Real>& state, RelaxationWorkspace<Real>& work,
                                 Profile& profile);

}  // namespace weft
