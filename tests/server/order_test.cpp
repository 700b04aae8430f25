// Whose turn it is: ticks that are given up, and an advance that others see through.

#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/room/simulation_loop.h"
#include "server/scene/scene_json.h"
#include "tests/server/halting_room.h"
#include "tests/support/targets.h"
#include "tests/support/two_threads.h"

namespace weft::server {
namespace {

using nlohmann::json;

TEST_CASE("a tick beyond its limit is given up, told with its cause, logged, and pauses the room") {
  HaltingRoom t;
  t.room->join(1);
  t.room->tick(10);
  const std::string before = hash_of(t.get());
  t.halt_at(2);
  t.room->tick(1);
  CHECK(t.get().world().tick() == 10);
  CHECK(hash_of(t.get()) == before);
  CHECK(t.get().paused());
  t.room->clock.now += 1;
  t.get().finish_turn();
  const json notice = t.room->output.last("notice");
  CHECK(notice["code"] == "halted");
  CHECK(notice["message"].get<std::string>().find("2 s of CPU") != std::string::npos);
  const auto& entries = t.get().log().entries();
  REQUIRE(entries.size() == 2);
  CHECK(std::holds_alternative<proto::Halt>(entries[0].command));
  CHECK(std::holds_alternative<proto::Pause>(entries[1].command));
  CHECK(entries[0].tick == 10);
  CHECK(entries[0].origin == CommandOrigin::limit);
  t.room->say(1, R"({"op":"resume"})");
  t.room->tick(5);
  CHECK(t.get().world().tick() == 15);
}

TEST_CASE("a tick that fails is taken back, told and logged, and the room lives on, paused") {
  HaltingRoom t;
  t.room->join(1);
  t.room->tick(10);
  const std::string before = hash_of(t.get());
  t.at_stop = [] { throw std::runtime_error("a planted failure"); };
  t.room->tick(1);
  t.at_stop = nullptr;
  CHECK(t.get().world().tick() == 10);
  CHECK(hash_of(t.get()) == before);
  CHECK(t.get().paused());
  t.room->clock.now += 1;
  t.get().finish_turn();
  const json notice = t.room->output.last("notice");
  CHECK(notice["code"] == "halted");
  CHECK(notice["message"].get<std::string>().find("a planted failure") != std::string::npos);
  CHECK(std::holds_alternative<proto::Halt>(t.get().log().entries().front().command));
  t.room->say(1, R"({"op":"resume"})");
  t.room->tick(5);
  CHECK(t.get().world().tick() == 15);
}

TEST_CASE("a log that holds halts replays to the same hash, for any threads and instruction set") {
  HaltingRoom t;
  t.room->join(1);
  t.room->say(1, R"({"op":"drag","phase":"start","drag":5,"particle":38,"target":[0.3,1,0.4]})");
  for (const int stop : {0, 3, 1, 7}) {
    t.room->tick(9);
    t.halt_at(stop);
    t.room->tick(1);
    REQUIRE(t.get().paused());
    t.room->say(1, R"({"op":"resume"})");
  }
  t.room->tick(20);
  test::TwoThreads threads;
  const std::uint64_t ticks = t.get().world().tick();
  CHECK(replayed(t.get(), ticks, nullptr) == hash_of(t.get()));
  CHECK(replayed(t.get(), ticks, &threads) == hash_of(t.get()));
  test::for_each_target([&] {
    CHECK(replayed(t.get(), ticks, nullptr) == hash_of(t.get()));
    CHECK(replayed(t.get(), ticks, &threads) == hash_of(t.get()));
  });
}

TEST_CASE("an advance whose tick is given up ends with an error that names the tick") {
  HaltingRoom t(true);
  t.room->join(1);
  t.halt_at(40);
  const json error = t.room->say(1, R"({"op":"advance","id":7,"n":500})");
  CHECK(error["op"] == "error");
  CHECK(error["code"] == "halted");
  CHECK(error["command"] == "advance");
  const std::uint64_t made = t.get().world().tick();
  CHECK(made < 500);
  // In the log are the ticks that it made, and a halt behind them.
  const LogEntry& logged = t.get().log().entries().front();
  if (made > 0) CHECK(std::get<proto::Advance>(logged.command).n == made);
  CHECK(t.room->say(1, R"({"op":"advance","id":8,"n":2})")["op"] == "result");
}

TEST_CASE("a reset ends the tick under way and comes at once") {
  HaltingRoom t;
  t.room->join(1);
  t.room->tick(5);
  bool done = false;
  t.at_stop = [&] {
    if (std::exchange(done, true)) return;
    t.get().take_meanwhile({1, 1, *proto::parse_request(R"({"op":"reset","id":3})")});
  };
  t.get().tick();
  CHECK(t.get().world().tick() == 5);
  t.get().finish_turn();
  CHECK(t.get().world().tick() == 0);
  CHECK_FALSE(t.get().paused());
  CHECK(t.room->output.last("result", 3)["tick"] == 0);
  t.room->tick(7);
  CHECK(replayed(t.get(), 7, nullptr) == hash_of(t.get()));
}

TEST_CASE("a stopped inbox ends the tick under way") {
  struct Inbox {
    bool stop = false;
    std::vector<Inbound> take_all() { return {}; }
    bool stopped() const { return stop; }
    void wait(double) {}
  };
  HandLimit hand;
  RoomOptions options;
  options.limit = &hand.limit;
  TestRoom t(false, {}, options);
  Inbox inbox;
  SimulationLoop<Room, Inbox> loop(*t.room, inbox, t.clock.clock());
  loop.turn();
  const std::uint64_t tick = t.room->world().tick();
  inbox.stop = true;
  hand.limit.signal().raise();
  t.clock.now += 1;
  loop.turn();
  CHECK(t.room->world().tick() == tick);
}

TEST_CASE("between the ticks of an advance others are answered, and its own viewer waits") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.tell(1, R"({"op":"advance","id":1,"n":50})");
  t.tell(1, R"({"op":"hash","id":2})");
  t.room->advance_until(0);
  t.tell(2, R"({"op":"hash","id":3})");
  CHECK(t.output.last("result", 3)["tick"] == 1);
  CHECK(t.output.last("result", 2).is_null());
  t.tell(2, R"({"op":"advance","id":4,"n":1})");
  CHECK(t.output.last("error", 4)["code"] == "busy");
  while (t.room->advancing()) t.room->advance_until(0);
  t.room->finish_turn();
  CHECK(t.output.last("result", 1)["tick"] == 50);
  CHECK(t.output.last("result", 2)["tick"] == 50);
}

TEST_CASE("its viewer and every other one can end an advance") {
  for (const proto::ViewerId viewer : {1u, 2u}) {
    for (const char* op : {"pause", "reset", "load"}) {
      if (viewer == 1 && std::string(op) != "pause") continue;  // behind the advance
      INFO(op << " by viewer " << viewer);
      TestRoom t;
      t.join(1);
      t.join(2);
      t.tell(1, R"({"op":"advance","id":1,"n":100000})");
      t.room->advance_until(0);
      t.tell(viewer, std::string(R"({"op":")") + op + R"(","scene":"other"})");
      CHECK_FALSE(t.room->advancing());
      const json error = t.output.last("error", 1);
      CHECK(error["code"] == "interrupted");
      CHECK(error["message"].get<std::string>().find("tick") != std::string::npos);
    }
  }
}

TEST_CASE("a pause ends an advance of its viewer although other commands wait behind that") {
  TestRoom t;
  t.join(1);
  t.tell(1, R"({"op":"advance","id":1,"n":100000})");
  t.room->advance_until(0);
  t.tell(1, R"({"op":"hash","id":2})");
  t.tell(1, R"({"op":"pause","id":3})");
  CHECK_FALSE(t.room->advancing());
  t.room->finish_turn();
  CHECK(t.output.last("error", 1)["code"] == "interrupted");
  CHECK(t.output.last("result", 2)["op"] == "result");
  CHECK(t.output.last("result", 3)["op"] == "result");
}

TEST_CASE("a pause holds whatever its viewer has sent before it, and waits behind its advance") {
  TestRoom t;
  t.join(1);
  t.tell(1, R"({"op":"advance","id":1,"n":100000})");
  t.room->advance_until(0);
  t.tell(1, R"({"op":"resume","id":2})");
  t.tell(1, R"({"op":"advance","id":3,"n":100000})");
  t.tell(1, R"({"op":"pause","id":4})");
  t.room->finish_turn();
  CHECK(t.output.last("error", 1)["code"] == "interrupted");
  CHECK(t.output.last("result", 2)["paused"] == false);
  CHECK(t.output.last("error", 3)["op"] == "error");  // the room runs, or it was interrupted
  CHECK(t.output.last("result", 4)["paused"] == true);
  CHECK(t.room->paused());
  CHECK_FALSE(t.room->advancing());
}

TEST_CASE("a pause ends its viewer's advances that wait, too") {
  TestRoom t;
  t.join(1);
  t.tell(1, R"({"op":"advance","id":1,"n":100000})");
  t.room->advance_until(0);
  t.tell(1, R"({"op":"advance","id":2,"n":100000})");
  t.tell(1, R"({"op":"pause","id":3})");
  t.room->finish_turn();
  CHECK(t.output.last("error", 1)["code"] == "interrupted");
  CHECK(t.output.last("error", 2)["code"] == "interrupted");
  CHECK(t.output.last("result", 3)["paused"] == true);
  CHECK(t.room->world().tick() == 1);
}

TEST_CASE("what a viewer changed before it went is changed, and what it asked is dropped") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.tell(1, R"({"op":"advance","n":100000})");
  const std::size_t pins = t.room->world().pins().list.size();
  t.tell(1, R"({"op":"pin","particle":20})");
  t.tell(1, R"({"op":"advance","n":100000})");
  t.leave(1);
  CHECK_FALSE(t.room->advancing());
  CHECK(t.room->world().pins().list.size() == pins + 1);
  CHECK(t.say(2, R"({"op":"advance","id":3,"n":1})")["op"] == "result");
}

TEST_CASE("of a viewer's notes that wait one is kept, with what all of them say") {
  Order order;
  for (std::uint32_t number = 1; number <= 1000; ++number) {
    add_waiting(order, {1, number, Noted{number == 7, {}}});
    add_waiting(order, {2, number, Noted{false, number == 9 ? std::optional(true) : std::nullopt}});
  }
  REQUIRE(order.waiting.size() == 2);
  for (const Inbound& item : order.waiting) {
    CHECK(item.number == 1000);
    CHECK(std::get<Noted>(item.what).wants_frame == (item.viewer == 1));
    CHECK(std::get<Noted>(item.what).forces.value_or(false) == (item.viewer == 2));
  }
  add_waiting(order, {1, 1001, proto::Request{{}, proto::Hash{}}});
  add_waiting(order, {1, 1002, Noted{false, false}});
  add_waiting(order, {1, 1003, Noted{}});
  REQUIRE(order.waiting.size() == 4);
  CHECK(order.waiting.back().number == 1003);
  CHECK(std::get<Noted>(order.waiting.back().what).forces == false);
}

TEST_CASE("a room that waits for a load is not made if its viewer goes, and the load goes on") {
  Jobs jobs;
  OneOtherRoom others;
  RoomOptions options = with_jobs(jobs);
  options.others = &others;
  TestRoom t(true, {}, options);
  t.join(1);
  t.join(2);
  t.tell(1, R"({"op":"load","id":1,"scene":"other"})");
  t.tell(2, R"({"op":"create_room","id":2,"name":"mine"})");
  t.leave(2);
  CHECK(jobs.list.size() == 1);
  jobs.run_all();
  t.room->finish_turn();
  CHECK(others.reserved == 0);
  CHECK(t.output.last("result", 1)["epoch"] == 2);
  CHECK(t.room->world().def().name == "other");
}

TEST_CASE("after a dear command a viewer alone waits too, if another room has viewers") {
  double cpu = 0;
  OneOtherRoom others;
  RoomOptions options;
  options.cpu_clock = [&cpu] { return cpu += 0.05; };
  options.others = &others;
  TestRoom t(true, {}, options);
  t.join(1);
  t.tell(1, R"({"op":"hash","id":1})");
  t.tell(1, R"({"op":"hash","id":2})");
  CHECK_FALSE(t.output.last("result", 2).is_null());
  others.has_viewers = true;
  t.tell(1, R"({"op":"hash","id":3})");
  t.tell(1, R"({"op":"hash","id":4})");
  CHECK_FALSE(t.output.last("result", 3).is_null());
  CHECK(t.output.last("result", 4).is_null());
  t.clock.now += 0.2;
  t.room->finish_turn();
  CHECK_FALSE(t.output.last("result", 4).is_null());
}

TEST_CASE("after a dear command a viewer waits in proportion, while others are answered") {
  double cpu = 0;
  RoomOptions options;
  options.cpu_clock = [&cpu] { return cpu += 0.05; };
  TestRoom t(true, {}, options);
  t.join(1);
  t.tell(1, R"({"op":"hash","id":1})");
  t.tell(1, R"({"op":"hash","id":2})");
  CHECK_FALSE(t.output.last("result", 2).is_null());  // alone, nobody waits
  t.join(2);
  t.tell(1, R"({"op":"hash","id":3})");
  t.tell(1, R"({"op":"hash","id":4})");
  CHECK_FALSE(t.output.last("result", 3).is_null());
  CHECK(t.output.last("result", 4).is_null());
  t.tell(2, R"({"op":"hash","id":5})");
  CHECK_FALSE(t.output.last("result", 5).is_null());
  CHECK(t.room->next_wake() <= t.clock.now + 0.15 + 1e-9);
  t.clock.now += 0.2;
  t.room->finish_turn();
  CHECK_FALSE(t.output.last("result", 4).is_null());
}

}  // namespace
}  // namespace weft::server
