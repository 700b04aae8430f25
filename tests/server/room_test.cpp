#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;

std::string hash_of(const Room& room) {
  return proto::hash_text(room.world().hash());
}

TEST_CASE("a viewer that joins hears welcome, mesh, state, roster, pins, grabs in this order") {
  TestRoom t;
  t.join(1);
  std::vector<std::string> ops;
  for (const auto& [viewer, text] : t.output.sent)
    if (viewer == 1) ops.push_back(json::parse(text)["op"]);
  CHECK(ops == std::vector<std::string>{"welcome", "mesh", "state", "roster", "pins", "grabs"});
  CHECK(t.output.binary.size() == 1);
}

TEST_CASE("who joins while the room is paused still gets a frame") {
  TestRoom t;
  t.join(1);
  t.room->finish_turn();
  REQUIRE(t.output.frames.size() == 1);
  t.join(2);
  t.clock.now += 0.1;
  t.room->finish_turn();
  CHECK(t.output.frames.size() == 2);
}

TEST_CASE("no frame is encoded while nobody wants one") {
  TestRoom t(false);
  t.output.viewers_want_frames = false;
  t.tick(60);
  CHECK(t.room->frames_encoded() == 0);
  t.output.viewers_want_frames = true;
  t.tick(1);
  CHECK(t.room->frames_encoded() == 1);
}

TEST_CASE("each tick is encoded once, however many viewers there are") {
  TestRoom t(false);
  for (proto::ViewerId viewer = 1; viewer <= 20; ++viewer) t.join(viewer);
  const std::uint64_t before = t.room->frames_encoded();
  t.tick(10);
  CHECK(t.room->frames_encoded() == before + 10);
}

TEST_CASE("advance twice from the start gives the same hash") {
  TestRoom t;
  t.join(1);
  const json first = t.say(1, R"({"op":"advance","id":1,"n":200})");
  CHECK(first["tick"] == 200);
  CHECK(first["hash"] == hash_of(*t.room));
  t.say(1, R"({"op":"reset"})");
  const json second = t.say(1, R"({"op":"advance","id":2,"n":200})");
  CHECK(second["hash"] == first["hash"]);
  CHECK(t.say(1, R"({"op":"advance","id":3,"n":1})")["hash"] != first["hash"]);
}

TEST_CASE("ticks by the clock and ticks by advance lead to the same state") {
  TestRoom clocked(false), stepped;
  clocked.tick(90);
  stepped.join(1);
  stepped.say(1, R"({"op":"advance","n":90})");
  CHECK(hash_of(*clocked.room) == hash_of(*stepped.room));
}

TEST_CASE("scene and log are the whole history: replaying them gives the same hash") {
  TestRoom t(false);
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"drag","phase":"start","drag":5,"particle":38,"target":[0.3,1,0.4]})");
  t.tick(20);
  t.say(2, R"({"op":"drag","phase":"start","particle":22})");
  t.say(2, R"({"op":"set","wind":[2,0,1],"gust_speed":1})");
  t.tick(30);
  t.say(1, R"({"op":"drag","phase":"move","drag":5,"target":[-0.3,1.2,0.1]})");
  t.say(2, R"({"op":"pin","particle":20,"radius":0.05})");
  t.say(2, R"({"op":"move","pin":3,"position":[0,0.8,0.1],"seconds":0.7,"max_force":9})");
  t.say(1, R"({"op":"move","pin":1,"position":[-0.2,1.2,0.1],"speed":0.1})");
  t.tick(10);
  t.say(1, R"({"op":"move","pin":1,"stop":true})");
  t.leave(2);
  t.tick(100);  // 1.67 s: the lease of viewer 1 still holds
  REQUIRE(t.room->world().grabs().list.size() == 1);
  t.tick(40);  // and now it does not
  REQUIRE(t.room->world().grabs().list.empty());
  t.say(1, R"({"op":"release","pin":3})");
  t.tick(25);

  TestRoom replay;
  replay.join(1);
  replay.join(2);
  for (const LogEntry& entry : t.room->log().entries()) {
    while (replay.room->world().tick() < entry.tick) replay.tick(1);
    replay.room->take({entry.viewer, 1, proto::Request{std::nullopt, entry.command}});
  }
  while (replay.room->world().tick() < t.room->world().tick()) replay.tick(1);
  CHECK(hash_of(*replay.room) == hash_of(*t.room));
}

TEST_CASE("the log gives every accepted command one place, and refused ones none") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"pin","particle":3})");
  t.say(2, R"({"op":"pin","particle":4})");
  t.say(2, R"({"op":"pin","particle":4000})");
  t.say(1, R"({"op":"advance","n":3})");
  t.say(1, R"({"op":"release","all":true})");
  const auto& entries = t.room->log().entries();
  REQUIRE(entries.size() == 4);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    CHECK(entries[i].index == i);
    if (i > 0) CHECK(entries[i].tick >= entries[i - 1].tick);
  }
  CHECK(entries[1].viewer == 2);
  CHECK(entries[3].tick == 3);
}

TEST_CASE("a drag without a message for 2 s ends by a command in the log, and its viewer is told") {
  TestRoom t(false);
  t.join(1);
  const json start = t.say(1, R"({"op":"drag","id":1,"phase":"start","drag":9,"particle":38})");
  CHECK(start["op"] == "result");
  t.tick(119);
  CHECK(t.room->world().grabs().list.size() == 1);
  t.tick(2);
  CHECK(t.room->world().grabs().list.empty());
  const LogEntry& entry = t.room->log().entries().back();
  CHECK(entry.origin == CommandOrigin::lease);
  CHECK(std::holds_alternative<proto::DragEnd>(entry.command));
  const json notice = t.output.last("notice");
  CHECK(notice["code"] == "lease_expired");
  CHECK(notice["viewer"] == 1);
  CHECK(notice["drag"] == 9);
  CHECK(t.output.last("grabs")["grabs"].empty());
  CHECK(t.say(1, R"({"op":"drag","id":2,"phase":"move","drag":9,"target":[0,0,0]})")["code"] ==
        "unknown_drag");
}

TEST_CASE("repeating the target keeps a drag") {
  TestRoom t(false);
  t.join(1);
  t.say(1, R"({"op":"drag","phase":"start","particle":38})");
  for (int i = 0; i < 10; ++i) {
    t.tick(60);
    t.say(1, R"({"op":"drag","phase":"move","target":[0,0.5,0]})");
  }
  CHECK(t.room->world().grabs().list.size() == 1);
}

TEST_CASE("leases do not run out during pause and advance") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"drag","phase":"start","particle":38})");
  for (int i = 0; i < 20; ++i) {
    t.clock.now += 1;
    t.room->finish_turn();
  }
  t.say(1, R"({"op":"advance","n":600})");
  CHECK(t.room->world().grabs().list.size() == 1);
  t.say(1, R"({"op":"resume"})");
  t.tick(119);
  CHECK(t.room->world().grabs().list.size() == 1);
  t.tick(3);
  CHECK(t.room->world().grabs().list.empty());
}

TEST_CASE("a viewer that leaves lets go of its hands and of nobody else's; its pins stay") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":38})");
  t.say(1, R"({"op":"drag","phase":"start","drag":2,"particle":36})");
  t.say(2, R"({"op":"drag","phase":"start","drag":1,"particle":22})");
  t.say(1, R"({"op":"pin","particle":20})");
  t.leave(1);
  t.room->finish_turn();
  REQUIRE(t.output.last("grabs")["grabs"].size() == 1);
  CHECK(t.output.last("grabs")["grabs"][0]["viewer"] == 2);
  CHECK(t.output.last("pins")["pins"].size() == 3);
  CHECK(t.output.last("roster")["viewers"].size() == 1);
  CHECK(t.room->log().entries().back().origin == CommandOrigin::leave);
}

TEST_CASE("no command changes a position by itself; only ticks do") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":10})");
  const Vec3Array<float> before = t.room->world().state().x;
  const std::vector<std::string> commands = {
      R"({"op":"drag","phase":"start","drag":1,"particle":38,"target":[9,9,9],"stiffness":100000,"max_force":1000000})",
      R"({"op":"drag","phase":"move","drag":1,"target":[-9,0,100]})",
      R"({"op":"pin","particle":20,"radius":0.2})",
      R"({"op":"release","all":true})",
      R"({"op":"set","gravity":[0,1000,0],"wind":[100,0,0]})",
      R"({"op":"speed","speed":10})",
      R"({"op":"move","collider":"ball","position":[0,0.9,0],"speed":20})",
      R"({"op":"camera","position":[0,0,1],"target":[0,0,0]})",
      R"({"op":"drag","phase":"end","drag":1})"};
  for (const std::string& command : commands) t.say(1, command);
  CHECK(t.output.count("error") == 0);
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(before[i] == t.room->world().state().x[i]);
}

TEST_CASE("neither commands of others nor who joins wait for the end of an advance") {
  TestRoom t;
  t.join(1);
  t.join(2);
  const auto send = [&t](proto::ViewerId viewer, const std::string& text) {
    t.room->take({viewer, 1, *proto::parse_request(text)});
  };
  send(1, R"({"op":"advance","id":1,"n":50})");
  REQUIRE(t.room->advancing());
  send(2, R"({"op":"hash","id":2})");
  CHECK(t.output.last("result", 2)["tick"] == 0);
  t.join(3);
  CHECK(t.output.sent.back().first == 3);
  t.room->advance_until(t.clock.now + 1);
  CHECK(t.output.last("result", 1)["tick"] == 50);
  send(2, R"({"op":"hash","id":3})");
  CHECK(t.output.last("result", 3)["hash"] == t.output.last("result", 1)["hash"]);
}

TEST_CASE("an advance stops when its viewer leaves, and the others go on") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.room->take({1, 1, *proto::parse_request(R"({"op":"advance","id":1,"n":100000})")});
  t.room->take({2, 1, *proto::parse_request(R"({"op":"hash","id":2})")});
  t.room->advance_until(t.clock.now);
  t.leave(1);
  CHECK_FALSE(t.room->advancing());
  CHECK(t.output.last("result", 2)["tick"] == 0);
  CHECK(t.output.last("result", 1).is_null());
}

TEST_CASE("step lets exactly its ticks pass, and steps add up") {
  TestRoom t;
  t.join(1);
  CHECK_FALSE(t.room->ticking());
  CHECK(t.say(1, R"({"op":"step","id":1,"n":3})")["until"] == 3);
  CHECK(t.say(1, R"({"op":"step","id":2,"n":2})")["until"] == 5);
  int ticks = 0;
  while (t.room->ticking()) {
    t.tick(1);
    ++ticks;
  }
  CHECK(ticks == 5);
  CHECK(t.say(1, R"({"op":"resume","id":3})")["paused"] == false);
  CHECK(t.say(1, R"({"op":"step","id":4})")["code"] == "not_paused");
  CHECK(t.say(1, R"({"op":"advance","id":5,"n":1})")["code"] == "not_paused");
}

TEST_CASE("another hand on a held particle is refused, the holder's own is not") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":38})");
  CHECK(t.say(2, R"({"op":"drag","id":1,"phase":"start","particle":38})")["code"] == "held");
  CHECK(t.say(2, R"({"op":"drag","id":2,"phase":"start","particle":22})")["op"] == "result");
  CHECK(t.say(1, R"({"op":"drag","id":3,"phase":"start","drag":2,"particle":38})")["op"] ==
        "result");
  CHECK(t.say(1, R"({"op":"drag","id":4,"phase":"start","drag":1,"particle":3})")["code"] ==
        "drag_exists");
}

TEST_CASE("the frame after a reset is marked as a jump, the next one is not") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":5})");
  t.clock.now += 1;
  t.say(1, R"({"op":"reset"})");
  const auto flags = [&t] { return static_cast<unsigned>(t.output.frames.back()[3]); };
  CHECK(flags() == (proto::kFrameKey | proto::kFrameJump | proto::kFramePaused));
  t.clock.now += 1;
  t.say(1, R"({"op":"pin","particle":9})");
  CHECK(flags() == (proto::kFrameKey | proto::kFramePaused));
}

TEST_CASE("load announces the new mesh to all before anything of the new epoch") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"drag","phase":"start","particle":38})");
  t.output.sent.clear();
  const json result = t.say(1, R"({"op":"load","id":1,"scene":"other"})");
  CHECK(result["epoch"] == 2);
  CHECK(json::parse(t.output.sent[0].second)["op"] == "mesh");
  CHECK(json::parse(t.output.sent[0].second)["vertices"] == 35);
  CHECK(t.output.last("grabs")["grabs"].empty());
  CHECK(t.say(1, R"({"op":"load","id":2,"scene":"nowhere"})")["code"] == "unknown_scene");
  CHECK(t.room->epoch() == 2);
}

std::vector<proto::AppliedCommand> applied_in(const std::string& bytes) {
  const auto frame = proto::decode_frame(std::as_bytes(std::span(bytes.data(), bytes.size())));
  REQUIRE(frame);
  return frame->applied;
}

TEST_CASE("frames tell the number of the last message that they include") {
  TestRoom t;
  t.join(4);
  t.room->take({4, 6, *proto::parse_request(R"({"op":"pin","particle":9})")});
  t.room->take({4, 7, Noted{}});
  t.clock.now += 1;
  t.room->finish_turn();
  CHECK(applied_in(t.output.frames.back()) == std::vector<proto::AppliedCommand>{{4, 7}});
}

TEST_CASE("a frame tells the pause that ended an advance, not what that overtook") {
  TestRoom t;
  t.join(4);
  t.tell(4, R"({"op":"advance","n":100000})");
  t.room->advance_until(0);
  t.tell(4, R"({"op":"hash"})");
  t.tell(4, R"({"op":"pause"})");
  CHECK_FALSE(t.room->advancing());
  t.clock.now += 1;
  t.room->finish_turn();
  CHECK(applied_in(t.output.frames.back()) == std::vector<proto::AppliedCommand>{{4, 3}});
}

TEST_CASE("set is all or nothing, and pins, drags and particles that do not exist are refused") {
  TestRoom t;
  t.join(1);
  const std::string before = hash_of(*t.room);
  const std::vector<std::pair<std::string, std::string>> table = {
      {R"({"op":"pin","id":0,"particle":42})", "out_of_range"},
      {R"({"op":"pin","id":0,"triangle":60,"barycentric":[1,0,0]})", "out_of_range"},
      {R"({"op":"release","id":0,"particle":42})", "out_of_range"},
      {R"({"op":"release","id":0,"pin":77})", "unknown_pin"},
      {R"({"op":"drag","id":0,"phase":"start","particle":42})", "out_of_range"},
      {R"({"op":"drag","id":0,"phase":"move","drag":1,"target":[0,0,0]})", "unknown_drag"},
      {R"({"op":"drag","id":0,"phase":"end","drag":1})", "unknown_drag"},
      {R"({"op":"query","id":0,"what":"camera","viewer":9})", "unknown_viewer"}};
  for (const auto& [command, code] : table) {
    CAPTURE(command);
    t.output.sent.clear();
    CHECK(t.say(1, command)["code"] == code);
  }
  CHECK(hash_of(*t.room) == before);
}

TEST_CASE("there is a limit on the drags of one viewer and on pins") {
  TestRoom t;
  t.join(1);
  for (int drag = 0; drag < 16; ++drag)
    t.say(1, R"({"op":"drag","phase":"start","particle":20,"drag":)" + std::to_string(drag) + "}");
  CHECK(t.room->world().grabs().list.size() == 16);
  CHECK(t.say(1, R"({"op":"drag","id":1,"phase":"start","particle":20,"drag":16})")["code"] ==
        "too_many");
  // In one turn, because each turn tells everybody all pins.
  const proto::Request pin = *proto::parse_request(R"({"op":"pin","particle":20})");
  for (int count = 0; count < 4094; ++count) t.room->take({1, ++t.number, pin});
  CHECK(t.say(1, R"({"op":"pin","id":2,"particle":20})")["code"] == "too_many");
}

TEST_CASE("a divergence is told to everybody and the cloth stays finite") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":5})");
  // No command makes a velocity that is not finite, so the test puts one there itself.
  const_cast<ServedWorld&>(t.room->world()).state().v[20][1] = NAN;
  t.say(1, R"({"op":"advance","n":1})");
  for (const Vec3f& x : t.room->world().state().x) CHECK(x.allFinite());
  const json notice = t.output.last("notice");
  REQUIRE(notice.is_object());
  CHECK(notice["code"] == "recovered");
  CHECK(notice["level"] == "warning");
}

}  // namespace
}  // namespace weft::server
