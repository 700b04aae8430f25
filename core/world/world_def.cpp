// Validates definitions of worlds, and sets and lists their fields.

#include "core/world/world_def.h"

#include <algorithm>
#include <cassert>
#include <string_view>
#include <type_traits>

#include "core/cloth/fabric_presets.h"
#include "core/error.h"
#include "core/geometry/constants.h"

namespace weft {
namespace {

std::string text_of(double value) {
  return number_text(value);
}
std::string text_of(int value) {
  return std::to_string(value);
}
std::string text_of(bool value) {
  return value ? "true" : "false";
}
std::string text_of(const Vec3d& v) {
  return number_text(v[0]) + "," + number_text(v[1]) + "," + number_text(v[2]);
}

/// A field's value as people write it.
template <class Value>
std::string text_of(const FieldInfo& info, const Value& value) {
  if constexpr (std::is_enum_v<Value>)
    return choice_word(info, static_cast<int>(value));
  else
    return text_of(value);
}

/// A hint for a key that is none.
std::string hint_for(const std::string& key, const std::vector<std::string>& keys) {
  const auto without_group = std::find_if(
      keys.begin(), keys.end(), [&key](const std::string& k) { return k.ends_with("." + key); });
  const std::string meant = without_group != keys.end() ? *without_group : nearest_word(key, keys);
  return meant.empty() ? "" : "did you mean " + meant + "?";
}

/// Throws DefinitionError if a key names part of a list, a mesh, a look or a preset, which have no
/// keys, or a cloth that is not there: a list of all the keys that there are would hide the reason.
void refuse_place(const WorldDef& def, const std::string& key) {
  for (const char* list :
       {"colliders", "pins", "grippers", "hands", "insults", "winds", "fans", "environment.fans"}) {
    if (key.starts_with(list))
      throw DefinitionError("key", key, std::string("none of ") + list,
                            std::string(list) + " are set in the scene's own text alone");
  }
  if (key.find("mesh.") != std::string::npos)
    throw DefinitionError("key", key, "none of a mesh",
                          "it is shaped and placed in the scene's own text alone");
  if (key.starts_with("look") || key.find(".look") != std::string::npos)
    throw DefinitionError("key", key, "none of a look",
                          "how a cloth looks is told in the scene's own text alone");
  if (const std::string preset = ".preset"; key.ends_with("fabric" + preset)) {
    const std::string whole = key.substr(0, key.size() - preset.size());
    throw DefinitionError("key", key, whole, "a preset is set as a whole: " + whole + "=silk");
  }
  if (!key.starts_with("cloths")) return;
  const std::string count = std::to_string(def.cloths.size());
  std::string all;
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    const std::string place = "cloths[" + std::to_string(k) + "]";
    if (key == place || key.starts_with(place + ".")) return;
    if (k == 0) all = place;
    if (k > 0 && k + 1 == def.cloths.size()) all += " to " + place;
  }
  throw DefinitionError("key", key, all,
                        "the scene has " + count + (def.cloths.size() == 1 ? " cloth" : " cloths"));
}

/// Whether a field of a cloth, e.g. "rows", tells a rectangle, which a mesh has not. A mesh takes
/// the stiffness that it must have, 0.
bool is_of_rectangle(const ClothDef& cloth, std::string_view field) {
  bool found = false;
  visit_fields_of_grid(
      cloth, [&](const FieldInfo& info, const auto&) { found = found || field == info.name; });
  return found && field != "skip_stiffness";
}

/// The same of a field of a world, if its cloth is a mesh.
bool is_without_effect(const WorldDef& def, const std::string& path, const FieldInfo& info) {
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    if (def.cloths[k].mesh && path == cloth_field(k, "cloth."))
      return is_of_rectangle(def.cloths[k], info.name);
  }
  return false;
}

/// @param wanted  the same key, of the first cloth as it is listed
void refuse_key(const WorldDef& def, const std::string& key, const std::string& wanted) {
  refuse_place(def, key);
  std::vector<std::string> keys = {"fabric"};
  for (const FieldListing& field : list_fields(def)) keys.push_back(field.key);
  std::string all;
  for (const std::string& known : keys) all += (all.empty() ? "" : ", ") + known;
  throw DefinitionError("key", key, "one of " + all, hint_for(wanted, keys));
}

}  // namespace

SolverKind solver_of(const WorldDef& def) {
  if (def.solver.kind != SolverKind::automatic) return def.solver.kind;
  return def.model == Model::seed ? SolverKind::relaxation : SolverKind::verlet;
}

ContactModel contact_of(const WorldDef& def) {
  if (def.contact.model != ContactModel::automatic) return def.contact.model;
  return def.model == Model::seed ? ContactModel::seed : ContactModel::certified;
}

std::string look_name(const ClothDef& cloth) {
  const LookOf look = cloth.look ? cloth.look->fabric : LookOf::automatic;
  if (look == LookOf::automatic) return cloth.fabric.preset;
  std::string word;
  visit_fields_of_look(*cloth.look, [&word, look](const FieldInfo& info, LookOf) {
    word = choice_word(info, static_cast<int>(look));
  });
  return word;
}

namespace {

bool relaxes_rigidly(const WorldDef& def) {
  return solver_of(def) == SolverKind::relaxation && def.relaxation.compliance == 0;
}

}  // namespace

std::vector<ClothDef> cloths_to_build(const WorldDef& def) {
  std::vector<ClothDef> cloths = def.cloths;
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    ClothDef& cloth = cloths[k];
    if (cloth.fabric.locking_strain > 0 && solver_of(def) != SolverKind::verlet)
      throw DefinitionError(cloth_field(k, "fabric.locking_strain"),
                            number_text(cloth.fabric.locking_strain), "0 with this solver",
                            "only verlet has threads that lock")
          .with(Range{0, 0});
    if (relaxes_rigidly(def) && cloth.membrane_model == MembraneModel::automatic)
      cloth.membrane_model = MembraneModel::springs;
  }
  return cloths;
}

std::string cloth_name(const WorldDef& def, Index cloth) {
  assert(cloth >= 0 && static_cast<std::size_t>(cloth) < def.cloths.size());
  const std::string& name = def.cloths[static_cast<std::size_t>(cloth)].name;
  return name.empty() ? "cloth " + std::to_string(cloth) : name;
}

bool has_guard(const WorldDef& def) {
  const SelfContact self = def.contact.seed.self;
  return contact_of(def) == ContactModel::certified &&
         (self == SelfContact::automatic || self == SelfContact::guard);
}

const char* solver_name(const WorldDef& def) {
  switch (solver_of(def)) {
    case SolverKind::relaxation:
      return "relaxation";
    case SolverKind::implicit:
      return "implicit";
    default:
      return "verlet";
  }
}

void validate(const EnvironmentDef& def) {
  visit_fields_of_environment(def, [](const FieldInfo& info, const auto& value) {
    check_field("environment.", info, value);
  });
  check_field("environment.", {"fans", 0, kMostFans, "", "number of fans"},
              static_cast<double>(def.fans.size()));
  for (std::size_t k = 0; k < def.fans.size(); ++k) {
    const std::string path = "environment.fans[" + std::to_string(k) + "].";
    visit_fields_of_fan(def.fans[k], [&path](const FieldInfo& info, const auto& value) {
      check_field(path, info, value);
    });
    if (!(def.fans[k].direction.norm() > kShortestDirection))
      throw DefinitionError(path + "direction", "0,0,0", "a direction",
                            "give a vector that is not zero");
  }
}

void validate_script(const WorldDef& def) {
  check_field("", {"hands", 0, kMostSceneHands, "", "number of hands"},
              static_cast<double>(def.hands.size()));
  check_field("", {"insults", 0, kMostDisturbances, "", "number of disturbances"},
              static_cast<double>(def.disturbances.size()));
  for (std::size_t k = 0; k < def.hands.size(); ++k) {
    validate(def.hands[k], "hands[" + std::to_string(k) + "].");
    const auto has_name = [&](const ClothDef& cloth) { return cloth.name == def.hands[k].cloth; };
    if (!def.hands[k].cloth.empty() && std::none_of(def.cloths.begin(), def.cloths.end(), has_name))
      throw DefinitionError("hands[" + std::to_string(k) + "].cloth", def.hands[k].cloth,
                            "the name of a cloth");
  }
  for (std::size_t k = 0; k < def.disturbances.size(); ++k)
    validate(def.disturbances[k], "insults[" + std::to_string(k) + "].");
  validate(def.winds);
}

void validate_grippers(const WorldDef& def) {
  check_field("", {"grippers", 0, kMostGrippers, "", "number of grippers"},
              static_cast<double>(def.grippers.size()));
  std::vector<std::string> names;
  for (const ColliderDef& collider : def.colliders) names.push_back(collider.name);
  for (std::size_t k = 0; k < def.grippers.size(); ++k) {
    const std::string path = "grippers[" + std::to_string(k) + "].";
    validate(def.grippers[k], path);
    for (const ColliderDef& jaw : jaws_of(def.grippers[k])) {
      if (std::find(names.begin(), names.end(), jaw.name) != names.end())
        throw DefinitionError(path + "name", def.grippers[k].name,
                              "a name whose jaws share no name with another object");
      names.push_back(jaw.name);
    }
  }
  if (!def.grippers.empty() && contact_of(def) != ContactModel::certified)
    throw DefinitionError("grippers", std::to_string(def.grippers.size()), "none with this contact",
                          "set contact.model to weft");
}

/// The seed's contact knows one coefficient of friction for each cloth.
void validate_friction_factors(const WorldDef& def) {
  if (contact_of(def) == ContactModel::certified) return;
  for (std::size_t k = 0; k < def.colliders.size(); ++k) {
    if (def.colliders[k].friction_factor == 1) continue;
    throw DefinitionError("colliders[" + std::to_string(k) + "].friction_factor",
                          number_text(def.colliders[k].friction_factor), "1 with this contact",
                          "set contact.model to weft");
  }
}

void validate(const WorldDef& def) {
  check_field("", {"cloths", 1, kMostCloths, "", "number of cloths"},
              static_cast<double>(def.cloths.size()));
  visit_fields(def, [](const std::string& path, const FieldInfo& info, const auto& value) {
    check_field(path, info, value);
  });
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    if (relaxes_rigidly(def) && def.cloths[k].membrane_model == MembraneModel::triangles)
      throw DefinitionError(cloth_field(k, "cloth.membrane_model"), "triangles",
                            "automatic or springs with rigid relaxation",
                            "give relaxation.compliance, e.g. 1, or take another solver");
  }
  const SelfContact self = def.contact.seed.self;
  const auto refuse_self = [&](const char* allowed, const char* hint) {
    throw DefinitionError("contact.self", text_of(self_contact_info(), self), allowed, hint);
  };
  if (contact_of(def) == ContactModel::seed) {
    const SeedContactDef& seed = def.contact.seed;
    if (seed.correction == Correction::fold_map && !(seed.lift < seed.fold_depth))
      throw DefinitionError("contact.lift", number_text(seed.lift),
                            "less than contact.fold_depth, " + number_text(seed.fold_depth) + " m",
                            "the map lifts the deepest particle to it");
    if (self == SelfContact::guard)
      refuse_self("automatic, none, particles, triangles or triangles_and_edges",
                  "set contact.model to weft for the guard");
  } else if (self != SelfContact::none && !has_guard(def)) {
    refuse_self("automatic, none or guard",
                "set contact.model to seed for the seed's contact of the cloth "
                "with itself");
  }
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      if (def.cloths[j].name == def.cloths[k].name)
        throw DefinitionError("cloths[" + std::to_string(k) + "].name", def.cloths[k].name,
                              "a name that no other cloth has", "pins name their cloth");
    }
  }
  if (def.sleep.after > 0 && def.test != TextileTest::none)
    throw DefinitionError("sleep.after", number_text(def.sleep.after), "0 in a textile test",
                          "what is measured must come to rest by itself");
  if (def.view && def.view->direction.isZero())
    throw DefinitionError("view.direction", text_of(def.view->direction), "a vector that is not 0",
                          "it points from the target towards the eye");
  validate(def.environment);
  validate_grippers(def);
  validate_friction_factors(def);
  validate_script(def);
}

void set_field(WorldDef& def, const std::string& key, const std::string& text) {
  bool found = false;
  // The first cloth may be written like the others.
  const std::string first = "cloths[0].";
  std::string wanted = key;
  if (key.starts_with(first))
    wanted = (key.starts_with(first + "fabric.") ? "" : "cloth.") + key.substr(first.size());
  for (std::size_t k = 0; k < def.cloths.size(); ++k) {
    if (key != cloth_field(k, "fabric") && key != "cloths[" + std::to_string(k) + "].fabric")
      continue;
    def.cloths[k].fabric = make_fabric(text);
    return;
  }
  visit_fields(def, [&](const std::string& path, const FieldInfo& info, auto& value) {
    if (found || wanted != path + info.name) return;
    found = true;
    if (is_without_effect(def, path, info))
      throw DefinitionError(key, text, "none on a mesh",
                            "mesh.source, mesh.scale, mesh.position and mesh.orientation in the "
                            "scene's own text shape and place it");
    const std::string as_given = key.substr(0, key.size() - std::string_view(info.name).size());
    parse_field(as_given, info, text, value);
  });
  if (!found) refuse_key(def, key, wanted);
  // The guard belongs to Weft's contact: the seed's own self-contact replaces it.
  if (wanted == "model" && contact_of(def) == ContactModel::seed &&
      def.contact.seed.self == SelfContact::guard)
    def.contact.seed.self = SelfContact::triangles;
}

std::vector<FieldListing> list_fields(const WorldDef& def) {
  std::vector<FieldListing> list;
  visit_fields(def, [&](const std::string& path, const FieldInfo& info, const auto& value) {
    if (is_without_effect(def, path, info)) return;
    const bool flag = std::is_same_v<std::decay_t<decltype(value)>, bool>;
    list.push_back({path + info.name, text_of(info, value),
                    flag ? "true or false" : allowed_values(info), info.meaning});
  });
  return list;
}

}  // namespace weft
