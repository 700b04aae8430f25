#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

// Hands that belong to the scene, as viewers see them.

namespace weft::server {
namespace {

using nlohmann::json;

TEST_CASE("hands of the scene are told like those of viewers, as viewer 0 with their place in it") {
  TestRoom t;
  RoomOptions options;
  options.scene = "small";
  options.paused = true;
  const auto with_hands = [](const std::string& name) {
    WorldDef def = small_scene(name);
    HandDef hand;
    hand.path = {{2.0 / 60, Vec3d::Zero()}, {10.0 / 60, Vec3d(0, 0, 0.1)}};
    HandDef first = hand;
    first.path = {{0, Vec3d::Zero()}, {1.0 / 60, Vec3d::Zero()}};
    hand.v = 1;
    def.hands = {first, hand};
    return def;
  };
  t.room = std::make_unique<Room>(options, with_hands, t.output, t.clock.clock(), t.metrics);
  t.join(1);
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.output.last("grabs")["grabs"].size() == 1);
  CHECK(t.output.last("grabs")["grabs"][0]["drag"] == 0);
  t.say(1, R"({"op":"drag","phase":"start","drag":7,"particle":38})");
  t.say(1, R"({"op":"advance","n":5})");
  const json told = t.output.last("grabs")["grabs"];
  REQUIRE(told.size() == 2);  // the first has let go
  CHECK(told[0]["viewer"] == 1);
  CHECK(told[0]["drag"] == 7);
  CHECK(told[1]["viewer"] == 0);
  CHECK(told[1]["drag"] == 1);
  CHECK_FALSE(told[1].contains("force"));
  const json asked = t.say(1, R"({"op":"query","id":1,"what":"grabs"})")["data"];
  REQUIRE(asked.size() == 2);
  CHECK(asked[1]["force"][2].get<double>() > 0);
  CHECK(asked[1]["id"] == told[1]["id"]);
  const json forces = t.say(1, R"({"op":"query","id":2,"what":"reactions"})")["data"]["grabs"];
  REQUIRE(forces.size() == 2);
  CHECK(forces[1]["grab"] == told[1]["id"]);
  t.clock.now += 1;
  t.room->finish_turn();
  const auto frame = proto::decode_frame(std::as_bytes(std::span(t.output.frames.back())));
  REQUIRE(frame->grabs.size() == 2);
  CHECK(frame->grabs[1].viewer == 0);
  CHECK(frame->grabs[1].id == told[1]["id"]);
  t.say(1, R"({"op":"advance","n":6})");
  CHECK(t.output.last("grabs")["grabs"].size() == 1);
  const std::size_t count = t.output.count("grabs");
  t.say(1, R"({"op":"advance","n":5})");
  CHECK(t.output.count("grabs") == count);
  t.say(1, R"({"op":"reset"})");
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.output.last("grabs")["grabs"].size() == 1);
}

}  // namespace
}  // namespace weft::server
