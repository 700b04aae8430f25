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

// The seed's solver: relaxation of springs as constraints, and XPBD.

namespace weft {

/// Settings of the solver `relaxation`. The defaults are the seed: rigid springs, and as few
/// substeps as the forces allow.
struct RelaxationDef {
  int sweeps = 30;        ///< k, over all springs, per substep; see sweeps_taken
  int substeps = 1;       ///< least per tick; stiff bending or a hand may require more
  double damping = 0.01;  ///< c of the seed's eq. (5), whose tick was one step
  double compliance = 0;  ///< 0: springs are rigid (the seed); 1: as compliant as the fabric (XPBD)
};

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_relaxation(Def& r, Visitor&& visit) {
  visit(FieldInfo{"sweeps", 1, 10000, "",
                  "sweeps over all springs per substep; with compliance raised to an even number"},
        r.sweeps);
  visit(FieldInfo{"substeps", 1, kMostSubsteps, "", "fewest substeps per tick"}, r.substeps);
  visit(FieldInfo{"damping", 0, 0.999, "", "fraction of the motion lost per tick"}, r.damping);
  visit(FieldInfo{"compliance", 0, 1e6, "",
                  "0: rigid springs; 1: those of the fabric in the limit of many substeps and "
                  "sweeps, else softer"},
        r.compliance);
}

/// Whether a sweep of a substep, counted from 0, runs forwards.
constexpr bool runs_forwards(int sweep) {
  return sweep % 2 == 0;
}

/// Sweeps of a substep: with compliance as many each way. There and back they are a symmetric map
/// of the positions, which loses energy. An odd number is none: waves along the direction of a
/// single sweep grow as they travel, and if every other substep began backwards, the strain for the
/// same load would be another each time, and the difference a velocity.
constexpr int sweeps_taken(const RelaxationDef& r) {
  return r.compliance > 0 ? r.sweeps + r.sweeps % 2 : r.sweeps;
}

/// Arrays that live across ticks, so that no step allocates.
template <class Real>
struct RelaxationWorkspace {
  Vec3Array<Real> force;                    ///< of bending, hands, slings and air [N]
  Vec3Array<Real> external;                 ///< of slings and air only [N]
  Vec3Array<Real> wanted;                   ///< displacements of the substep before contact [m]
  std::vector<Real> multiplier;             ///< of each spring, within the substep [N s^2]
  Vec3Array<Real> membrane_multiplier;      ///< of each triangle's strains, likewise [kg m^2]
  std::vector<GridRelaxation<Real>> grids;  ///< for each part the row-wise form of XPBD
  EnergyPass<Real> energy;
  /// In: no particle moves faster than kPlausibleSpeed. Sweeps give back a length at once, so the
  /// shorter the substep, the greater the speed that far-stretched cloth gets from them.
  bool holds_back = false;

  /// Sizes all arrays for a cloth.
  void prepare(const ClothModel<Real>& model);
};

/// Substeps of a tick by the seed's solver (H.-H. Cheng). A substep predicts by eq. (5),
///   x' = x + (1 - c)(x - x_before) + dt^2 f/m,
/// where x - x_before = v dt and f contains gravity, air, hands and bending. Then it sweeps over
/// all springs (Provot 1995) and moves both ends of each by half of the excess length; a pinned end
/// leaves all of it to the other, and unequal masses share it inversely. The sweeps of a substep
/// alternate forwards and backwards, so that the numbering favours no end of the cloth. Finally
/// v = (x' - x) / dt. The variable of the sweeps is the displacement x' - x, so that many small
/// substeps do not lose the velocity in the last bits of the positions.
///
/// With compliance the same sweeps are XPBD (Macklin, Mueller, Chentanez 2016): a spring of
/// stiffness k has compliance/k, and the three strains of a membrane triangle are relaxed together
/// with compliance times the inverse of its tensor (membrane_relaxation.h); on grids they run row
/// by row in colours (grid_relaxation.h).
///
/// @param dt        substep [s]
/// @param substeps  at least one
template <class Real>
AdvanceResult advance_relaxation(const ClothModel<Real>& model,
                                 const Surroundings<Real>& surroundings,
                                 const RelaxationDef& solver, double dt,
                                 const SubstepRange& substeps, Grabs<Real>& grabs,
                                 const Collision<Real>& collision, ClothState<Real>& state,
                                 RelaxationWorkspace<Real>& work, Profile& profile);

}  // namespace weft
