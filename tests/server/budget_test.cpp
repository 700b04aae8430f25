#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "server/room/budget_keeper.h"
#include "tests/server/fakes.h"

// A room that needs more time for its ticks than it may says so and does what was agreed.

namespace weft::server {
namespace {

using nlohmann::json;
using Setting = BudgetKeeper::Setting;

/// Ticks whose time is that of `cost` at the present setting [ms]; returns how often it changed.
template <class Cost>
int run(BudgetKeeper& keeper, int ticks, Cost&& cost, bool may_soften = true) {
  int changes = 0;
  for (int tick = 0; tick < ticks; ++tick)
    changes += keeper.add(1e-3 * cost(keeper.setting()), may_soften).has_value();
  return changes;
}

/// A room whose ticks take 8 ms at full stiffness, 1 ms of which no softness saves.
struct BusyRoom : TestRoom {
  BusyRoom() : TestRoom(false) {
    join(1);
    clock.between_reads = [this] {
      return full_cost * (0.001 + 0.007 * std::sqrt(room->world().softness()));
    };
  }
  json last_state() { return output.last("state"); }
  /// How often a notice of this code was given.
  long notices(const std::string& code) {
    return std::count_if(output.sent.begin(), output.sent.end(), [&](const auto& message) {
      return json::parse(message.second).value("code", "") == code;
    });
  }
  double full_cost = 1;
};

/// Of a room to which the log's commands are said at their ticks.
std::uint64_t hash_of_replay(const Room& room) {
  TestRoom replay;
  replay.join(1);
  for (const LogEntry& entry : room.log().entries()) {
    while (replay.room->world().tick() < entry.tick) replay.tick(1);
    replay.room->take({1, 1, proto::Request{std::nullopt, entry.command}});
  }
  while (replay.room->world().tick() < room.world().tick()) replay.tick(1);
  return replay.room->world().hash();
}

}  // namespace

TEST_CASE("without a budget no time of a tick changes anything") {
  BudgetKeeper keeper;
  keeper.restart({}, {});
  CHECK(run(keeper, 300, [](const Setting&) { return 1e4; }) == 0);
}

TEST_CASE("within its budget a room is left alone, and one slow tick does not count") {
  BudgetKeeper keeper;
  keeper.restart({5, GENERATE(OverBudget::slow, OverBudget::soften)}, {});
  int tick = 0;
  CHECK(run(keeper, 600, [&](const Setting&) { return ++tick % 10 == 0 ? 90.0 : 4.9; }) == 0);
}

TEST_CASE("slow: the pace is budget over need, and comes back to 1 when there is room") {
  BudgetKeeper keeper;
  keeper.restart({4, OverBudget::slow}, {});
  CHECK(run(keeper, 300, [](const Setting&) { return 10.0; }) == 1);
  CHECK(keeper.setting().pace == Approx(0.4));
  CHECK(keeper.setting().softness == 1);
  CHECK(run(keeper, 300, [](const Setting&) { return 3.0; }) == 1);
  CHECK(keeper.setting() == Setting{});
  CHECK(run(keeper, 300, [](const Setting&) { return 1e9; }) == 1);
  CHECK(keeper.setting().pace == BudgetKeeper::kLeastPace);
}

TEST_CASE("what a budget leaves has two digits and prints as such") {
  const int hundredths = GENERATE(range(1, 100));
  BudgetKeeper keeper;
  keeper.restart({hundredths * 0.01, OverBudget::slow}, {});
  run(keeper, 30, [](const Setting&) { return 1.0; });
  CHECK(number_text(keeper.setting().pace).size() <= 5);
}

TEST_CASE("soften: a cost that falls with the root of the stiffness comes within the budget") {
  const double budget = GENERATE(2.0, 5.0, 9.0);
  const auto cost = [](const Setting& s) { return 1 + 9 * std::sqrt(s.softness); };
  BudgetKeeper keeper;
  keeper.restart({budget, OverBudget::soften}, {});
  run(keeper, 30 * 12, cost);
  CHECK(cost(keeper.setting()) <= budget * 1.06);
  CHECK(cost(keeper.setting()) >= budget * 0.6);
  CHECK(keeper.setting().pace == 1);
  // It has come to rest, and goes all the way back when the load is gone.
  CHECK(run(keeper, 30 * 20, cost) == 0);
  run(keeper, 30 * 12, [&](const Setting& s) { return 0.1 * cost(s); });
  CHECK(keeper.setting() == Setting{});
}

TEST_CASE("soften: what softness cannot save, or a solver without substeps, slows time down") {
  BudgetKeeper keeper;
  keeper.restart({2, OverBudget::soften}, {});
  const bool may_soften = GENERATE(true, false);
  run(
      keeper, 30 * 12, [](const Setting&) { return 20.0; }, may_soften);
  CHECK(keeper.setting().softness == (may_soften ? Approx(kLeastSoftness) : Approx(1)));
  CHECK(keeper.setting().pace == Approx(0.1));
}

TEST_CASE("a room over its budget lets time pass more slowly, tells it and logs it") {
  BusyRoom t;
  t.say(1, R"({"op":"set","budget_ms":4})");
  t.tick(60);
  CHECK(t.room->speed() == Approx(0.5));
  CHECK(t.room->tick_interval() == Approx(2 * t.room->world().tick_seconds()));
  CHECK(t.notices("over_budget") == 1);
  CHECK(t.last_state()["pace"] == Approx(0.5));
  CHECK(t.last_state()["speed"] == 1);
  const LogEntry& entry = t.room->log().entries().back();
  CHECK(entry.origin == CommandOrigin::budget);
  CHECK(std::get<proto::Speed>(entry.command).speed == Approx(0.5));
  // Giving up the budget takes it back.
  t.say(1, R"({"op":"set","budget_ms":0})");
  CHECK(t.room->speed() == 1);
}

TEST_CASE("a room over its budget softens its springs if it was asked to, and gives them back") {
  BusyRoom t;
  t.say(1, R"({"op":"set","budget_ms":4,"over_budget":"soften"})");
  t.tick(200);
  const double softness = t.room->world().softness();
  CHECK(softness < 0.3);
  CHECK(t.room->speed() == 1);
  CHECK(t.last_state()["softness"] == softness);
  CHECK(t.notices("over_budget") > 0);
  CHECK(t.notices("within_budget") == 0);
  t.full_cost = 0.1;
  t.tick(300);
  CHECK(t.room->world().softness() == 1);
  CHECK(t.notices("within_budget") == 1);
  // What a person sets stays when the budget has room.
  t.say(1, R"({"op":"set","softness":0.5})");
  t.tick(200);
  CHECK(t.room->world().softness() == 0.5);
}

TEST_CASE("what a budget changed is in the log: replaying it leads to the same hash") {
  BusyRoom t;
  t.say(1, R"({"op":"set","budget_ms":4,"over_budget":"soften"})");
  t.tick(150);
  CHECK(hash_of_replay(*t.room) == t.room->world().hash());
}

TEST_CASE("what a budget has softened is given back before another one, or a fabric, holds") {
  for (const char* change : {R"("budget_ms":0)", R"("fabric":{"friction":0.3})"}) {
    CAPTURE(change);
    BusyRoom t;
    t.say(1, R"({"op":"set","budget_ms":4,"over_budget":"soften"})");
    t.tick(150);
    REQUIRE(t.room->world().softness() < 1);
    CHECK(t.say(1, std::string(R"({"op":"set","id":2,)") + change + "}")["op"] == "result");
    CHECK(t.room->world().softness() == 1);
    t.tick(20);
    CHECK(hash_of_replay(*t.room) == t.room->world().hash());
  }
}

TEST_CASE("a scene's own budget holds from its start, and advance has none") {
  BusyRoom t;
  t.say(1, R"({"op":"load","scene":"other"})");
  CHECK(t.last_state()["budget_ms"] == 0);
  t.say(1, R"({"op":"set","budget_ms":1,"over_budget":"soften"})");
  t.say(1, R"({"op":"pause"})");
  t.say(1, R"({"op":"advance","n":200})");
  CHECK(t.room->world().softness() == 1);
  CHECK(t.room->speed() == 1);
}

}  // namespace weft::server
