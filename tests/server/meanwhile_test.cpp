// What a room does for its viewers while a tick runs.

#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/server/halting_room.h"

namespace weft::server {
namespace {

using nlohmann::json;

/// A room in whose next tick something is done, once, at its stop point of this number.
struct BusyRoom : HaltingRoom {
  explicit BusyRoom(bool paused = false, RoomOptions options = {}) : HaltingRoom(paused, options) {}

  /// Call before the tick.
  void do_at(int number, std::function<void()> what) {
    done = false;
    seen = 0;
    at_stop = [this, number, what = std::move(what)] {
      if (seen > number && !std::exchange(done, true)) what();
    };
  }
  void say_meanwhile(proto::ViewerId viewer, const std::string& text) {
    get().take_meanwhile({viewer, ++room->number, *proto::parse_request(text)});
  }
  json answer(int id) const {
    const json result = room->output.last("result", id);
    return result.is_null() ? room->output.last("error", id) : result;
  }

  bool done = false;
};

TEST_CASE("who joins and what is beside the cloth does not wait for a tick") {
  BusyRoom t;
  t.room->join(1);
  const std::size_t frames = t.room->output.frames.size();
  t.do_at(0, [&] {
    t.get().take_meanwhile({2, 0, Join{}});
    t.say_meanwhile(1, R"({"op":"pause","id":3})");
    t.say_meanwhile(1, R"({"op":"query","id":4,"what":"positions"})");
    CHECK(t.room->output.last("welcome")["viewer"] == 2);
    CHECK(t.answer(3)["paused"] == true);
    CHECK(t.answer(4).is_null());                   // needs the cloth
    CHECK(t.room->output.frames.size() == frames);  // nobody sees half a tick
  });
  t.room->tick(1);
  REQUIRE(t.done);
  CHECK(t.get().world().tick() == 1);
  CHECK(t.answer(4)["tick"] == 1);
  CHECK(t.room->output.frames.size() > frames);
}

TEST_CASE("a hash that is asked for during a tick is that of the state before it, told at once") {
  for (const int stop : {0, 1, 3, 9}) {
    INFO("stop point " << stop);
    BusyRoom t;
    t.room->join(1);
    t.room->say(1, R"({"op":"set","wind":[3,0,2],"gust_speed":1})");
    t.room->say(1, R"({"op":"drag","phase":"start","drag":5,"particle":38,"target":[0.3,1,0.4]})");
    t.room->tick(10);
    const std::string before = hash_of(t.get());
    t.do_at(stop, [&] {
      t.say_meanwhile(1, R"({"op":"hash","id":3})");
      CHECK(t.answer(3)["hash"] == before);
      CHECK(t.answer(3)["tick"] == 10);
    });
    t.room->tick(1);
    REQUIRE(t.done);
    CHECK(hash_of(t.get()) != before);
  }
}

TEST_CASE("while a tick of an advance runs, others join and are answered") {
  BusyRoom t(true);
  t.room->join(1);
  t.room->join(2);
  t.room->tell(1, R"({"op":"advance","id":1,"n":50})");
  t.do_at(0, [&] {
    t.get().take_meanwhile({3, 0, Join{}});
    t.say_meanwhile(2, R"({"op":"camera","id":2,"position":[0,1,3],"target":[0,1,0],"fov":50})");
    t.say_meanwhile(2, R"({"op":"hash","id":3})");
    t.say_meanwhile(1, R"({"op":"hello","id":4,"name":"late"})");
    CHECK(t.room->output.last("welcome")["viewer"] == 3);
    CHECK(t.answer(2)["op"] == "result");
    CHECK(t.answer(3)["tick"] == 0);
    CHECK(t.answer(4).is_null());  // comes behind the advance of its own viewer
  });
  t.get().advance_until(0);
  REQUIRE(t.done);
  while (t.get().advancing()) t.get().advance_until(0);
  t.get().finish_turn();
  CHECK(t.answer(1)["tick"] == 50);
  CHECK(t.answer(4)["op"] == "result");
}

TEST_CASE("a pause is answered with the tick at which the cloth then stands") {
  BusyRoom t;
  t.room->join(1);
  t.room->tick(10);
  CHECK(t.room->say(1, R"({"op":"pause","id":3})")["tick"] == 10);
  t.room->say(1, R"({"op":"resume"})");
  for (const int stop : {0, 1, 5}) {
    INFO("stop point " << stop);
    t.do_at(stop, [&] { t.say_meanwhile(1, R"({"op":"pause","id":4})"); });
    t.room->tick(1);
    REQUIRE(t.done);
    CHECK(t.answer(4)["tick"] == t.get().world().tick());
    CHECK(t.room->say(1, R"({"op":"hash","id":5})")["tick"] == t.answer(4)["tick"]);
    t.room->say(1, R"({"op":"resume"})");
  }
}

TEST_CASE("a hash behind a pause is that of the state in which the cloth stands") {
  for (const int stop : {0, 1, 5}) {
    INFO("stop point " << stop);
    BusyRoom t;
    t.room->join(1);
    t.do_at(stop, [&] {
      t.say_meanwhile(1, R"({"op":"pause","id":4})");
      t.say_meanwhile(1, R"({"op":"hash","id":5})");
    });
    t.room->tick(1);
    REQUIRE(t.done);
    CHECK(t.answer(5)["tick"] == t.answer(4)["tick"]);
    CHECK(t.answer(5)["hash"] == hash_of(t.get()));
  }
}

TEST_CASE(
    "a pause within a tick of an advance ends it with that tick, and waits for its viewer's") {
  for (const proto::ViewerId viewer : {1u, 2u}) {
    INFO("by viewer " << viewer);
    BusyRoom t(true);
    t.room->join(1);
    t.room->join(2);
    t.room->tell(1, R"({"op":"advance","id":1,"n":50})");
    t.room->tell(1, R"({"op":"query","id":2,"what":"strain"})");
    t.get().advance_until(0);
    t.do_at(0, [&] {
      t.say_meanwhile(viewer, R"({"op":"pause","id":3})");
      CHECK(t.answer(3).is_null() == (viewer == 1));  // behind its query
      CHECK(t.answer(1).is_null());
    });
    t.get().advance_until(t.room->clock.now + 1000);
    REQUIRE(t.done);
    CHECK_FALSE(t.get().advancing());
    CHECK(t.get().world().tick() == 2);
    CHECK(t.answer(1)["code"] == "interrupted");
    CHECK(t.answer(1)["message"].get<std::string>().find("tick 2") != std::string::npos);
    t.get().finish_turn();
    CHECK(t.answer(2)["op"] == "result");  // what waited behind the advance
    CHECK(t.answer(3)["paused"] == true);
    CHECK(std::get<proto::Advance>(t.get().log().entries().front().command).n == 2);
    CHECK(replayed(t.get(), 2, nullptr) == hash_of(t.get()));
  }
}

TEST_CASE("a pause within the last tick of an advance leaves it its result") {
  BusyRoom t(true);
  t.room->join(1);
  t.room->tell(1, R"({"op":"advance","id":1,"n":1})");
  t.do_at(0, [&] { t.say_meanwhile(1, R"({"op":"pause","id":3})"); });
  t.get().advance_until(t.room->clock.now + 1000);
  CHECK(t.answer(3)["op"] == "result");
  CHECK(t.answer(1)["op"] == "result");
  CHECK(t.answer(1)["tick"] == 1);
}

TEST_CASE("a paused advance whose tick is given up ends with what ended the tick") {
  BusyRoom t(true);
  t.room->join(1);
  t.room->join(2);
  t.room->tell(1, R"({"op":"advance","id":1,"n":50})");
  t.do_at(0, [&] {
    t.say_meanwhile(2, R"({"op":"pause","id":2})");
    t.say_meanwhile(2, R"({"op":"reset","id":3})");
  });
  t.get().advance_until(t.room->clock.now + 1000);
  t.get().finish_turn();
  CHECK_FALSE(t.get().advancing());
  CHECK(t.answer(1)["code"] == "interrupted");
  CHECK(t.answer(3)["op"] == "result");
  CHECK(t.get().world().tick() == 0);
}

json without_tick(json message) {
  message.erase("tick");
  return message;
}

TEST_CASE("who joins during a tick is told the cloth, pins and hands as others were told them") {
  for (const int stop : {0, 2, 8}) {
    INFO("stop point " << stop);
    BusyRoom t;
    t.room->join(1);
    const int pin = t.room->say(1, R"({"op":"pin","id":1,"particle":20})")["pin"];
    t.room->say(1, json{{"op", "move"}, {"pin", pin}, {"position", {0.2, 0.6, 0.3}}}.dump());
    t.room->say(1, R"({"op":"drag","phase":"start","drag":5,"particle":38,"target":[0.3,1,0.4]})");
    t.room->tick(10);
    const char* kinds[] = {"state", "pins", "grabs"};
    std::vector<json> told;
    for (const char* kind : kinds) told.push_back(t.room->output.last(kind));
    t.do_at(stop, [&] {
      t.get().take_meanwhile({2, 0, Join{}});
      for (std::size_t k = 0; k < told.size(); ++k) CHECK(t.room->output.last(kinds[k]) == told[k]);
    });
    t.room->tick(1);
    REQUIRE(t.done);
    t.room->join(3);  // between two ticks
    for (std::size_t k = 0; k < told.size(); ++k)
      CHECK(without_tick(t.room->output.last(kinds[k])) != without_tick(told[k]));
  }
}

TEST_CASE("no change of the cloth is told to others during a tick, and all of it afterwards") {
  BusyRoom t;
  t.room->join(1);
  t.room->tick(3);
  t.room->tell(1, R"({"op":"pin","particle":20})");
  t.room->tell(1, R"({"op":"drag","phase":"start","drag":5,"particle":38})");
  t.room->tell(1, R"({"op":"speed","speed":0.5})");
  t.room->clock.now += 1;  // so that changes are due
  const char* kinds[] = {"state", "pins", "grabs"};
  const auto counts = [&] {
    std::vector<std::size_t> list;
    for (const char* kind : kinds) {
      std::size_t count = 0;
      for (const auto& [viewer, text] : t.room->output.sent)
        count += viewer == 0 && json::parse(text)["op"] == kind;
      list.push_back(count);
    }
    return list;
  };
  const std::vector<std::size_t> before = counts();
  t.do_at(1, [&] {
    t.get().take_meanwhile({2, 0, Join{}});
    CHECK(counts() == before);
  });
  t.room->clock.now += t.get().tick_interval();
  t.get().tick();
  REQUIRE(t.done);
  t.room->clock.now += 1;
  t.get().finish_turn();
  const std::vector<std::size_t> after = counts();
  for (std::size_t k = 0; k < before.size(); ++k) CHECK(after[k] == before[k] + 1);
}

}  // namespace
}  // namespace weft::server
