// Scenes that are loaded beside the room, and what may cost how much.

#include <new>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/geometry/triangle_mesh.h"
#include "server/translate/translate_mesh.h"
#include "tests/server/halting_room.h"
#include "tests/support/sheets_of_triangles.h"

namespace weft::server {
namespace {

using nlohmann::json;

TEST_CASE("a load that is refused while a tick runs costs no tick") {
  Jobs jobs;
  RoomOptions options = with_jobs(jobs);
  options.read_scene = [](const std::string&) -> WorldDef {
    throw DefinitionError("scene.x", "1", "less");
  };
  HaltingRoom t(false, options);
  t.room->join(1);
  for (int tick = 1; tick <= 5; ++tick) {
    t.room->tell(1, R"({"op":"load","id":1,"scene":{"name":"x"}})");
    t.at_stop = [&] { jobs.run_all(); };
    t.room->tick(1);
    CHECK(t.get().world().tick() == static_cast<std::uint64_t>(tick));
    CHECK(t.room->output.last("error", 1)["code"] == "out_of_range");
  }
}

TEST_CASE("a scene is built beside the running one, which goes on until it is ready") {
  Jobs jobs;
  TestRoom t(false, {}, with_jobs(jobs));
  t.join(1);
  t.join(2);
  t.tell(1, R"({"op":"load","id":1,"scene":"other"})");
  t.tell(1, R"({"op":"hash","id":2})");
  t.tick(5);
  CHECK(t.room->world().tick() == 5);
  CHECK(t.room->epoch() == 1);
  t.tell(2, R"({"op":"hash","id":3})");
  CHECK(t.output.last("result", 3)["tick"] == 5);
  CHECK(t.output.last("result", 1).is_null());
  CHECK(t.output.last("result", 2).is_null());  // comes behind the load
  jobs.run_all();
  t.room->finish_turn();
  CHECK(t.output.last("result", 1)["epoch"] == 2);
  CHECK(t.room->world().def().name == "other");
  const LogEntry& entry = t.room->log().entries().back();
  CHECK(std::holds_alternative<proto::Load>(entry.command));
  CHECK(entry.tick == 5);
  t.clock.now += 0.3;  // after what was sent to all its viewer pauses
  t.room->finish_turn();
  CHECK(t.output.last("result", 2)["tick"] == 0);
}

TEST_CASE("what is computed between two ticks may take two fifths of a tick's limit") {
  for (const char* what : {"contacts", "reactions", "crossings"}) {
    INFO(what);
    HaltingRoom t(true);  // where forces are asked for the first time
    t.room->join(1);
    int id = 0;
    const auto said = [&](double takes, const std::string& rest) {
      t.takes = takes;
      t.halt_at(0);
      t.room->clock.now += 1;  // after what it asked before
      return t.room->say(1, R"({"id":)" + std::to_string(++id) + rest);
    };
    const std::string query = std::string(R"(,"op":"query","what":")") + what + "\"}";
    CHECK(said(0.1, R"(,"op":"advance","n":1})")["op"] == "result");  // crossings are not known now
    CHECK(said(0.9, query)["code"] == "too_costly");
    CHECK(said(0.7, query)["op"] == "result");
    CHECK(said(1.9, R"(,"op":"advance","n":1})")["op"] == "result");
    CHECK(t.get().world().tick() == 2);
  }
}

TEST_CASE("a load that fails, however it fails, leaves scene, epoch and clock alone") {
  struct Case {
    std::function<WorldDef()> make;
    const char* code;
  };
  const std::vector<Case> cases = {
      {[]() -> WorldDef { throw DefinitionError("scene.x", "1", "less"); }, "out_of_range"},
      {[]() -> WorldDef { throw std::bad_alloc(); }, "internal"},
      {[]() -> WorldDef { throw Stopped(); }, "too_costly"},
      {[] {
         WorldDef def;
         def.cloths[0].rows = def.cloths[0].columns = 1000;
         return def;
       },
       "too_costly"}};
  for (const Case& c : cases) {
    INFO(c.code);
    RoomOptions options;
    options.read_scene = [&c](const std::string&) { return c.make(); };
    TestRoom t(false, {}, options);
    t.join(1);
    t.tick(3);
    const json error = t.say(1, R"({"op":"load","id":1,"scene":{"name":"x"}})");
    CHECK(error["code"] == c.code);
    CHECK(t.room->epoch() == 1);
    CHECK(t.room->world().def().name == "small");
    CHECK(t.room->log().entries().empty());
    t.tick(2);
    CHECK(t.room->world().tick() == 5);
  }
}

TEST_CASE(
    "what would cost too much is refused with its estimate and the limit, and changes nothing") {
  TestRoom t;
  t.join(1);
  const json set = t.say(1, R"({"op":"set","id":1,"wind":[100,0,0],"air_density":1000,)"
                            R"("fans":[{"position":[0,1,1],"direction":[0,0,-1],"speed":50}]})");
  CHECK(set["op"] == "result");  // a small cloth may
  RoomOptions options;
  options.read_scene = [](const std::string&) {
    WorldDef def;
    def.cloths[0].rows = def.cloths[0].columns = 200;
    def.solver.min_substeps = 20000;
    return def;
  };
  TestRoom large(true, {}, options);
  large.join(1);
  const json load = large.say(1, R"({"op":"load","id":1,"scene":{"name":"x"}})");
  CHECK(load["code"] == "too_costly");
  const std::string message = load["message"];
  CHECK(message.find("40000 particles x 20000 substeps") != std::string::npos);
  CHECK(message.find("150000000") != std::string::npos);
  CHECK(large.room->world().def().name == "small");
}

TEST_CASE("a scene whose mesh message would be too long is refused with its bytes and the limit") {
  RoomOptions options;
  std::size_t vertices = 0;
  options.read_scene = [&vertices](const std::string&) {
    WorldDef def;
    def.cloths[0].rows = def.cloths[0].columns = 4;
    TriangleMesh mesh{{}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
    mesh.positions.assign(vertices, Vec3d(0, -3, 0));  // in no triangle, all but four
    for (int k = 0; k < 3; ++k) mesh.positions[static_cast<std::size_t>(k)][k] += 0.1;
    def.colliders = {{"stars", MeshDef{mesh}}};
    return def;
  };
  TestRoom t(true, {}, options);
  t.join(1);
  vertices = 2'800'000;  // 12 bytes each
  const json error = t.say(1, R"({"op":"load","id":1,"scene":{"name":"x"}})");
  CHECK(error["code"] == "too_costly");
  const std::string message = error["message"];
  CHECK(message.find("a mesh message of 336") != std::string::npos);
  CHECK(message.find("at most 33554432 bytes") != std::string::npos);
  CHECK(t.room->world().def().name == "small");
  vertices = 1000;
  CHECK(t.say(1, R"({"op":"load","id":2,"scene":{"name":"x"}})")["op"] == "result");
}

TEST_CASE(
    "the length of a mesh message is estimated as what it is, for grids, meshes and objects") {
  WorldDef def = small_scene("small");
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "other";
  def.cloths[1].origin += Vec3d(5, 0, 0);
  SECTION("grids") {}
  SECTION("a cloth of triangles and an object") {
    def.colliders.push_back({"block", MeshDef{box_mesh(Vec3d(0.1, 0.2, 0.3))}});
    def.cloths[1] = test::triangle_sheet(test::Cut::equilateral, 0.4, 0.3, 0.05);
    def.cloths[1].name = "other";
    def.cloths[1].origin = Vec3d(5, 1, 0);
  }
  const BuiltScene built = build_scene(def, nullptr, 0);
  CHECK(proto::mesh_data_bytes(mesh_size(def)) == built.mesh_bytes.size());
}

}  // namespace
}  // namespace weft::server
