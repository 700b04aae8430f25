#include <map>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "proto/messages/commands.h"
#include "server/room/scene_build.h"
#include "server/scene/scene_library.h"
#include "server/scene/scene_schema.h"
#include "tests/fuzz/command_draw.h"
#include "tests/fuzz/scene_draw.h"
#include "tests/fuzz/script_draw.h"

// The fuzz itself: what it draws is legal, and all that is legal can be drawn.

namespace weft::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostSide = 8;

/// The places of all fields in a schema, as "cloths.fabric.shear", with the schema of each.
void collect_fields(const Json& schema, const std::string& path, std::map<std::string, Json>& out) {
  if (schema.contains("properties")) {
    for (const auto& [name, inner] : schema["properties"].items())
      collect_fields(inner, path.empty() ? name : path + "." + name, out);
  }
  if (schema.contains("allOf")) {
    for (const Json& one : schema["allOf"]) collect_fields(one["then"], path, out);
  }
  const Json items = schema.value("items", Json::object());
  if (items.value("type", "") == "object") return collect_fields(items, path, out);
  // What decides between alternatives is an empty schema in each of them.
  if (schema.value("type", "") != "object" && !schema.empty()) out.emplace(path, schema);
}

struct Seen {
  double least = 1e300, most = -1e300;
  std::set<std::string> words;
};

void collect_values(const Json& value, const std::string& path, std::map<std::string, Seen>& out) {
  if (value.is_object()) {
    for (const auto& [name, inner] : value.items())
      collect_values(inner, path.empty() ? name : path + "." + name, out);
  } else if (value.is_array()) {
    for (const Json& inner : value) collect_values(inner, path, out);
  } else if (value.is_number()) {
    Seen& seen = out[path];
    seen.least = std::min(seen.least, value.get<double>());
    seen.most = std::max(seen.most, value.get<double>());
  } else {
    out[path].words.insert(value.is_string() ? value.get<std::string>() : value.dump());
  }
}

/// Fields whose ends are not drawn: they would cost too much, or the scene would not be legal.
bool is_bounded_otherwise(const std::string& path) {
  for (const char* end :
       {".rows", ".columns", ".particle", ".time", ".u", ".v", ".lift", ".poisson"})
    if (path.ends_with(end)) return true;
  return false;
}

TEST_CASE(
    "every field of the scene format is drawn, at both ends of its range and with each word") {
  std::map<std::string, Json> fields;
  collect_fields(Json::parse(server::scene_schema()), "", fields);
  REQUIRE(fields.size() > 100);
  std::map<std::string, Seen> seen;
  for (std::uint64_t scene = 0; scene < 6000; ++scene) {
    SceneFacts facts;
    collect_values(Json::parse(draw_scene(Dice(1, scene), kMostSide, facts)), "", seen);
  }
  for (const auto& [path, schema] : fields) {
    CAPTURE(path);
    REQUIRE(seen.contains(path));
    if (is_bounded_otherwise(path)) continue;
    const Json& range = schema.contains("items") ? schema["items"] : schema;
    if (range.contains("minimum") && !path.ends_with("orientation") &&
        !path.ends_with("rotation")) {
      CHECK(seen[path].least == range["minimum"].get<double>());
      CHECK(seen[path].most == range["maximum"].get<double>());
    }
    for (const Json& word : schema.value("enum", Json::array())) {
      CAPTURE(word);
      // Only what is not the default needs to be told.
      const bool plain = word == schema.value("default", Json()) || path == "cloths.form";
      CHECK((plain || seen[path].words.contains(word.get<std::string>())));
    }
  }
}

TEST_CASE("at least 80 % of the scenes are legal; the others name field and limit") {
  const server::SceneLibrary library("");
  int refused = 0;
  constexpr int kScenes = 300;
  for (std::uint64_t scene = 0; scene < kScenes; ++scene) {
    SceneFacts facts;
    const std::string text = draw_scene(Dice(2, scene), kMostSide, facts);
    try {
      library.from_client(text);
    } catch (const DefinitionError& error) {
      ++refused;
      CAPTURE(error.what());
      CHECK(!error.field.empty());
      CHECK(!error.limit.empty());
    }
  }
  CHECK(refused <= kScenes / 5);
}

TEST_CASE(
    "commands of every kind that clients can send are drawn, and each is read back as it was") {
  RoomFacts facts;
  facts.scene.particles = 30;
  facts.scene.colliders = {"ball"};
  std::set<std::size_t> kinds;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const proto::Command command = draw_command(Dice(3, k), facts);
    kinds.insert(command.index());
    const std::string text = proto::encode_request({std::nullopt, command});
    CAPTURE(text);
    const auto read = proto::parse_request(text);
    REQUIRE(read);
    CHECK(read->command == command);
  }
  CHECK(kinds.size() == std::variant_size_v<proto::Command> - 1);  // all but that of logs
}

TEST_CASE("a seed and a number give the same script again, and another number another one") {
  const ScriptSize size;
  const std::string first = json_of(draw_script(Dice(4, 7), size)).dump();
  CHECK(json_of(draw_script(Dice(4, 7), size)).dump() == first);
  CHECK(json_of(draw_script(Dice(4, 8), size)).dump() != first);
  CHECK(json_of(draw_script(Dice(5, 7), size)).dump() != first);
}

TEST_CASE("scenes that cannot be built are refused as they are built, and some are drawn") {
  const server::SceneLibrary library("");
  std::map<std::string, int> refused;
  for (std::uint64_t k = 0; k < 400; ++k) {
    for (const Step& step : draw_script(Dice(8, k), {4, 24, 2}).steps) {
      if (step.kind != Step::Kind::say) continue;
      const auto request = proto::parse_request(step.text);
      REQUIRE(request);
      const auto* load = std::get_if<proto::Load>(&request->command);
      if (!load || load->definition.size() > 200) continue;
      try {
        server::build_scene(library.from_client(load->definition), nullptr, 0);
      } catch (const DefinitionError& error) {
        ++refused[error.field];
      }
    }
  }
  for (const char* field : {"cloths", "scene", "cloths[0].fabric", "pins[0].particle"}) {
    INFO(field);
    CHECK(refused[field] > 0);
  }
}

TEST_CASE("a third of what viewers do comes while a tick runs, unless none shall") {
  int within = 0, all = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    ScriptSize size;
    size.within = k % 2 == 0;
    for (const Step& step : draw_script(Dice(9, k), size).steps) {
      if (step.kind == Step::Kind::ticks) continue;
      if (!size.within) CHECK(step.within == -1);
      all += size.within;
      within += step.within >= 0;
    }
  }
  CHECK(within > all / 5);
  CHECK(within < all / 2);
}

TEST_CASE("a script is what its JSON says") {
  const Script script = draw_script(Dice(6, 1), {});
  const auto json = json_of(script);
  CHECK(json_of(script_of(json)) == json);
  CHECK(script_of(json).steps.size() == script.steps.size());
}

}  // namespace
}  // namespace weft::fuzz
