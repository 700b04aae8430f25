// What --set takes and refuses.

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world_def.h"
#include "tests/support/meshes.h"

namespace weft {
namespace {

/// A grid and a mesh.
WorldDef grid_and_mesh() {
  WorldDef def;
  def.cloths.resize(2);
  def.cloths[1].name = "mesh";
  def.cloths[1].mesh.emplace();
  def.cloths[1].mesh->mesh = test::sheet(0.5);
  return def;
}

DefinitionError refusal_of(WorldDef def, const std::string& key, const std::string& text) {
  try {
    set_field(def, key, text);
  } catch (const DefinitionError& error) {
    return error;
  }
  return {"none", "", ""};
}

/// Names of the fields listed of a cloth.
std::set<std::string> fields_below(const std::string& path, const WorldDef& def) {
  std::set<std::string> names;
  for (const FieldListing& field : list_fields(def))
    if (field.key.starts_with(path)) names.insert(field.key.substr(path.size()));
  return names;
}

}  // namespace

TEST_CASE("what tells a rectangle is refused on a mesh by name, all else is listed and taken") {
  const WorldDef def = grid_and_mesh();
  const std::set<std::string> of_rectangle = {"rows",   "columns", "width", "height",
                                              "origin", "u",       "v",     "outline"};
  for (const FieldListing& field : list_fields(def)) {
    const DefinitionError as_it_is = refusal_of(def, field.key, field.value);
    CHECK(as_it_is.field == "none");  // grids take all, and meshes what is listed of them
    if (!field.key.starts_with("cloth.")) continue;
    const std::string name = field.key.substr(6), key = "cloths[1]." + name;
    const DefinitionError refused = refusal_of(def, key, field.value);
    INFO(key << ": " << refused.what());
    CHECK(fields_below("cloths[1].", def).contains(name) == !of_rectangle.contains(name));
    CHECK((refused.field != "none") == of_rectangle.contains(name));
    if (!of_rectangle.contains(name)) continue;
    CHECK(refused.field == key);
    CHECK(refused.value == field.value);
    CHECK(refused.limit == "none on a mesh");
    CHECK(refused.hint.find("mesh.position") != std::string::npos);
  }
  CHECK(fields_below("cloths[1].fabric.", def) == fields_below("fabric.", def));
}

TEST_CASE("a key of a cloth that is not there is told how many there are, and no other key") {
  WorldDef def = grid_and_mesh();
  for (const std::string place : {"cloths[2].", "cloths[02].", "cloths[x].", "cloths."}) {
    const DefinitionError refused = refusal_of(def, place + "fabric.thickness", "0.001");
    CHECK(refused.value == place + "fabric.thickness");
    CHECK(refused.limit == "cloths[0] to cloths[1]");
    CHECK(refused.hint == "the scene has 2 cloths");
  }
  def.cloths.pop_back();
  const DefinitionError alone = refusal_of(def, "cloths[1].rows", "9");
  CHECK(alone.limit == "cloths[0]");
  CHECK(alone.hint == "the scene has 1 cloth");
  CHECK(refusal_of(def, "cloths[0].rws", "9").hint == "did you mean cloth.rows?");
}

TEST_CASE("a key of a list that has none is told where it is set, and no other key") {
  for (const std::string list :
       {"colliders", "pins", "grippers", "hands", "insults", "winds", "environment.fans"}) {
    const DefinitionError refused = refusal_of(grid_and_mesh(), list + "[0].speed", "1");
    CHECK(refused.limit == "none of " + list);
    CHECK(refused.hint == list + " are set in the scene's own text alone");
  }
  CHECK(refusal_of(grid_and_mesh(), "cloths[1].mesh.position", "0,1,0").hint ==
        "it is shaped and placed in the scene's own text alone");
}

TEST_CASE("a key of a look or a preset is told where it is set, and no other key") {
  for (const std::string key : {"look.color", "cloths[0].look.color", "cloths[1].look"}) {
    const DefinitionError refused = refusal_of(grid_and_mesh(), key, "#ff0000");
    CHECK(refused.limit == "none of a look");
    CHECK(refused.hint == "how a cloth looks is told in the scene's own text alone");
  }
  for (const std::string whole : {"fabric", "cloths[1].fabric"}) {
    const DefinitionError refused = refusal_of(grid_and_mesh(), whole + ".preset", "silk");
    CHECK(refused.limit == whole);
    CHECK(refused.hint == "a preset is set as a whole: " + whole + "=silk");
    CHECK(refusal_of(grid_and_mesh(), whole, "silk").field == "none");
  }
}

}  // namespace weft
