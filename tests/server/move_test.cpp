#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

// Objects and pins that a viewer moves.

namespace weft::server {
namespace {

using nlohmann::json;

std::string hash_of(const Room& room) {
  return proto::hash_text(room.world().hash());
}

TEST_CASE("an object that is forced through the cloth is told of once") {
  TestRoom t;
  t.join(1);
  for (int i = 0; i < 42; ++i) t.say(1, json{{"op", "pin"}, {"particle", i}}.dump());
  const auto told = [&t] {
    int count = 0;
    for (const auto& [viewer, text] : t.output.sent)
      count += json::parse(text).value("code", "") == "guarantee_void" ? 1 : 0;
    return count;
  };
  t.say(1, R"({"op":"move","collider":"ball","position":[0,1.2,0],"speed":5})");
  t.say(1, R"({"op":"advance","n":60})");
  CHECK(told() == 0);
  const auto ball = [&t] {
    return t.say(1, R"({"op":"query","id":4,"what":"colliders"})")["data"][1];
  };
  CHECK(ball()["voided"] == false);
  CHECK(ball()["position"][1].get<double>() < 1);
  t.say(1, R"({"op":"move","collider":"ball","position":[0,1.2,0],"speed":5,"force":true})");
  t.say(1, R"({"op":"advance","n":60})");
  CHECK(told() == 1);
  CHECK(ball()["voided"] == true);
  CHECK(ball()["position"][1].get<double>() == Approx(1.2));
  t.say(1, R"({"op":"reset"})");
  CHECK(ball()["voided"] == false);
}

TEST_CASE("a cloth that starts inside an object is named, and told of again when it is out") {
  TestRoom t;
  RoomOptions options;
  options.scene = "inside";
  options.scene_names = {"inside"};
  options.paused = true;
  const auto inside = [](const std::string&) {
    WorldDef def;
    ClothDef& cloth = def.cloths[0];
    cloth.name = "scarf";
    cloth.rows = cloth.columns = 9;
    cloth.width = cloth.height = 0.4;
    cloth.origin = Vec3d(-0.2, 0.5, -0.2);
    cloth.v = Vec3d::UnitZ();
    def.colliders = {{"ball", SphereDef{Vec3d(0, 0.5, 0), 0.1}}};
    return def;
  };
  t.room = std::make_unique<Room>(options, inside, t.output, t.clock.clock(), t.metrics);
  t.join(1);
  const auto told = [&t](const std::string& code) {
    std::string messages;
    for (const auto& [viewer, text] : t.output.sent) {
      const json message = json::parse(text);
      if (message.value("code", "") == code) messages += message.value("message", "");
    }
    return messages;
  };
  t.say(1, R"({"op":"advance","n":1})");
  CHECK_THAT(told("guarantee_void"), Catch::StartsWith("scarf started inside ball"));
  CHECK(told("guarantee_back").empty());
  t.say(1, R"({"op":"advance","n":120})");
  CHECK_FALSE(told("guarantee_back").empty());
}

TEST_CASE("a collider is moved by name, seen in frames and queries, and told wrong names") {
  TestRoom t;
  t.join(1);
  const std::string at_start = hash_of(*t.room);
  const json unknown =
      t.say(1, R"({"op":"move","id":1,"collider":"bal","position":[0,1,0],"speed":1})");
  CHECK(unknown["code"] == "unknown_collider");
  CHECK(unknown["field"] == "collider");
  CHECK(unknown["limit"]["allowed"] == json{"floor", "ball"});
  const json turned =
      t.say(1, R"({"op":"move","id":2,"collider":"floor","rotation":[0,0.6,0,0.8]})");
  CHECK(turned["code"] == "out_of_range");
  CHECK(turned["field"] == "rotation");
  CHECK(hash_of(*t.room) == at_start);

  const auto poses = [&t] {
    t.clock.now += 0.1;
    t.room->finish_turn();
    const std::string& bytes = t.output.frames.back();
    return proto::decode_frame(std::as_bytes(std::span(bytes)))->poses;
  };
  t.tick(1);
  CHECK(poses().empty());
  const json moved =
      t.say(1, R"({"op":"move","id":3,"collider":"ball","position":[0.5,-1,0],"speed":0.5})");
  CHECK(moved["collider"] == "ball");
  t.say(1, R"({"op":"advance","n":30})");
  REQUIRE(poses().size() == 1);
  CHECK(poses()[0].collider == 1);
  CHECK(poses()[0].position[0] == Approx(0.25));
  CHECK(poses()[0].rotation == proto::Quatf{0, 0, 0, 1});
  const json asked = t.say(1, R"({"op":"query","id":4,"what":"colliders"})")["data"];
  CHECK(asked[0]["name"] == "floor");
  CHECK(asked[1]["position"][0].get<double>() == Approx(0.25));
  CHECK(asked[1]["blocked"] == false);

  t.say(1, R"({"op":"move","collider":"ball","release":true})");
  t.say(1, R"({"op":"advance","n":30})");
  CHECK(poses()[0].position[0] == Approx(0.25));
  t.say(1, R"({"op":"reset"})");
  CHECK(poses().empty());
  CHECK(hash_of(*t.room) == at_start);
}

/// The pins of a room by their ids, as a query tells them.
json pins_of(TestRoom& t) {
  const json answer = t.say(1, R"({"op":"query","id":90,"what":"pins"})");
  json pins;
  for (const json& pin : answer["data"]) pins[pin["id"].dump()] = pin;
  return pins;
}

TEST_CASE("a collider is moved by its place in the mesh message, whatever its name") {
  const auto two_balls = [](const std::string&) {
    WorldDef def = small_scene("small");
    for (ColliderDef& collider : def.colliders) collider.name = "";
    def.colliders.push_back({"", SphereDef{Vec3d(0, -1.5, 0), 0.1}});
    return def;
  };
  TestRoom t;
  RoomOptions options;
  options.paused = true;
  t.room = std::make_unique<Room>(options, two_balls, t.output, t.clock.clock(), t.metrics);
  t.join(1);
  const json ask = {{"op", "query"}, {"id", 9}, {"what", "colliders"}};
  const json before = t.say(1, ask.dump())["data"];
  const json moved =
      t.say(1, R"({"op":"move","id":1,"collider":2,"position":[0.5,-1.5,0],"speed":1})");
  CHECK(moved["collider"] == 2);
  t.say(1, R"({"op":"advance","n":60})");
  const json after = t.say(1, ask.dump())["data"];
  CHECK(after[0]["position"] == before[0]["position"]);
  CHECK(after[1]["position"] == before[1]["position"]);
  CHECK(after[2]["position"][0].get<double>() == Approx(0.5));

  const std::string hash = hash_of(*t.room);
  const json beyond = t.say(1, R"({"op":"move","id":3,"collider":3,"release":true})");
  CHECK(beyond["code"] == "unknown_collider");
  CHECK(beyond["limit"]["maximum"] == 2);
  CHECK(hash_of(*t.room) == hash);
}

TEST_CASE("a pin is moved by its id within its time, is told when it goes and when it is there") {
  TestRoom t;
  t.join(1);
  const json before = pins_of(t)["2"];
  CHECK_FALSE(before.contains("target"));
  const json moved =
      t.say(1, R"({"op":"move","id":1,"pin":2,"position":[0.2,1.1,0.3],"seconds":1})");
  CHECK(moved["command"] == "move");
  CHECK(moved["pin"] == 2);
  CHECK(moved["position"] == before["position"]);
  const json target = {0.2, 1.1, 0.3};
  CHECK(t.output.last("pins")["pins"][1]["target"] == target);
  CHECK(t.output.count("pins") == 2);  // on joining, and now
  t.say(1, R"({"op":"advance","n":30})");
  const json under_way = pins_of(t)["2"];
  CHECK(under_way["target"] == target);
  CHECK(under_way["behind"] == false);
  CHECK(under_way["position"][2].get<double>() > 0.1);
  CHECK(under_way["position"][2].get<double>() < 0.2);
  CHECK(t.output.count("pins") == 2);
  t.say(1, R"({"op":"advance","n":30})");
  CHECK(t.output.count("pins") == 3);
  const json there = t.output.last("pins")["pins"][1];
  CHECK_FALSE(there.contains("target"));
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(there["position"][i].get<double>() == Approx(target[i].get<double>()));
  // And back to where the answer said that it was.
  t.say(1, json{{"op", "move"}, {"pin", 2}, {"position", moved["position"]}}.dump());
  t.say(1, R"({"op":"advance","n":60})");
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(pins_of(t)["2"]["position"][i].get<double>() ==
          Approx(before["position"][i].get<double>()).margin(1e-5));
}

TEST_CASE(
    "a pin that is stopped stays where it is, one that is blocked says so, reset undoes all") {
  TestRoom t;
  t.join(1);
  const std::string at_start = hash_of(*t.room);
  const json before = pins_of(t);
  t.say(1, R"({"op":"move","pin":1,"position":[-0.25,1,1],"speed":1})");
  t.say(1, R"({"op":"move","collider":"ball","position":[0.25,0.8,0.3],"speed":20})");
  t.say(1, R"({"op":"advance","n":20})");
  const json stopped = t.say(1, R"({"op":"move","id":1,"pin":1,"stop":true})");
  CHECK(stopped["position"][2].get<double>() > 0.1);
  CHECK_FALSE(t.output.last("pins")["pins"][0].contains("target"));
  // The other one is sent to the middle of the ball.
  t.say(1, R"({"op":"move","pin":2,"position":[0.25,0.8,0.3],"max_force":5})");
  t.say(1, R"({"op":"advance","n":120})");
  CHECK(pins_of(t)["1"]["position"] == stopped["position"]);
  // Pressed against the ball it gives way and catches up again, tick by tick.
  bool behind = false;
  for (int tick = 0; tick < 30 && !behind; ++tick) {
    t.say(1, R"({"op":"advance","n":1})");
    behind = pins_of(t)["2"]["behind"].get<bool>();
  }
  CHECK(behind);
  t.say(1, R"({"op":"reset"})");
  const json after = pins_of(t);  // their ids are new
  REQUIRE(after.size() == before.size());
  for (auto a = after.begin(), b = before.begin(); a != after.end(); ++a, ++b) {
    CHECK((*a)["position"] == (*b)["position"]);
    CHECK_FALSE(a->contains("target"));
  }
  CHECK(hash_of(*t.room) == at_start);
}

TEST_CASE("a pin that does not exist or cannot be there in time is refused, and nothing changes") {
  TestRoom t;
  t.join(1);
  const std::string before = hash_of(*t.room);
  const json unknown = t.say(1, R"({"op":"move","id":1,"pin":7,"position":[0,1,0]})");
  CHECK(unknown["code"] == "unknown_pin");
  CHECK(unknown["field"] == "pin");
  CHECK(unknown["value"] == 7);
  CHECK(t.say(1, R"({"op":"move","id":2,"pin":7,"stop":true})")["code"] == "unknown_pin");
  json command = {{"op", "move"}, {"id", 3}, {"pin", 1}, {"position", {-0.25, 1, 2.5}}};
  command["seconds"] = 0.2;
  const json late = t.say(1, command.dump());
  CHECK(late["code"] == "out_of_range");
  CHECK(late["field"] == "seconds");
  CHECK(late["value"] == 0.2);
  CHECK(late["hint"] == "it has 2.5 m to go");
  CHECK(hash_of(*t.room) == before);
  CHECK(t.room->log().entries().empty());
  command["seconds"] = late["limit"]["minimum"];
  CHECK(t.say(1, command.dump())["op"] == "result");
}

}  // namespace
}  // namespace weft::server
