#include "server/rooms/scheduler.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "server/constants.h"
#include "server/work_limit.h"

// Turns of rooms on a few threads. No verdict depends on how long something took: a scheduler that
// gives no turn hangs the test, which has a limit.

namespace weft::server {
namespace {

struct FakeTurns : Turns {
  std::function<Turn(FakeTurns&)> does;
  std::atomic<int> turns = 0, at_once = 0, most_at_once = 0, ends = 0;

  explicit FakeTurns(std::function<Turn(FakeTurns&)> what) : does(std::move(what)) {}
  Turn turn() override {
    if (++at_once > most_at_once) most_at_once = at_once.load();
    ++turns;
    const Turn next = does(*this);
    --at_once;
    return next;
  }
  void end() override { ++ends; }
};

std::shared_ptr<FakeTurns> room(std::function<Turn(FakeTurns&)> what) {
  return std::make_shared<FakeTurns>(std::move(what));
}

void burn(double seconds) {
  const double end = thread_cpu_seconds() + seconds;
  while (thread_cpu_seconds() < end) {
  }
}

void until(const std::function<bool()>& holds) {
  while (!holds()) std::this_thread::yield();
}

/// A tick of some cost, and the next one as soon as it can be.
Turn costly_tick(double cost, double interval = 0.01) {
  burn(cost);
  return {process_seconds(), interval, true};
}

Turn light_tick() {
  return {process_seconds() + 0.001, 0.01, true};
}

/// A room whose ticks take twice the CPU time that there is.
std::shared_ptr<FakeTurns> overrunning() {
  return room([](FakeTurns&) { return costly_tick(3 * kShortTick, 1.5 * kShortTick); });
}

TEST_CASE("a room has one turn at a time, however often it is woken") {
  Scheduler scheduler(3, process_seconds);
  std::vector<std::shared_ptr<FakeTurns>> rooms;
  for (int k = 0; k < 4; ++k) {
    rooms.push_back(room([](FakeTurns&) { return Turn{}; }));
    scheduler.add(rooms.back());
  }
  until([&] {
    for (const auto& each : rooms) scheduler.wake(*each);
    return rooms[0]->turns > 300;
  });
  scheduler.stop();
  until([&] { return scheduler.running() == 0; });
  for (const auto& each : rooms) CHECK(each->most_at_once <= 1);
}

TEST_CASE("no call is lost: each is followed by the begin of a turn") {
  Scheduler scheduler(2, process_seconds);
  std::atomic<int> called = 0, seen = 0;
  const auto other = room([](FakeTurns&) { return light_tick(); });
  const auto one = room([&](FakeTurns&) {
    seen = called.load();
    return Turn{};
  });
  scheduler.add(other);
  scheduler.add(one);
  for (int round = 1; round <= 2000; ++round) {
    called = round;
    scheduler.wake(*one);
    if (round % 7 == 0) until([&] { return seen == round; });
  }
  until([&] { return seen == called; });
  CHECK(seen == 2000);
}

TEST_CASE("a room that sleeps gets no turn until it is woken") {
  Scheduler scheduler(1, process_seconds);
  const auto sleeper = room([](FakeTurns&) { return Turn{}; });
  const auto other = room([](FakeTurns&) { return light_tick(); });
  scheduler.add(sleeper);
  scheduler.add(other);
  until([&] { return other->turns > 20; });
  CHECK(sleeper->turns == 1);
  scheduler.wake(*sleeper);
  until([&] { return sleeper->turns == 2; });
}

TEST_CASE("a room whose ticks want more than its share is heavy, and only then") {
  Scheduler scheduler(1, process_seconds);
  const auto heavy = overrunning();
  const auto light = room([](FakeTurns&) { return light_tick(); });
  scheduler.add(heavy);
  scheduler.add(light);
  until([&] { return heavy->turns > 10 && light->turns > 10; });
  CHECK(scheduler.is_heavy(*heavy));
  CHECK_FALSE(scheduler.is_heavy(*light));
}

TEST_CASE("a heavy room that is light once another one has closed goes on to have turns") {
  Scheduler scheduler(1, process_seconds);
  // A quarter of the thread is the share of each, then a third.
  const auto rare = room([](FakeTurns&) { return Turn{process_seconds() + 1000, 1000, true}; });
  const auto between =
      room([](FakeTurns&) { return costly_tick(3 * kShortTick, 10 * kShortTick); });
  const auto heavy = overrunning(), closing = overrunning();
  for (const auto& each : {rare, between, heavy, closing}) scheduler.add(each);
  until([&] {
    for (const auto& each : {between, heavy, closing})
      if (!scheduler.is_heavy(*each) || each->turns < 20) return false;
    return true;
  });
  scheduler.remove(*closing);
  until([&] { return closing->ends == 1; });
  const int before = between->turns;
  until([&] { return between->turns > before + 20; });
  CHECK_FALSE(scheduler.is_heavy(*between));
}

TEST_CASE("a room that changes its lane while its turn runs goes on to have turns") {
  Scheduler scheduler(1, process_seconds);
  std::atomic<bool> held = false, inside = false;
  const auto heavy = room([&](FakeTurns&) {
    const Turn turn = costly_tick(3 * kShortTick, 1.5 * kShortTick);
    inside = held.load();
    until([&] { return !held; });
    return turn;
  });
  scheduler.add(heavy);
  until([&] { return scheduler.is_heavy(*heavy) && heavy->turns > 10; });
  held = true;
  until([&] { return inside.load(); });
  // Alone it is served as light ones are; from now on after them.
  scheduler.add(room([](FakeTurns&) { return Turn{process_seconds() + 1000, 1000, true}; }));
  held = false;
  const int before = heavy->turns;
  until([&] { return heavy->turns > before + 20; });
  CHECK(scheduler.is_heavy(*heavy));
}

TEST_CASE("while turns of heavy rooms do not end, light ones have theirs") {
  constexpr int kThreads = 2;
  Scheduler scheduler(kThreads, process_seconds);
  std::atomic<bool> held = false, free = false;
  std::atomic<int> inside = 0;
  std::vector<std::shared_ptr<FakeTurns>> heavy;
  for (int k = 0; k < kThreads + 1; ++k) {
    heavy.push_back(room([&](FakeTurns&) {
      const Turn turn = costly_tick(3 * kShortTick, 1.5 * kShortTick);
      ++inside;
      while (held && !free) std::this_thread::yield();
      --inside;
      return turn;
    }));
  }
  const auto light = room([](FakeTurns&) { return light_tick(); });
  scheduler.add(light);
  for (const auto& each : heavy) scheduler.add(each);
  until([&] {
    for (const auto& each : heavy)
      if (!scheduler.is_heavy(*each) || each->turns < 10) return false;
    return true;
  });
  held = true;
  until([&] { return inside == kThreads; });
  const int before = light->turns;
  until([&] { return light->turns > before + 50; });
  CHECK(inside == kThreads);
  free = true;
}

/// A room that overruns until a light one holds the only thread, and then asks for the way.
struct Crossroads {
  explicit Crossroads(double longest_way) : scheduler(1, process_seconds, longest_way) {
    scheduler.add(heavy);
    scheduler.add(light);
  }

  std::atomic<bool> light_holds = false, let_go = false, asked = false;
  std::atomic<int> passed = 0, passed_before = 0;  // before the light one has ended
  std::shared_ptr<FakeTurns> light = room([this](FakeTurns&) {
    if (is_patient && !let_go) {
      light_holds = true;
      until([this] { return let_go.load(); });
      light_holds = false;
    }
    return light_tick();
  });
  std::atomic<bool> is_patient = false;
  std::shared_ptr<FakeTurns> heavy = room([this](FakeTurns&) {
    is_patient = Scheduler::on_patient_thread();
    if (light_holds) {
      asked = true;
      scheduler.give_way();
      if (light_holds) ++passed_before;
      ++passed;
    }
    return costly_tick(0.02);
  });
  Scheduler scheduler;
};

TEST_CASE(
    "a heavy room gives way until the turn of the light one that needs its thread has ended") {
  Crossroads here(1e6);
  until([&] { return here.asked.load(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // in which it would go on
  here.let_go = true;
  until([&] { return here.passed > 0; });
  CHECK(here.passed_before == 0);
}

TEST_CASE("a heavy room goes on now and then though a light one always needs its thread") {
  Crossroads here(1e-3);
  until([&] { return here.passed_before > 3; });
  here.let_go = true;
}

TEST_CASE("a heavy room that is alone again within its turn gives way to nothing") {
  std::atomic<bool> asks = false, go = false, passed = false;
  std::optional<Scheduler> scheduler;
  const auto light = room([](FakeTurns&) { return light_tick(); });
  const auto heavy = room([&](FakeTurns&) {
    if (Scheduler::on_patient_thread() && !passed) {
      asks = true;
      until([&] { return go.load(); });
      scheduler->give_way();
      passed = true;
    }
    return costly_tick(0.02);
  });
  scheduler.emplace(1, process_seconds, 1e6);
  scheduler->add(heavy);
  scheduler->add(light);
  until([&] { return asks.load(); });
  scheduler->remove(*light);
  until([&] { return light.use_count() == 1; });
  go = true;
  until([&] { return passed.load(); });
  CHECK(light->ends == 1);
}

TEST_CASE("heavy rooms share their threads by CPU time, not by turns") {
  Scheduler scheduler(1, process_seconds);
  const auto at = [](double cost) {
    return room([cost](FakeTurns&) { return costly_tick(cost, 1e-3); });
  };
  const auto one = at(2 * kShortTick), other = at(6 * kShortTick);
  scheduler.add(one);
  scheduler.add(other);
  until([&] { return other->turns >= 20; });
  scheduler.stop();
  until([&] { return scheduler.running() == 0; });
  CHECK(one->turns >= 2 * other->turns);
  CHECK(one->turns <= 4 * other->turns);
}

TEST_CASE("a room that is removed ends once, after its last turn, and is let go") {
  Scheduler scheduler(2, process_seconds);
  for (int round = 0; round < 50; ++round) {
    auto gone = room([](FakeTurns&) { return light_tick(); });
    const std::weak_ptr<FakeTurns> watched = gone;
    scheduler.add(gone);
    if (round % 2 == 0) until([&] { return gone->turns > 0; });
    scheduler.remove(*gone);
    until([&] { return gone->ends > 0; });
    const int turns = gone->turns;
    scheduler.wake(*gone);
    CHECK(gone->ends == 1);
    CHECK(gone->turns == turns);
    gone.reset();
    until([&] { return watched.expired(); });
  }
}

TEST_CASE("a turn that does not end, and one that has no thread, are overdue") {
  Scheduler scheduler(1, process_seconds);
  std::atomic<bool> free = false;
  const auto stuck = room([&](FakeTurns&) {
    until([&] { return free.load(); });
    return Turn{};
  });
  const auto waiting = room([](FakeTurns&) { return Turn{}; });
  scheduler.add(stuck);
  until([&] { return stuck->turns == 1; });
  scheduler.add(waiting);
  until([&] { return scheduler.overdue(*stuck) > 0.02 && scheduler.overdue(*waiting) > 0.01; });
  CHECK(waiting->turns == 0);
  free = true;
  until([&] { return waiting->turns == 1 && scheduler.running() == 0; });
  CHECK(scheduler.overdue(*stuck) == 0);
}

}  // namespace
}  // namespace weft::server
