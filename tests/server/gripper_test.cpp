#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "tests/server/fakes.h"

// A gripper by command.

namespace weft::server {
namespace {

using nlohmann::json;

/// A room with the scene of the gripper.
struct GripperRoom : TestRoom {
  GripperRoom() {
    RoomOptions options;
    options.scene = "gripper";
    options.paused = true;
    room = std::make_unique<Room>(
        options, [](const std::string& name) { return make_scene(name); }, output, clock.clock(),
        metrics);
    join(1);
  }
  json gripper() { return say(1, R"({"op":"query","id":90,"what":"grippers"})")["data"][0]; }
};

TEST_CASE("a gripper closes, lifts and opens by command, and tells what it carries") {
  GripperRoom t;
  const json answer = t.say(1, R"({"op":"gripper","id":1,"name":"gripper","opening":0,"force":4})");
  CHECK(answer["command"] == "gripper");
  CHECK(answer["gripper"] == "gripper");
  t.say(1, R"({"op":"advance","n":120})");
  CHECK(t.gripper()["gripping"] == true);
  CHECK(t.gripper()["force"] == 4);
  const double height = t.gripper()["position"][1];
  const json position = {0.28, height + 0.5, 0};
  t.say(1,
        json{{"op", "gripper"}, {"name", "gripper"}, {"position", position}, {"speed", 1}}.dump());
  t.say(1, R"({"op":"advance","n":240})");
  CHECK(t.gripper()["position"] == position);
  double mass = 0;
  for (const float m : t.room->world().model().mass) mass += static_cast<double>(m);
  CHECK(-t.gripper()["reaction"][1].get<double>() == Approx(mass * 9.81).epsilon(0.1));
  t.say(1, R"({"op":"gripper","name":"gripper","opening":0.05})");
  t.say(1, R"({"op":"advance","n":60})");
  CHECK(t.gripper()["gripping"] == false);
  CHECK(t.gripper()["opening"].get<double>() == Approx(0.05));
}

TEST_CASE("an unknown gripper and a moved or released jaw are refused, and nothing changes") {
  GripperRoom t;
  const std::uint64_t before = t.room->world().hash();
  const json unknown = t.say(1, R"({"op":"gripper","id":1,"name":"hand","opening":0})");
  CHECK(unknown["code"] == "unknown_gripper");
  CHECK(unknown["field"] == "name");
  CHECK(unknown["limit"]["allowed"] == json{"gripper"});
  // Jaws are not among the objects that are offered.
  const json none = t.say(1, R"({"op":"move","id":4,"collider":"hand","position":[0,1,0]})");
  CHECK(none["code"] == "unknown_collider");
  for (const json& offered : none["limit"]["allowed"])
    CHECK_THAT(offered.get<std::string>(), !Catch::Contains("gripper"));
  const json jaw = t.say(1, R"({"op":"move","id":2,"collider":"gripper.left","position":[0,1,0]})");
  CHECK(jaw["code"] == "out_of_range");
  CHECK(jaw["field"] == "collider");
  for (const char* name : {"gripper.left", "gripper.right"}) {
    const json released =
        t.say(1, json{{"op", "move"}, {"id", 3}, {"collider", name}, {"release", true}}.dump());
    CHECK(released["code"] == "out_of_range");
    CHECK(released["field"] == "collider");
    CHECK(released["value"] == name);
    CHECK_THAT(released["hint"].get<std::string>(), Catch::Contains("gripper"));
  }
  CHECK(t.room->world().hash() == before);
  CHECK(t.room->log().entries().empty());
}

}  // namespace
}  // namespace weft::server
