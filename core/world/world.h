#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/attachments/grabs.h"
#include "core/attachments/gripper.h"
#include "core/attachments/pin_drive.h"
#include "core/attachments/pins.h"
#include "core/cloth/stability_bound.h"
#include "core/contact/colliders/collider_state.h"
#include "core/executor.h"
#include "core/geometry/bvh.h"
#include "core/profile.h"
#include "core/solver/bending_dashpots.h"
#include "core/solver/implicit/implicit.h"
#include "core/solver/relaxation.h"
#include "core/solver/verlet.h"
#include "core/world/bad_starts.h"
#include "core/world/cost.h"
#include "core/world/debug_trees.h"
#include "core/world/energy_account.h"
#include "core/world/energy_balance.h"
#include "core/world/sleep.h"
#include "core/world/still_forces.h"
#include "core/world/world_def.h"

// The world: cloths, objects and everything that acts, advanced tick by tick.

namespace weft {

/// Why a tick had to be taken back.
enum class DivergenceCause : std::uint8_t {
  not_finite,      ///< a position, velocity or energy is NaN or infinite
  too_fast,        ///< a particle moved farther in a substep than its cloth's diagonal
  too_far,         ///< a particle is more than kFarthestFromOrigin from the origin
  energy_runaway,  ///< more energy than before, plus the work done on the cloth
  unsolved,        ///< the implicit solver could not solve a linear system
};

/// The remedy.
enum class DivergenceRemedy : std::uint8_t {
  more_substeps,  ///< the tick was repeated from the last good state with more substeps
  stopped_cloth,  ///< the last good state was restored, with all velocities zero
};

/// A blow-up that was detected and taken back in the same tick.
struct Divergence {
  DivergenceCause cause = DivergenceCause::not_finite;
  DivergenceRemedy remedy = DivergenceRemedy::stopped_cloth;
  std::uint64_t tick = 0;
  Index particle = kNone;  ///< the first faulty one, or the fastest
  double value = 0;        ///< unexplained energy [J], speed [m/s] or distance [m]
  int substeps = 0;        ///< of the last failed attempt
};

std::string describe(const Divergence& divergence);

/// Report of a tick.
struct TickReport {
  std::uint64_t tick = 0;  ///< number of the resulting state; the start is 0
  double time = 0;         ///< simulated [s]
  int substeps = 0;
  Energies energies;   ///< at the end [J]; updated when commands change it between ticks
  double work = 0;     ///< by hands, air, and moving objects and pins [J]
  double brought = 0;  ///< energy added by the scene's disturbances just before [J]
  double largest_strain = 0;
  int damped_substeps = 0;  ///< that the implicit solver repeated by backward Euler
  /// Of the implicit solver, if the scene wants it; verlet steps a tick that it gives up.
  ImplicitStatus implicit = ImplicitStatus::done;
  bool rested = false;  ///< all slept and nothing moved: nothing was computed, no work counted
  /// The tick was ended from outside (stop_signal.h): the state at its start is restored, and all
  /// other fields are as before it.
  bool halted = false;
  std::optional<Divergence> divergence;
  Profile profile;
};

/// Intersection of a ray with the cloth.
struct ClothHit {
  double distance = 0;  ///< along the unit direction [m]
  Index triangle = kNone;
  std::array<double, 3> barycentric = {};
  Vec3d position = Vec3d::Zero();
  Index nearest_particle = kNone;  ///< the corner nearest to the intersection
};

/// Services supplied by the owner. None changes any result.
struct Runtime {
  Executor* executor = nullptr;  ///< runs independent chunks; null: serially
  double (*clock)() = nullptr;   ///< seconds, only for the profile
  MeshStore* meshes = nullptr;   ///< has prepared meshes; null: the world prepares its own
};

/// Cloths with everything that acts on them, advanced tick by tick. Not thread-safe. All functions
/// that change it must be called between steps.
template <class Real>
class World {
 public:
  /// Throws DefinitionError if the definition cannot be built.
  explicit World(const WorldDef& def, const Runtime& runtime = {});

  /// Advances by one tick of 1 / tick_rate seconds. A stop signal of the calling thread ends it
  /// early, with the same result as `halt`. An exception, which no legal scene causes, does the
  /// same and is rethrown.
  const TickReport& step();

  /// Result of a tick that was given up: the state at its start, contact without memory of the
  /// past, and no time passed. The same wherever the tick was ended, so that a log that contains it
  /// can be replayed.
  const TickReport& halt();

  /// Returns to the start: pins as defined, no grabs, tick 0. The environment keeps its settings,
  /// except a wind that the scene itself changes.
  void reset();

  PinId pin(const PinDef& def);
  bool unpin(PinId id);
  /// Several at once, for about the cost of one; ids of none are passed over.
  void unpin(std::span<const PinId> ids);

  /// Sends a pin to a target, with bounded speed and force.
  /// Throws DefinitionError if a field is out of range. False if there is no such pin.
  bool move_pin(PinId id, const PinMove& move);
  /// Fixes a moving pin where it is. False if there is no such pin.
  bool stop_pin(PinId id);

  GrabId grab(const GrabDef& def);
  bool move_grab(GrabId id, const Vec3d& target);
  bool release(GrabId id);

  /// Lets go of a sling and fires it: from the coming tick on, the cloth gets its force for
  /// kSlingSeconds, rounded to ticks.
  /// @returns its impulse [N s]; nothing if there is no such sling
  std::optional<Vec3d> fire(GrabId id);

  /// Sends a collider to a pose, at bounded speed, where it then stays; keyframes no longer move
  /// it. Throws DefinitionError if a field is out of range. False if there is no such collider.
  bool move_collider(std::size_t collider, const MoveDef& move);

  /// Returns a collider to its keyframes; without keyframes it stays where it is. Throws
  /// DefinitionError if it is a gripper's jaw. False if there is no such collider.
  bool release_collider(std::size_t collider);

  /// Throws DefinitionError if a field is out of range. False if there is no such gripper.
  bool command_gripper(std::size_t gripper, const GripperCommand& command);

  /// Throws DefinitionError, without any change, if a field is out of range.
  void set_environment(const EnvironmentDef& environment);

  /// Makes the springs of all cloths `softness` times as stiff as defined, for owners that prefer
  /// fewer substeps to accurate stretch. Survives a reset.
  /// @param softness  kLeastSoftness to 1; DefinitionError otherwise, or if it winds the cloth up
  void set_softness(double softness);
  double softness() const { return softness_; }

  /// The same world with a cloth of another fabric, in motion: positions, velocities, pins, hands
  /// and objects stay, contact forgets the past, and a reset keeps the fabric. This world is
  /// unchanged, so its owner may still refuse the other one, e.g. for its cost. Throws
  /// DefinitionError, naming fabric and cloth as in a scene, if a field is out of range or the
  /// fabric cannot be built on this mesh or takes too many substeps.
  /// @param cloth  its index, below the number of cloths
  std::unique_ptr<World> with_fabric(std::size_t cloth, const FabricDef& fabric) const;

  /// The same world at this moment, with the same runtime: given the same commands it has the same
  /// future, bit for bit, with everything that contact and solvers remember. Neither changes the
  /// other, and each outlives the other.
  std::unique_ptr<World> fork() const;

  /// Takes `factor` times the substeps that it would take, from the coming tick on: for repetitions
  /// that measure a run's error in time (run_error.h). The hash leaves it out.
  /// @param factor  1 to kMostRefinement
  void refine_substeps(int factor);

  /// First triangle of the cloth that the ray meets, from either side.
  /// @param direction  of any length but zero
  /// Throws DefinitionError if the ray is not finite or has no direction.
  std::optional<ClothHit> pick(const Vec3d& origin, const Vec3d& direction) const;

  /// Hash of everything besides the definition that determines the future: positions, velocities,
  /// pins, grabs, poses of moving colliders, changed environment, softness and fabrics, tick.
  /// Excludes the tick while all cloths sleep.
  std::uint64_t hash() const;
  /// The hash before the tick that runs. Callable at stop points of `step` alone, where the present
  /// state is that of half a tick.
  std::uint64_t hash_before_tick() const;

  /// Deepest penetration of a particle or edge into a collider [m]; 0 if none.
  double deepest_penetration() const;

  /// Starts about which nothing is promised, in words; empty as soon as all are clear.
  std::vector<std::string> bad_starts() const;
  /// Number of pairs about which nothing is promised; see BadStarts.
  std::size_t open_pairs() const;
  /// Bad starts that the coming tick would find and leave, without further commands: a world at its
  /// start has not been checked yet. Works on a copy, as `coming_reactions` does, and may throw the
  /// same.
  ComingStarts coming_bad_starts() const;

  /// Switches measuring contacts and forces in each tick; changes no result. `reactions` returns
  /// what the last tick measured until the next one ends; of cloth that sleeps its StillForces.
  void measure_forces(bool wanted);
  /// Looks one tick ahead, once, if forces are wanted and no tick has measured them since the state
  /// was set: `reactions` then returns those of `coming_reactions`.
  void measure_present_forces();
  /// Those of the last tick if they were measured in it, else of the coming one; null if unknown.
  const Reactions* reactions() const { return supports_.told ? &*supports_.told : nullptr; }
  /// Those of the coming tick without further commands. Works on a copy of the world: costs a tick
  /// and more memory than the world itself, and changes nothing. Throws Stopped if that tick was
  /// ended from outside, as do its two callers.
  Reactions coming_reactions() const;

  /// Switches measuring the work of everything that acts, from the present state on; changes no
  /// result. A tick then takes longer: half as long again in `flag`. A reset begins anew.
  void measure_energy(bool wanted);
  /// Null if it is not measured.
  const EnergyBalance* energy_balance() const { return energy_ ? &energy_->balance : nullptr; }

  /// Size of the cloth's state, its checkpoint and the arrays of `verlet` [B]. Arrays for air and
  /// hands count from their first use on.
  std::size_t solver_bytes() const;

  /// Boxes of one level of one of the seed's trees around the present state; see debug_trees.h.
  /// Throws DefinitionError if there is no such tree, and if the level is negative.
  std::vector<Aabb<float>> debug_boxes(const std::string& tree, int level);
  std::vector<std::string> debug_tree_names();
  int debug_tree_levels(const std::string& tree);

  /// Estimated cost of a tick without contact, from the present state in this environment, by its
  /// own solver or by a given one; see check_cost.
  TickCost cost_in(const EnvironmentDef& environment) const;
  TickCost cost_of(SolverKind kind, const EnvironmentDef& environment) const;

  /// As built: the jaws of grippers are its last colliders.
  const WorldDef& def() const { return def_; }
  const EnvironmentDef& environment() const { return environment_; }
  const ClothModel<Real>& model() const { return model_; }
  const ClothState<Real>& state() const { return state_; }
  /// Means over the last tick: displacements over its length [m/s]. They show whether cloth rests;
  /// velocities at the end of a tick include the fastest vibration of stiff cloth. Before the first
  /// tick, and after one that was halted, those of the state.
  Vec3Array<Real> mean_velocities() const;
  /// For repetitions and tests that move the cloth; call `accept_state` afterwards.
  ClothState<Real>& state() { return state_; }
  /// Accepts the present state as the one to return to.
  void accept_state();
  const Pins& pins() const { return pins_; }
  const Grabs<Real>& grabs() const { return grabs_; }
  /// Results of the scene's textile test now; see diagnostics/measurements.h.
  std::vector<NamedNumber> measurements() const;
  /// Index of the scene's hand that holds by this grab, if there is one.
  std::optional<std::size_t> scene_hand(GrabId id) const;
  const ColliderStates& colliders() const { return colliders_; }
  const std::vector<Gripper>& grippers() const { return grippers_; }
  const TickReport& report() const { return report_; }
  const Contact<Real>& contact() const { return contact_.objects; }
  /// Contact of cloths with themselves and each other; null without it.
  const ClothGuard<Real>* guard() const { return contact_.guard ? &*contact_.guard : nullptr; }
  /// Which cloths sleep, if the scene permits it (SleepDef); what acts on a cloth wakes it.
  const Sleep<Real>& sleep() const { return sleep_; }
  std::uint64_t tick() const { return tick_; }
  double tick_seconds() const { return 1 / def_.tick_rate; }

 private:
  /// A hand of the scene while it holds.
  struct SceneHand {
    GrabId grab = 0;  ///< 0: not holding
    Vec3d start = Vec3d::Zero();
  };

  World(const World&) = default;
  World copy() const;
  void take_reactions();
  void hold_present_state();
  void apply_disturbance(const DisturbanceDef& disturbance, std::uint64_t seed);
  void gather(double radius, std::uint64_t seed);
  void run_script();
  void finish_pins();
  PinId hold(const PinDef& def);
  void renew_clamps();
  void restore_hinges(std::size_t part);
  void refuse_jaw(std::size_t collider) const;
  void turn_wind(const Vec3d& wind);
  void take_fabric(std::size_t cloth, const FabricDef& fabric);
  void build_contact();
  void masses_changed();
  void sleep_changed();
  void wake(Index particle);
  void wake_held(PinId id);
  void wake_all();
  void rouse_sleepers();
  bool rests() const;
  const TickReport& rest();
  void put_to_sleep();
  int choose_substeps(SolverKind kind) const { return choose_substeps(kind, environment_); }
  int choose_substeps(SolverKind kind, const EnvironmentDef& environment) const;
  long substeps_for_hands(SolverKind kind, const EnvironmentDef& environment, long cloth_alone,
                          int fewest) const;
  void refuse_too_stiff() const;
  void prepare_solver();
  void allocate_external();
  StabilityBound stability_bound(const ClothPart<Real>& part, SolverKind kind,
                                 const EnvironmentDef& environment) const;
  void sample_surroundings();
  void keep_checkpoint();
  void go_back();
  void begin_tick();
  void plan_targets();
  void finish_targets();
  void end_tick();
  void watch_swing();
  bool leaves_to_verlet(const AdvanceResult& result, int substeps);
  void advance_or_recover(int substeps);
  AdvanceResult advance(SolverKind kind, int substeps);
  AdvanceResult advance_some(SolverKind kind, double dt, const SubstepRange& substeps);
  void damp_bending(SolverKind kind, double dt, const SubstepRange& after, AdvanceResult& result);
  Collision<Real> collision();
  std::optional<Divergence> examine(const AdvanceResult& result, SolverKind kind,
                                    int substeps) const;
  void restore_last_good();
  void forget_motion();
  void report_present_state();
  void report_motion();
  void begin_balance();

  WorldDef def_;
  EnvironmentDef environment_;
  Runtime runtime_;
  ClothModel<Real> model_;
  double softness_ = 1;
  std::vector<FabricDef> scene_fabrics_;  ///< of each cloth, as the scene defined it
  int refinement_ = 1;                    ///< factor on the substeps
  ClothState<Real> state_;
  struct Motion {
    Vec3Array<Real> x, v;
  };
  Motion last_good_;  ///< at the end of the last good tick
  Pins pins_;
  PinDrive<Real> pin_drive_;
  Grabs<Real> grabs_;
  ColliderStates colliders_;
  std::vector<Gripper> grippers_;
  std::vector<SceneHand> scene_hands_;
  double thickest_ = 0;  ///< cloth [m]
  Surroundings<Real> surroundings_;
  /// Contact with objects, and of cloths with themselves and each other, in the chosen model.
  struct Contacts {
    Contact<Real> objects;
    std::optional<SeedContact<Real>> seed;  ///< if chosen; does both
    std::optional<ClothGuard<Real>> guard;  ///< of cloths, if chosen
  };
  Contacts contact_;
  /// Arrays and memory of the solvers. Verlet also steps the ticks that implicit gives up.
  struct Solvers {
    VerletWorkspace<Real> verlet;
    RelaxationWorkspace<Real> relaxation;
    ImplicitWorkspace<Real> implicit;
    BendingDashpots<Real> dashpots;
    bool touching = false;  ///< with `implicit`: something touched when the last tick ended
  };
  Solvers solvers_;
  EnergyAccount account_;
  Sleep<Real> sleep_;
  /// State at the start of the running tick, for `go_back`.
  struct Checkpoint {
    ClothState<Real> state;
    Pins pins;
    Grabs<Real> grabs;
    ColliderStates colliders;
    std::vector<Gripper> grippers;
    std::vector<SceneHand> scene_hands;
    Vec3d wind = Vec3d::Zero(), gusts_ahead = Vec3d::Zero();
    EnergyAccount account{0};
    EnergyBalance balance;             ///< if it is measured
    std::optional<Sleep<Real>> sleep;  ///< if the scene lets cloth sleep
    TickReport report;
  };
  Checkpoint checkpoint_;
  std::optional<DebugTrees<Real>> debug_trees_;  ///< made at the first request
  Bvh<Real> pick_tree_;  ///< over the triangles at rest; refitted for each pick
  TickReport report_;
  std::uint64_t tick_ = 0;
  struct Supports {  ///< forces of what holds the cloth
    bool wanted = false;
    HeldForces<Real> held;          ///< of the running tick, if they are wanted
    StillForces still;              ///< of cloth that sleeps, if they are wanted
    std::optional<Reactions> told;  ///< of the last tick, or the coming one
  };
  Supports supports_;
  Swing swing_;                               ///< of the strip, if the scene is a decay test
  std::optional<EnergyLedger<Real>> energy_;  ///< if it is measured
};

extern template class World<float>;
extern template class World<double>;

}  // namespace weft
