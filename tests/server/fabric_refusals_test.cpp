#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/server/fakes.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

// What is told of a fabric that a room refuses.

namespace weft::server {
namespace {

using nlohmann::json;

/// A mesh and a grid of nylon.
WorldDef mesh_and_grid(const std::string&) {
  WorldDef def;
  def.cloths = {test::triangle_sheet(test::Cut::alternating, 0.04, 0.04, 0.005),
                test::flat_cloth(9, 9, 0.04, 0.03)};
  def.cloths[0].name = "mesh";
  def.cloths[1].name = "grid";
  def.cloths[1].origin = Vec3d(1, 0, 0);
  for (ClothDef& cloth : def.cloths) cloth.fabric = make_fabric("nylon");
  return def;
}

/// A room with both cloths, and one viewer.
struct FabricRoom : TestRoom {
  FabricRoom() {
    RoomOptions options;
    options.scene = "small";
    options.scene_names = {"small"};
    options.paused = true;
    room = std::make_unique<Room>(options, mesh_and_grid, output, clock.clock(), metrics);
    join(1);
  }

  int id = 0;

  json set(const std::string& cloth, const json& fabric) {
    return say(1, json{{"op", "set"}, {"id", ++id}, {"cloth", cloth}, {"fabric", fabric}}.dump());
  }
};

TEST_CASE("a refused fabric is blamed on a field that was sent, as it was sent") {
  struct Case {
    const char *cloth, *fabric, *field;
    bool limit;
    const char *message, *hint;
  };
  FabricRoom t;
  for (const Case& c : {
           Case{"grid", R"({"shear":100000})", "shear", true, "allowed is 0 to ", "shear"},
           Case{"mesh", R"({"shear":100000})", "shear", true, "allowed is below ", "poisson"},
           Case{"grid", R"({"poisson":0.3,"friction":1})", "poisson", true, "-1", "triangles"},
           Case{"mesh", R"({"poisson":2})", "poisson", true, "less than ", "stretch"},
           Case{"mesh", R"({"bending_warp":0.1,"bending_damping":10})", "bending_damping", true,
                "at most ", "mesh"},
           Case{"mesh", R"({"bending_warp":10})", "bending_warp", false,
                "fabric.bending_damping =", "bending_damping"},
           Case{"grid", R"({"friction":1,"stretch_warp":1})", "stretch_warp", false,
                "fabric.shear =", "fabric.shear"},
           Case{"mesh", R"({"stretch_damping":10})", "stretch_damping", false,
                "more than 20000 substeps a tick", "damping"},
           Case{"mesh", R"({"thickness":0.002,"areal_density":0.001,"stretch_warp":1000000})",
                "stretch_warp", false, "more than 20000 substeps a tick", "stiffness"},
           Case{"mesh", R"({"preset":"silk","bending_weft":0.1,"bending_damping":9})",
                "bending_damping", true, "at most ", "mesh"},
       }) {
    CAPTURE(c.cloth, c.fabric);
    const json sent = json::parse(c.fabric), answer = t.set(c.cloth, sent);
    CAPTURE(answer.dump());
    REQUIRE(answer["op"] == "error");
    CHECK(answer["field"] == "fabric." + std::string(c.field));
    CHECK(answer["value"] == sent[c.field]);
    CHECK(answer.contains("limit") == c.limit);
    CHECK(answer["message"].get<std::string>().starts_with("fabric." + std::string(c.field)));
    CHECK(answer["message"].get<std::string>().find(c.message) != std::string::npos);
    CHECK(answer["hint"].get<std::string>().find(c.hint) != std::string::npos);
  }
}

TEST_CASE("whatever is refused of a fabric was sent, and a limit that is told is taken") {
  test::SeededRandom random(7);
  FabricRoom t;
  const std::vector<std::string> names = {"areal_density",   "stretch_warp",   "stretch_weft",
                                          "shear",           "poisson",        "bending_warp",
                                          "bending_weft",    "locking_strain", "damping_ratio",
                                          "stretch_damping", "shear_damping",  "bending_damping"};
  const std::vector<std::pair<double, double>> decades = {
      {1e-3, 1},  {1, 1e6},  {1, 1e6},  {1, 1e6},   {0.1, 10},  {1e-7, 10},
      {1e-7, 10}, {0.01, 1}, {0.01, 1}, {1e-4, 10}, {1e-4, 10}, {1e-4, 10}};
  int refused = 0, limited = 0;
  for (int draw = 0; draw < 400; ++draw) {
    const std::string cloth = random.index(2) == 0 ? "mesh" : "grid";
    json sent;
    for (Index n = random.index(3); n >= 0; --n) {
      const auto k = static_cast<std::size_t>(random.index(static_cast<Index>(names.size())));
      const auto [low, high] = decades[k];
      sent[names[k]] = std::exp(random.uniform(std::log(low), std::log(high)));
    }
    const json answer = t.set(cloth, sent);
    CAPTURE(cloth, sent.dump(), answer.dump());
    t.set(cloth, {{"preset", "nylon"}});
    if (answer["op"] == "result") continue;
    ++refused;
    const std::string field = answer["field"];
    REQUIRE(field.starts_with("fabric."));
    const std::string name = field.substr(7);
    REQUIRE(sent.contains(name));
    CHECK(answer["value"] == sent[name]);
    if (!answer.contains("limit")) continue;
    ++limited;
    const double given = sent[name], most = answer["limit"]["maximum"];
    CHECK(given > most);
    sent[name] = most;
    const json again = t.set(cloth, sent);
    CAPTURE(again.dump());
    t.set(cloth, {{"preset", "nylon"}});
    if (again["op"] == "error") CHECK_FALSE((again["field"] == field && again.contains("limit")));
  }
  CHECK(refused > 100);
  CHECK(limited > 30);
}

}  // namespace
}  // namespace weft::server
