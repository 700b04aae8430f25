#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;

/// A room whose cloth comes to rest soon, and then sleeps.
struct SleepyRoom : TestRoom {
  explicit SleepyRoom(bool paused = false)
      : TestRoom(paused, {{"environment.drag", "10"}, {"sleep.after", "0.5"}}) {
    join(1);
  }

  void fall_asleep() {
    for (int k = 0; k < 600 && !room->world().sleep().all_asleep(); ++k) tick(1);
    REQUIRE(room->world().sleep().all_asleep());
  }
};

TEST_CASE("a sleeping room sends neither frames nor state, and answers a query") {
  SleepyRoom t;
  t.fall_asleep();
  const std::size_t frames = t.output.frames.size(), messages = t.output.sent.size();
  CHECK(t.output.last("state")["sleeping"] == json::parse(R"({"islands":1,"cloths":["cloth"]})"));
  const std::uint64_t tick = t.room->world().tick();
  t.tick(300);
  CHECK(t.room->world().tick() == tick + 300);
  CHECK(t.output.frames.size() == frames);
  CHECK(t.output.sent.size() == messages);
  const json reply = t.say(1, R"({"op":"query","id":1,"what":"state"})");
  CHECK(reply["data"]["tick"] == tick + 300);
  CHECK(reply["data"]["sleeping"]["cloths"] == json({"cloth"}));
  CHECK(reply["data"]["substeps"] == 0);
  CHECK(t.say(1, R"({"op":"query","id":2,"what":"positions"})")["data"].size() == 42);
  const json work = t.say(1, R"({"op":"query","id":3,"what":"work"})")["data"];
  for (const json& stage : work) CHECK(stage["work"] == 0);
  CHECK(t.say(1, R"({"op":"hash","id":4})")["hash"] == proto::hash_text(t.room->world().hash()));
  CHECK(t.output.frames.size() == frames);
}

TEST_CASE("the last frame before a room sleeps shows where its cloth stays") {
  SleepyRoom t;
  t.fall_asleep();
  const std::string last = t.output.frames.back();
  t.tick(100);
  t.join(2);
  t.tick(1);
  REQUIRE(t.output.frames.back() != last);  // its tick at least
  const auto positions = [](const std::string& bytes) {
    const auto frame = proto::decode_frame(std::as_bytes(std::span(bytes)));
    REQUIRE(frame);
    return frame->positions;
  };
  CHECK(positions(last) == positions(t.output.frames.back()));
}

TEST_CASE("who joins a sleeping room gets one frame, and nobody is woken") {
  SleepyRoom t;
  t.fall_asleep();
  t.tick(10);
  const std::size_t frames = t.output.frames.size();
  t.join(2);
  t.tick(10);
  CHECK(t.output.frames.size() == frames + 1);
  CHECK(t.output.last("state")["sleeping"]["islands"] == 1);
  CHECK(t.room->world().report().rested);
}

TEST_CASE("a hand wakes a room: frames and state come again, until it sleeps again") {
  SleepyRoom t;
  t.fall_asleep();
  t.tick(10);
  const std::size_t frames = t.output.frames.size();
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":38,"target":[0.1,0.5,0.2]})");
  t.tick(30);
  CHECK(t.output.frames.size() >= frames + 30);
  CHECK(t.output.last("state")["sleeping"]["cloths"].empty());
  t.say(1, R"({"op":"drag","phase":"end","drag":1})");
  t.fall_asleep();
  t.tick(1);
  CHECK(t.output.last("state")["sleeping"]["islands"] == 1);
}

TEST_CASE("an object that moves past sleeping cloth is seen") {
  SleepyRoom t;
  t.fall_asleep();
  t.tick(10);
  const std::size_t frames = t.output.frames.size();
  t.say(1, R"({"op":"move","collider":"ball","position":[1,-1,0],"speed":1})");
  t.tick(30);
  CHECK(t.output.frames.size() >= frames + 30);
  CHECK(t.room->world().sleep().all_asleep());
}

TEST_CASE("advance through sleep gives the hash that ticks by the clock give") {
  SleepyRoom clocked, stepped(true);
  clocked.tick(600);
  const json reply = stepped.say(1, R"({"op":"advance","id":1,"n":600})");
  REQUIRE(clocked.room->world().report().rested);
  CHECK(reply["hash"] == proto::hash_text(clocked.room->world().hash()));
}

TEST_CASE("the last tick of an advance is shown, even if its cloth fell asleep before it") {
  SleepyRoom t(true);
  t.tell(1, R"({"op":"advance","id":1,"n":600})");
  while (t.room->advancing()) {
    t.room->advance_until(t.clock.now);  // one tick
    t.clock.now += t.room->tick_interval();
    t.room->finish_turn();
  }
  t.clock.now += t.room->tick_interval();
  t.room->finish_turn();
  REQUIRE(t.room->world().report().rested);
  const auto last = proto::decode_frame(std::as_bytes(std::span(t.output.frames.back())));
  REQUIRE(last);
  CHECK(last->header.tick == t.room->world().tick());
}

TEST_CASE("ticks of a sleeping room are counted, as such") {
  SleepyRoom t;
  t.fall_asleep();
  t.tick(25);
  CHECK(t.metrics.text().find("weft_ticks_rested_total 25\n") != std::string::npos);
  CHECK(t.metrics.text().find("weft_cloths_asleep 1\n") != std::string::npos);
  t.say(1, R"({"op":"reset"})");
  t.tick(1);
  CHECK(t.metrics.text().find("weft_cloths_asleep 0\n") != std::string::npos);
}

TEST_CASE("a budget does not take sleep for cloth that has become cheap") {
  SleepyRoom t;
  t.say(1, R"({"op":"set","budget_ms":1,"over_budget":"soften","softness":1})");
  t.clock.between_reads = [&t] { return t.room->world().sleep().all_asleep() ? 0.0 : 0.002; };
  t.tick(40);
  const double softness = t.room->world().softness();
  REQUIRE(softness < 1);
  t.fall_asleep();
  for (int k = 0; k < 200; ++k) {
    t.tick(1);
    REQUIRE(t.room->world().report().rested);
  }
}

TEST_CASE("the default scene in calm air settles and sends nothing; a touch wakes it") {
  TestRoom t;
  RoomOptions options;
  options.scene = "default";
  const auto scene = [](const std::string& name) { return make_scene(name); };
  t.room = std::make_unique<Room>(options, scene, t.output, t.clock.clock(), t.metrics);
  t.join(1);
  t.tick(60);
  CHECK(t.output.frames.size() == 1 + 60);
  t.say(1, R"({"op":"set","wind":[0,0,0],"gust_speed":0,"drag":2})");
  for (int k = 0; k < 1800 && !t.room->world().sleep().all_asleep(); ++k) t.tick(1);
  REQUIRE(t.room->world().sleep().all_asleep());
  const std::size_t frames = t.output.frames.size(), messages = t.output.sent.size();
  t.tick(120);
  CHECK(t.room->world().report().rested);
  CHECK(t.output.frames.size() == frames);
  CHECK(t.output.sent.size() == messages);
  const json before = t.say(1, R"({"op":"query","id":1,"what":"positions"})")["data"][310];
  t.say(1, R"({"op":"drag","phase":"start","particle":310,"target":[0,1,1]})");
  t.tick(30);
  CHECK(t.output.frames.size() >= frames + 30);
  CHECK(t.output.last("state")["sleeping"]["cloths"].empty());
  const json after = t.say(1, R"({"op":"query","id":2,"what":"positions"})")["data"][310];
  CHECK(std::abs(after[2].get<double>() - before[2].get<double>()) > 0.05);
}

}  // namespace
}  // namespace weft::server
