#pragma once

#include <cassert>
#include <optional>

#include "core/attachments/grabs.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/stability_bound.h"
#include "core/definition.h"
#include "core/diagnostics/energies.h"
#include "core/forces/force_pass.h"
#include "core/forces/grid_pass.h"
#include "core/forces/mesh_pass.h"
#include "core/profile.h"
#include "core/solver/blow_up.h"
#include "core/solver/collision.h"

// The explicit solver, and types shared by all solvers.

namespace weft {

/// The solver that moves the cloth.
enum class SolverKind {
  automatic,   ///< that of the world's model: verlet for weft, relaxation for the seed
  verlet,      ///< springs as forces, leapfrog
  relaxation,  ///< springs as constraints, relaxed in sweeps (relaxation.h)
  implicit,    ///< springs as forces at the substep's end, BDF2 (implicit/implicit.h)
};

/// Choice of the solver, and settings of `verlet`.
struct SolverDef {
  SolverKind kind = SolverKind::automatic;
  int min_substeps = 1;    ///< least per tick; the stability rule may require more
  int damping_sweeps = 1;  ///< 1: dashpots see the velocity of half a substep ago (first order in
                           ///< the dashpot term); 2 and more: fixed-point sweeps, second order
};

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_solver(Def& s, Visitor&& visit) {
  visit(choice("kind", "automatic|verlet|relaxation|implicit", "automatic: by the model"), s.kind);
  visit(FieldInfo{"min_substeps", 1, kMostSubsteps, "", "fewest substeps per tick of verlet"},
        s.min_substeps);
  visit(FieldInfo{"damping_sweeps", 1, 10, "", "fixed-point sweeps on the dashpots"},
        s.damping_sweeps);
}

/// The substeps of a tick that one call of a solver makes: all of them, or those between two passes
/// of the dashpots of bending. Each call ends with positions and velocities of one instant.
struct SubstepRange {
  int first = 0, end = 1;  ///< of `all`
  int all = 1;             ///< of the tick

  int count() const { return end - first; }
  bool opens() const { return first == 0; }
  bool closes() const { return end == all; }
};

/// External influences on the cloth during one tick.
template <class Real>
struct Surroundings {
  Vec3<Real> gravity = Vec3<Real>::Zero();  ///< [m/s^2]
  double damping = 0;                       ///< alpha [1/s]
  bool air = false;                         ///< whether air forces are computed
  double air_density = 0;                   ///< [kg/m^3]
  Vec3Array<Real> wind;                     ///< at each particle [m/s]; only if `air`
  Vec3d gusts_ahead = Vec3d::Zero();        ///< of where the mean wind alone carries them [m]
};

/// Result of some substeps of a solver.
struct AdvanceResult {
  Energies before;            ///< if these open the tick
  Energies after;             ///< if they close it
  double work = 0;            ///< of hands and air [J]
  double largest_strain = 0;  ///< at the end of the tick
  int damped_substeps = 0;    ///< that `implicit` had to repeat by backward Euler
  /// Why the tick ended early; then only `before` above is valid.
  std::optional<BlowUp> blow_up;
};

/// Arrays that live across ticks, so that no step allocates.
template <class Real>
struct VerletWorkspace {
  // These are empty if all parts are kicked in one pass with their forces; `external` is still
  // needed for sling impulses, and for air on parts that are not grids.
  Vec3Array<Real> internal;  ///< forces of springs and bending [N]
  Vec3Array<Real> external;  ///< forces of sling impulses and air [N]
  Vec3Array<Real> velocity;  ///< estimate of the velocity for the dashpots [m/s]
  /// Of positions of meshes: lost by this tick's drifts to rounding [m].
  Vec3Array<Real> remainder;
  std::optional<ElasticEnergy> elastic;  ///< at the present positions, if known; reset it when
                                         ///< other code moves the cloth
  std::vector<std::optional<ElasticEnergy>> at_rest;  ///< of each sleeping part, once known
  std::vector<GridPass<Real>> grids;                  ///< row-wise form of each part, if it fits
  std::vector<MeshPass<Real>> meshes;  ///< gathering form of each other part, if it fits
  bool all_grids = false;              ///< every part fits as a grid
  std::uint64_t loaded_paths = 0;      ///< number of the CalmPaths loaded into the grids; 0: none
  Executor* executor = nullptr;        ///< runs bands of large grids on its threads

  /// Sizes the arrays for a cloth without air and sling impulses.
  /// @param threads  may be null
  void prepare(const ClothModel<Real>& model, const SolverDef& solver, Executor* threads);

  /// Sizes the additional arrays for air and sling impulses. Call before a tick that has them.
  void allocate_external(const ClothModel<Real>& model, bool air, bool impulses);

  /// Sizes the arrays for steps without contact, in a world with a guard (fused_steps.h).
  void allocate_paths();

  /// Loads these paths into the grids, unless they are loaded.
  void load_paths(const CalmPaths<Real>& paths);

  /// Whether a part is kicked in one pass with its forces, without sweeps.
  bool kicks_at_once(const ClothModel<Real>& model, std::size_t part) const {
    assert(part < grids.size() && part < meshes.size());
    const ClothPart<Real>& cloth = model.parts[part];
    const bool more =
        cloth.hinges.count > 0 || cloth.locks.count > 0 || !cloth.rest_curves.triangles.empty();
    return grids[part].fits() || (meshes[part].fits() && !more);
  }

  /// Size of the arrays [B].
  std::size_t bytes() const;
};

/// Leapfrog over substeps of a tick (Verlet 1967), with half a kick at their start and their end,
/// so that positions and velocities are synchronous then. Velocity is a separate variable, because
/// position-only Verlet loses float precision at small steps; positions are summed with what
/// rounding took from them in the same tick (drift-inl.h), as slow cloth with many substeps would
/// stand still. Damping is split exactly: v
/// <- [v (1 - a dt/2) + dt f/m]/(1 + a dt/2). Contact corrects the velocities between each kick and
/// drift; the seed's contact also corrects positions after it.
///
/// @param dt        substep [s], stable by stability_bound.h
/// @param substeps  at least one
template <class Real>
AdvanceResult advance_verlet(const ClothModel<Real>& model, const Surroundings<Real>& surroundings,
                             const SolverDef& solver, double dt, const SubstepRange& substeps,
                             Grabs<Real>& grabs, const Collision<Real>& collision,
                             ClothState<Real>& state, VerletWorkspace<Real>& work,
                             Profile& profile);

}  // namespace weft
