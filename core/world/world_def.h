#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/attachments/gripper.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_def.h"
#include "core/contact/colliders/collider.h"
#include "core/contact/seed/seed_contact.h"
#include "core/diagnostics/measurements.h"
#include "core/forces/air/environment.h"
#include "core/solver/implicit/implicit.h"
#include "core/solver/relaxation.h"
#include "core/solver/verlet.h"
#include "core/world/budget.h"
#include "core/world/script.h"
#include "core/world/sleep.h"
#include "core/world/start.h"
#include "core/world/view_def.h"

// Definition of a world: a scene.

namespace weft {

inline constexpr std::size_t kMostCloths = 64;

/// The set of components of a world, unless they are chosen individually.
enum class Model {
  weft,  ///< the best available
  seed,  ///< that of H.-H. Cheng, "Interactive Cloth Simulation": the baseline
};

/// The contact that keeps the cloth off objects and itself.
enum class ContactModel {
  automatic,  ///< that of the world's model
  certified,  ///< `weft`: certified planes (contact.h): nothing passes through
  seed,       ///< proximity and impulses (seed_contact.h)
};

/// Choice of the contact, and settings of the seed's.
struct CollisionDef {
  ContactModel model = ContactModel::automatic;
  SeedContactDef seed;
};

/// A scene: everything needed to start a world. Built-in scenes come from core/scenes.
struct WorldDef {
  std::string name = "unnamed";
  std::string description;      ///< one sentence on what to look at
  std::optional<ViewDef> view;  ///< where it is best looked at from; absent: the viewer chooses
  Model model = Model::weft;
  double tick_rate = 60;                 ///< ticks per simulated second [1/s]
  TextileTest test = TextileTest::none;  ///< textile test performed on the first cloth
  EnvironmentDef environment;
  SolverDef solver;
  RelaxationDef relaxation;
  ImplicitDef implicit;
  CollisionDef contact;
  BudgetDef budget;
  SleepDef sleep;
  std::vector<ClothDef> cloths = {ClothDef{}};  ///< 1 to kMostCloths
  std::optional<StartDef> start;  ///< of all their particles; absent: at rest as defined
  std::vector<ColliderDef> colliders;
  std::vector<PinDef> pins;                  ///< present at the start
  std::vector<HandDef> hands;                ///< of the scene itself, at most kMostSceneHands
  std::vector<DisturbanceDef> disturbances;  ///< applied at once, at most kMostDisturbances
  std::vector<WindKey> winds;                ///< in succession, at most kMostWinds
  VerdictDef verdict;                        ///< its limits as a hard case
  std::vector<GripperDef> grippers;          ///< at most kMostGrippers; need certified contact
};

/// Passes every field that does not belong to a cloth, collider or pin to `visit(path, info,
/// value)`. A path such as "solver." is also the name of an object in a scene file.
template <class Def, class Visitor>
void visit_fields_of_world(Def& def, Visitor&& visit) {
  const auto below = [&visit](const std::string& path) {
    return [&visit, path](const FieldInfo& info, auto& value) { visit(path, info, value); };
  };
  below("")(choice("model", "weft|seed", "solver and contact, unless they are chosen by name"),
            def.model);
  below("")(FieldInfo{"tick_rate", 1, 1000, "1/s", "ticks per simulated second"}, def.tick_rate);
  below("")(choice("test", "none|drape|cantilever|decay", "textile test of the first cloth"),
            def.test);
  visit_fields_of_environment(def.environment, below("environment."));
  visit_fields_of_solver(def.solver, below("solver."));
  below("contact.")(choice("model", "automatic|weft|seed", "automatic: by the model"),
                    def.contact.model);
  visit_fields_of_seed_contact(def.contact.seed, below("contact."));
  visit_fields_of_relaxation(def.relaxation, below("relaxation."));
  visit_fields_of_implicit(def.implicit, below("implicit."));
  visit_fields_of_budget(def.budget, below("budget."));
  visit_fields_of_sleep(def.sleep, below("sleep."));
  visit_fields_of_verdict(def.verdict, below("verdict."));
}

/// The same, including the fields of all cloths.
template <class Def, class Visitor>
void visit_fields(Def& def, Visitor&& visit) {
  const auto below = [&visit](const std::string& path) {
    return [&visit, path](const FieldInfo& info, auto& value) { visit(path, info, value); };
  };
  visit_fields_of_world(def, visit);
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    visit_fields_of_cloth(def.cloths[k], below(cloth_field(k, "cloth.")));
    visit_fields_of_fabric(def.cloths[k].fabric, below(cloth_field(k, "fabric.")));
  }
}

/// The solver chosen by the definition, never `automatic`.
SolverKind solver_of(const WorldDef& def);

/// The contact chosen by the definition: certified or seed.
ContactModel contact_of(const WorldDef& def);

/// Name of the fabric that viewers draw a cloth as; empty if neither its look nor the preset of its
/// fabric tells one.
std::string look_name(const ClothDef& cloth);

/// The cloths with a membrane that the solver has: rigid relaxation (compliance 0) needs springs,
/// also along the edges of a mesh. Throws DefinitionError if a fabric locks and the solver is not
/// verlet.
std::vector<ClothDef> cloths_to_build(const WorldDef& def);

/// Name of a cloth for messages; its number if it has none.
std::string cloth_name(const WorldDef& def, Index cloth);

/// Whether the definition has the guard of cloths against themselves and each other.
bool has_guard(const WorldDef& def);

/// Name of the solver in reports.
const char* solver_name(const WorldDef& def);

/// Checks all ranges and combinations that need no model. Throws DefinitionError.
void validate(const WorldDef& def);

/// Sets one field by its path, e.g. "fabric.shear" = "20", "environment.wind" = "3,0,0" or, with
/// several cloths, "cloths[1].rows" = "30". "cloth." and "fabric." refer to the first. "fabric" =
/// "cotton" (or "cloths[1].fabric") takes all values of a preset. "model" = "seed" selects the
/// seed's contact of particles with triangles if contact.self is the guard. Throws DefinitionError,
/// without any change, on an unknown key, a mesh's rectangle or a value out of range.
void set_field(WorldDef& def, const std::string& key, const std::string& text);

/// A field in text form.
struct FieldListing {
  std::string key, value, allowed, meaning;
};

/// Every field that `set_field` accepts, with its present value.
std::vector<FieldListing> list_fields(const WorldDef& def);

}  // namespace weft
