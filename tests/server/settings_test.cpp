#include <array>
#include <string>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/server/fakes.h"

// What `set` sets, and for how long.

namespace weft::server {
namespace {

using nlohmann::json;

std::string hash_of(const Room& room) {
  return proto::hash_text(room.world().hash());
}

TEST_CASE("reset brings back the scene's pins and tick 0, and keeps what was set") {
  TestRoom t;
  t.join(1);
  const std::string start = hash_of(*t.room);
  t.say(1, R"({"op":"set","gravity":[0,-1,0]})");
  t.say(1, R"({"op":"release","all":true})");
  t.say(1, R"({"op":"drag","phase":"start","particle":38})");
  t.say(1, R"({"op":"advance","n":30})");
  CHECK(t.say(1, R"({"op":"reset","id":1})")["tick"] == 0);
  CHECK(hash_of(*t.room) != start);  // gravity is still another one
  CHECK(t.output.last("pins")["pins"].size() == 2);
  CHECK(t.output.last("grabs")["grabs"].empty());
  CHECK(t.output.last("state")["gravity"][1] == -1);
  t.say(1, R"({"op":"set","gravity":[0,-9.81,0]})");
  CHECK(hash_of(*t.room) == start);
}

TEST_CASE("a fabric set in motion is told to everybody, its substeps follow, and it stays") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"advance","n":30})");
  const int substeps = t.room->world().report().substeps;
  t.output.sent.clear();
  const json answer =
      t.say(1, R"({"op":"set","id":1,"fabric":{"stretch_warp":4000,"friction":0.9}})");
  REQUIRE(answer["op"] == "result");
  const json told = t.output.last("state");
  REQUIRE(!told.is_null());
  CHECK(told["fabrics"][0]["stretch_warp"] == 4000);
  CHECK(told["fabrics"][0]["friction"] == 0.9);
  CHECK(told["fabrics"][0]["stretch_weft"] == FabricDef().stretch_weft);
  for (const auto& [viewer, text] : t.output.sent) {
    if (json::parse(text)["op"] == "state") CHECK(viewer == 0);  // to all
  }
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.room->world().report().substeps > substeps);
  t.say(1, R"({"op":"reset"})");
  CHECK(t.room->world().def().cloths[0].fabric.stretch_warp == 4000);
  CHECK(t.say(1, R"({"op":"set","id":2,"cloth":"cloth","fabric":{"preset":"silk"}})")["op"] ==
        "result");
  CHECK(t.room->world().def().cloths[0].fabric.friction == make_fabric("silk").friction);
}

TEST_CASE("each number of a fabric is set and told on the wire as a scene has it") {
  TestRoom t;
  t.join(1);
  FabricDef fabric = t.room->world().def().cloths[0].fabric;
  std::size_t numbers = 0;
  visit_fields_of_fabric(fabric, [&](const FieldInfo& info, double& value) {
    INFO(info.name);
    ++numbers;
    // A grid's Poisson's ratio follows from its shear.
    if (std::string(info.name) != "poisson") value = value > 0 ? 1.25 * value : 1e-3;
    const json wanted = {{"op", "set"}, {"id", 1}, {"fabric", {{info.name, value}}}};
    REQUIRE(t.say(1, wanted.dump())["op"] == "result");
    CHECK(t.output.last("state")["fabrics"][0][info.name] == value);
  });
  CHECK(t.output.last("state")["fabrics"][0].size() == numbers);
  const json refused = t.say(1, R"({"op":"set","id":2,"fabric":{"poisson":0.3}})");
  CHECK(refused["op"] == "error");
  CHECK(refused["field"] == "fabric.poisson");
}

TEST_CASE("a room whose fabric was changed is replayed by its log to the same hash") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":20})");
  t.say(1, R"({"op":"drag","phase":"start","particle":22,"target":[0.2,1,0.3]})");
  t.say(1, R"({"op":"set","fabric":{"areal_density":0.4,"stretch_warp":900,"thickness":0.006},)"
           R"("wind":[1,0,2]})");
  t.say(1, R"({"op":"advance","n":30})");
  t.say(1, R"({"op":"set","fabric":{"preset":"denim"},"softness":0.5})");
  t.say(1, R"({"op":"advance","n":30})");
  TestRoom replay;
  replay.join(1);
  for (const LogEntry& entry : t.room->log().entries())
    replay.say(1, proto::encode_request({std::nullopt, entry.command}));
  CHECK(hash_of(*replay.room) == hash_of(*t.room));
}

TEST_CASE("a fabric that cannot be, or costs too much, is refused by field and changes nothing") {
  const std::vector<std::pair<std::string, std::string>> fine = {{"cloth.rows", "21"},
                                                                 {"cloth.columns", "21"}};
  TestRoom t(true, fine), other(true, fine);
  t.join(1);
  other.join(1);
  t.say(1, R"({"op":"advance","n":30})");
  const std::string before = hash_of(*t.room);
  const std::array<std::array<const char*, 3>, 4> table = {{
      {R"("fabric":{"preset":"gossamer"})", "unknown_value", "fabric.preset"},
      {R"("fabric":{"stretch_warp":1000000,"stretch_weft":1000000,"areal_density":0.001})",
       "out_of_range", "fabric.stretch_warp"},
      {R"("cloth":9,"fabric":{"friction":1})", "out_of_range", "cloth"},
      {R"("cloth":"skirt","fabric":{"friction":1})", "unknown_value", "cloth"},
  }};
  for (const auto& [fields, code, field] : table) {
    CAPTURE(fields);
    const json answer =
        t.say(1, R"({"op":"set","id":2,"wind":[9,0,0],)" + std::string(fields) + "}");
    CHECK(answer["code"] == code);
    CHECK(answer["field"] == field);
    CHECK(hash_of(*t.room) == before);
  }
  t.say(1, R"({"op":"advance","n":5})");
  other.say(1, R"({"op":"advance","n":35})");
  CHECK(hash_of(*t.room) == hash_of(*other.room));
}

TEST_CASE("a fabric whose ticks would cost more than the server allows is too costly") {
  TestRoom t(true, {{"cloth.rows", "200"}, {"cloth.columns", "200"}});
  t.join(1);
  const json answer = t.say(1, R"({"op":"set","id":1,"fabric":{"stretch_warp":8000,)"
                               R"("stretch_weft":8000,"areal_density":0.01}})");
  CHECK(answer["code"] == "too_costly");
  CHECK(answer["field"] == "fabric.stretch_warp");
  CHECK(answer["value"] == 8000);
  CHECK(t.room->world().def().cloths[0].fabric.stretch_warp == FabricDef().stretch_warp);
}

TEST_CASE("a softness that would throw the cloth, or costs too much, is refused by its name") {
  TestRoom t;
  t.join(1);
  const auto refused = [&t](const char* fields) {
    const std::string before = hash_of(*t.room);
    const json answer =
        t.say(1, std::string(R"({"op":"set","id":1,"wind":[1,2,3],)") + fields + "}");
    CHECK(hash_of(*t.room) == before);  // the wind is in it
    return answer;
  };
  t.say(1, R"({"op":"set","softness":0.01,"gravity":[0,-100,0]})");
  t.say(1, R"({"op":"advance","n":60})");
  const json thrown = refused(R"("softness":1)");
  CHECK(thrown["code"] == "out_of_range");
  CHECK(thrown["field"] == "softness");
  CHECK(thrown["message"].get<std::string>().find("J in the present shape") != std::string::npos);

  TestRoom large(true, {{"cloth.rows", "200"}, {"cloth.columns", "200"}});
  large.join(1);
  large.say(1, R"({"op":"set","softness":0.01})");
  large.say(
      1, R"({"op":"set","fabric":{"stretch_warp":8000,"stretch_weft":8000,"areal_density":0.01}})");
  const json dear = large.say(1, R"({"op":"set","id":1,"softness":1})");
  CHECK(dear["code"] == "too_costly");
  CHECK(dear["field"] == "softness");
  CHECK(large.room->world().softness() == 0.01);
}

TEST_CASE("a restored state keeps its softness, whatever is set then") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"set","softness":0.5})");
  t.say(1, R"({"op":"save","name":"soft"})");
  t.say(1, R"({"op":"set","softness":1})");
  t.say(1, R"({"op":"restore","name":"soft"})");
  for (const char* change : {R"("fabric":{"friction":0.3})", R"("budget_ms":9)"}) {
    CHECK(t.say(1, std::string(R"({"op":"set","id":1,)") + change + "}")["op"] == "result");
    CHECK(t.room->world().softness() == 0.5);
  }
}

TEST_CASE("who joins after a change of thickness hears the present one") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"set","fabric":{"thickness":0.006}})");
  t.join(2);
  CHECK(t.output.last("mesh")["cloths"][0]["thickness"] == 0.006);
  CHECK(t.output.last("state")["fabrics"][0]["thickness"] == 0.006);
}

TEST_CASE("a fabric of wrong type or without anything to set is refused by its path") {
  struct Case {
    const char *fields, *code, *field;
  };
  for (const Case& hostile : {Case{R"("fabric":3)", "wrong_type", "fabric"},
                              Case{R"("fabric":{})", "missing_field", "fabric"},
                              Case{R"("fabric":{"shear":"1"})", "wrong_type", "fabric.shear"},
                              Case{R"("fabric":{"preset":""})", "wrong_length", "fabric.preset"},
                              Case{R"("wind":[0,0,1],"cloth":0)", "conflicting_fields", "cloth"},
                              Case{R"("fabric":{"shear":1},"cloth":[])", "wrong_type", "cloth"}}) {
    CAPTURE(hostile.fields);
    const auto request =
        proto::parse_request(R"({"op":"set",)" + std::string(hostile.fields) + "}");
    REQUIRE_FALSE(request.has_value());
    const json error = json::parse(proto::encode_error(request.error()));
    CHECK(error["code"] == hostile.code);
    CHECK(error["field"] == hostile.field);
  }
}

}  // namespace
}  // namespace weft::server
