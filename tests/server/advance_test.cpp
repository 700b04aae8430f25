#include <set>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

// Which frames the ticks of an `advance` make.

namespace weft::server {
namespace {

using nlohmann::json;

constexpr double kTick = 1.0 / 60;  // of the test's scenes [s]

proto::Frame decoded(const std::string& bytes) {
  return *proto::decode_frame(std::as_bytes(std::span(bytes)));
}

/// Runs an `advance` to its end, a millisecond a tick, and forgets what was said before.
struct AdvancingRoom : TestRoom {
  AdvancingRoom() {
    join(1);
    join(2);
    tell(1, R"({"op":"drag","phase":"start","particle":38})");
    clock.now += 1;
    room->finish_turn();
    clock.between_reads = [] { return 0.0005; };
  }
  /// One message, after which the room finishes its turn as it does when one comes alone.
  void turn(const std::string& text) {
    tell(1, text);
    room->finish_turn();
  }
  json advance(int n, const std::string& frames = "") {
    const std::string field = frames.empty() ? "" : R"(,"frames":")" + frames + '"';
    output.kept_frames.clear();
    output.offered.clear();
    tell(1, R"({"op":"advance","id":5,"n":)" + std::to_string(n) + field + "}");
    while (room->advancing()) {
      room->advance_until(clock.now + 0.01);
      room->finish_turn();
    }
    clock.now += 1;
    room->finish_turn();
    return output.last("result", 5);
  }
  std::vector<std::uint64_t> kept_ticks() const {
    std::vector<std::uint64_t> ticks;
    for (const auto& [viewer, bytes] : output.kept_frames) {
      CHECK(viewer == 1);
      ticks.push_back(decoded(bytes).header.tick);
    }
    return ticks;
  }
};

TEST_CASE("frames of an advance come at most once in a tick's time, and the last state is shown") {
  AdvancingRoom t;
  const double start = t.clock.now;
  const std::uint64_t end = t.advance(600)["tick"];
  CHECK(t.output.kept_frames.empty());
  for (const proto::ViewerId viewer : {1U, 2U}) {
    CHECK(t.output.frames_for(viewer) >= 2);
    CHECK(t.output.frames_for(viewer) <= static_cast<long>((t.clock.now - start) / kTick) + 1);
  }
  CHECK(decoded(t.output.frames.back()).header.tick == end);
}

TEST_CASE(
    "advances tell the state four times a second, as ticks by the clock do, and the last one") {
  AdvancingRoom t;
  const double start = t.clock.now;
  const std::size_t before = t.output.count("state");
  std::uint64_t end = 0;
  for (int k = 0; k < 2000; ++k) end = t.say(1, R"({"op":"advance","id":5,"n":1})")["tick"];
  const double seconds = t.clock.now - start;
  REQUIRE(seconds > 2);
  CHECK(static_cast<double>(t.output.count("state") - before) >= 3.5 * seconds);
  CHECK(static_cast<double>(t.output.count("state") - before) <= 4 * seconds + 2);
  t.clock.now = t.room->next_wake();
  t.room->finish_turn();
  CHECK(t.output.last("state")["tick"] == end);
}

TEST_CASE("an advance with frames all gives its viewer each tick's, once and in order") {
  AdvancingRoom t;
  const std::uint64_t start = t.room->world().tick();
  t.advance(100, "all");
  std::vector<std::uint64_t> wanted;
  for (std::uint64_t tick = start + 1; tick <= start + 100; ++tick) wanted.push_back(tick);
  CHECK(t.kept_ticks() == wanted);
  CHECK(t.output.frames_for(1) == 0);
  CHECK(t.output.frames_for(2) >= 1);
}

TEST_CASE("an advance with frames last gives its viewer the last tick's alone, with none nothing") {
  AdvancingRoom t;
  const std::uint64_t start = t.room->world().tick();
  for (std::uint64_t k = 1; k <= 20; ++k) {
    t.turn(R"({"op":"drag","phase":"move","target":[0,1,)" + std::to_string(k) + "]}");
    t.advance(5, "last");
    CHECK(t.kept_ticks() == std::vector<std::uint64_t>{start + 5 * k});
    CHECK(t.output.frames_for(1) == 0);
  }
  t.turn(R"({"op":"drag","phase":"move","target":[0,1,0]})");
  t.advance(5, "none");
  CHECK(t.output.kept_frames.empty());
  CHECK(t.output.frames_for(1) == 0);
  CHECK(t.output.frames_for(2) >= 1);
  // The next change is shown to it again.
  t.clock.now += kTick;
  t.turn(R"({"op":"drag","phase":"move","target":[0,1,0.1]})");
  CHECK(t.output.frames_for(1) == 1);
}

TEST_CASE("frames that an advance was asked for come before its result") {
  TestRoom t;
  t.join(1);
  for (const char* frames : {"all", "last"}) {
    t.output.sent.clear();
    t.output.kept_frames.clear();
    t.tell(1, std::string(R"({"op":"advance","id":1,"n":3,"frames":")") + frames + R"("})");
    std::size_t shown = 0;
    while (t.output.sent.empty()) {
      shown = t.output.kept_frames.size();
      t.room->advance_until(t.clock.now);  // one tick
    }
    shown = t.output.kept_frames.size();
    t.room->finish_turn();
    CHECK(t.output.kept_frames.size() == shown);
    CHECK(decoded(t.output.kept_frames.back().second).header.tick == t.room->world().tick());
  }
}

TEST_CASE("which frames an advance is asked for changes no bit of the state") {
  std::set<std::string> hashes;
  for (const char* frames : {"", "none", "last", "all"}) {
    AdvancingRoom t;
    hashes.insert(t.advance(50, frames)["hash"].get<std::string>());
  }
  CHECK(hashes.size() == 1);
}

TEST_CASE("frames that an advance was asked for tell forces to who wants them, at hz 0 too") {
  TestRoom t;
  t.join(1);
  t.output.viewers_want_frames = t.output.viewers_want_forces = false;
  t.say(1, R"({"op":"advance","n":1,"frames":"last"})");
  CHECK(decoded(t.output.kept_frames.back().second).reactions.empty());
  Noted wish;
  wish.forces = true;
  t.room->take({1, ++t.number, wish});
  t.say(1, R"({"op":"advance","n":1,"frames":"last"})");
  CHECK(decoded(t.output.kept_frames.back().second).reactions.size() == 4);
}

TEST_CASE("an advance goes no faster than its frames are taken, and ends if none is for 2 s") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.output.takes_kept_frames = false;
  t.tell(1, R"({"op":"advance","id":1,"n":1000,"frames":"all"})");
  t.tell(2, R"({"op":"hash","id":2})");
  const auto run = [&t](double seconds) {
    for (double end = t.clock.now + seconds; t.clock.now < end; t.clock.now += 0.01) {
      t.room->advance_until(t.clock.now + 1);
      t.room->finish_turn();
    }
  };
  run(1.9);
  REQUIRE(t.room->advance_waits());
  const std::size_t most = t.output.kept_frames.size();
  CHECK(most <= 8);
  t.output.waiting.pop_back();
  run(1.9);
  CHECK(t.output.kept_frames.size() == most + 1);
  REQUIRE(t.room->advancing());
  run(0.2);
  CHECK_FALSE(t.room->advancing());
  const json error = t.output.last("error", 1);
  CHECK(error["code"] == "stalled");
  CHECK(error["command"] == "advance");
  CHECK(t.output.last("result", 2)["tick"] == 0);  // what did not ask for it does not wait
  // It does not wait again before a frame is taken.
  for (const char* frames : {"all", "last"}) {
    t.output.sent.clear();
    t.tell(1, std::string(R"({"op":"advance","id":3,"n":2,"frames":")") + frames + R"("})");
    CHECK_FALSE(t.room->advancing());
    CHECK(t.output.last("error", 3)["code"] == "stalled");
  }
  CHECK(t.say(1, R"({"op":"advance","id":4,"n":2})")["tick"] == most + 3);
  t.output.waiting.clear();
  t.output.takes_kept_frames = true;
  CHECK(t.say(1, R"({"op":"advance","id":5,"n":20,"frames":"all"})")["tick"] == most + 23);
}

TEST_CASE("frames of advances that are not read do not pile up, whichever are asked for") {
  TestRoom t;
  t.join(1);
  t.output.takes_kept_frames = false;
  for (int k = 0; k < 1000; ++k) {
    t.tell(1, R"({"op":"advance","n":3,"frames":"last"})");
    for (int i = 0; i < 300 && t.room->advancing(); ++i, t.clock.now += 0.01) {
      t.room->advance_until(t.clock.now + 1);
      t.room->finish_turn();
    }
  }
  CHECK(t.output.kept_frames.size() <= 8);
  CHECK(t.clock.now < 110);  // stalled once
}

/// The frame that tells what an `advance` to the floor observes.
proto::Frame observed(TestRoom& t, const std::string& observe) {
  t.output.kept_frames.clear();
  const json result = t.say(1, R"({"op":"advance","id":7,"n":40,"observe":[)" + observe + "]}");
  REQUIRE(result["op"] == "result");
  REQUIRE(t.output.kept_frames.size() == 1);
  CHECK(t.output.kept_frames[0].first == 1);
  proto::Frame frame = decoded(t.output.kept_frames[0].second);
  CHECK(frame.header.tick == result["tick"]);
  CHECK((frame.header.flags & proto::kFrameObserved) != 0);
  return frame;
}

/// A cloth that has been dropped on a ball.
void drop(TestRoom& t) {
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"release","particle":0})");
  t.say(1, R"({"op":"advance","n":30})");
}

std::vector<float> numbers_of(std::span<const float> values) {
  return {values.begin(), values.end()};
}

TEST_CASE("an advance tells its last state to the bit, as much of it as it was asked to observe") {
  TestRoom t;
  drop(t);
  const proto::Frame all = observed(t, R"("velocities","contacts","reactions","grippers")");
  CHECK(all.positions == numbers_of(floats_of(t.room->world().state().x)));
  CHECK(all.velocities == numbers_of(floats_of(t.room->world().state().v)));
  REQUIRE_FALSE(all.reactions.empty());
  const proto::Frame one = observed(t, R"("velocities")");
  CHECK(one.velocities == numbers_of(floats_of(t.room->world().state().v)));
  CHECK(one.contacts.empty());
  CHECK(one.reactions.empty());
  const proto::Frame places = observed(t, R"("positions")");
  CHECK(places.positions == numbers_of(floats_of(t.room->world().state().x)));
  CHECK(places.velocities.empty());
}

TEST_CASE("forces that an advance observes are those that its ticks' frames would have") {
  TestRoom t, watched;
  drop(t);
  drop(watched);
  const proto::Frame seen = observed(t, R"("contacts","reactions")");
  Noted wish;
  wish.forces = true;
  watched.room->take({1, 0, wish});
  watched.say(1, R"({"op":"advance","n":40,"frames":"last"})");
  REQUIRE(watched.output.kept_frames.size() == 1);
  const proto::Frame shown = decoded(watched.output.kept_frames[0].second);
  REQUIRE_FALSE(shown.reactions.empty());
  CHECK(seen.contacts == shown.contacts);
  CHECK(seen.reactions == shown.reactions);
  CHECK(t.room->world().hash() == watched.room->world().hash());
}

TEST_CASE("to observe changes no result, and nothing of it goes to others") {
  TestRoom t, blind;
  drop(t);
  drop(blind);
  observed(t, R"("contacts","velocities")");
  blind.say(1, R"({"op":"advance","n":40})");
  CHECK(t.room->world().hash() == blind.room->world().hash());
  for (const Frame& frame : t.output.offered)
    CHECK((decoded(text_of({frame.bytes, true})).header.flags & proto::kFrameObserved) == 0);
  const json error = json::parse(proto::encode_error(
      proto::parse_request(R"({"op":"advance","n":1,"observe":["positions","colour"]})").error()));
  CHECK(error["code"] == "unknown_value");
  CHECK(error["field"] == "observe[1]");
}

}  // namespace
}  // namespace weft::server
