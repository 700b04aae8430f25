#include "server/room/simulation_loop.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

namespace weft::server {
namespace {

/// A room whose ticks cost time on the fake clock.
struct CostlyRoom {
  FakeClock& fake;
  double cost = 0;  ///< of a tick [s]
  double interval = 1.0 / 60;
  int ticks = 0, turns = 0;
  std::vector<int> ticks_before_command;
  bool running = true;
  int advance_left = 0;

  void take(int) { ticks_before_command.push_back(ticks); }
  void take_meanwhile(int) {}
  bool gives_up() const { return false; }
  StopSignal* stop_signal() { return nullptr; }
  bool advancing() const { return advance_left > 0; }
  void advance_until(double deadline) {
    while (advance_left > 0 && fake.now < deadline) {
      --advance_left;
      fake.now += cost;
    }
  }
  bool advance_waits() const { return false; }
  bool ticking() const { return running; }
  double tick_interval() const { return interval; }
  void tick() {
    ++ticks;
    fake.now += cost;
  }
  void finish_turn() { ++turns; }
  double next_wake() const { return fake.now + 0.25; }
};

struct FakeInbox {
  FakeClock& fake;
  std::vector<int> items;
  std::vector<int> take_all() { return std::exchange(items, {}); }
  void wait(double deadline) { fake.now = std::max(fake.now, deadline); }
  bool stopped() const { return false; }
};

struct Loop {
  FakeClock fake;
  CostlyRoom room{.fake = fake, .ticks_before_command = {}};
  FakeInbox inbox{fake, {}};
  SimulationLoop<CostlyRoom, FakeInbox> loop{room, inbox, fake.clock()};

  void run_for(double seconds) {
    const double end = fake.now + seconds;
    while (fake.now < end) {
      const double wake = loop.turn();
      if (wake > fake.now) inbox.wait(std::min(wake, end));
    }
  }
};

TEST_CASE("the loop ticks at the room's rate by its clock") {
  Loop l;
  l.room.cost = 0.001;
  l.run_for(10);
  CHECK(l.room.ticks >= 600);
  CHECK(l.room.ticks <= 601);
}

TEST_CASE("an overloaded loop does one tick a turn, never catches up, and hears each command") {
  Loop l;
  l.room.cost = 0.05;  // three times the interval
  const double start = l.fake.now;
  for (int second = 0; second < 20; ++second) {
    l.inbox.items = {1};
    l.run_for(1);
  }
  const double most = (l.fake.now - start) / l.room.cost;
  CHECK(l.room.ticks <= most + 1);
  CHECK(l.room.ticks >= most - 1);
  CHECK(l.room.turns >= l.room.ticks);
  CHECK(l.room.ticks_before_command.size() == 20);
  // Once the load is gone, only a few ticks are made up for.
  l.room.cost = 0;
  const int before = l.room.ticks;
  l.run_for(1);
  CHECK(l.room.ticks - before <= 60 + TickPacer::kMostLateTicks + 1);
}

TEST_CASE("after a stop of ten seconds at most a few ticks are caught up with") {
  Loop l;
  l.run_for(1);
  const int before = l.room.ticks;
  l.fake.now += 10;
  l.run_for(0.001);
  CHECK(l.room.ticks - before >= 2);
  CHECK(l.room.ticks - before <= TickPacer::kMostLateTicks + 1);
}

TEST_CASE("a hiccup of two ticks is made up for, so simulated time keeps up") {
  Loop l;
  l.run_for(1);
  l.fake.now += 2.0 / 60;
  l.run_for(1);
  CHECK(l.room.ticks >= 121);
}

TEST_CASE("time that passes while the room stands still is not caught up with") {
  Loop l;
  l.run_for(1);
  l.room.running = false;
  l.run_for(5);
  const int before = l.room.ticks;
  l.room.running = true;
  l.run_for(0.5);
  CHECK(l.room.ticks - before <= 31);
}

TEST_CASE("commands are heard between the slices of a long advance") {
  Loop l;
  l.room.running = false;
  l.room.advance_left = 100000;
  l.room.cost = 0.001;
  l.inbox.items = {1};
  l.loop.turn();
  l.inbox.items = {2};
  l.loop.turn();
  CHECK(l.room.ticks_before_command.size() == 2);
  CHECK(l.room.advance_left > 90000);
}

TEST_CASE("a turn in which an advance ends is not followed by an idle one, but by a due tick") {
  Loop l;
  l.room.running = false;
  l.room.advance_left = 2;
  l.room.cost = 0.02;
  CHECK(l.loop.turn() <= l.fake.now);
  CHECK(l.room.advancing());
  CHECK(l.loop.turn() > l.fake.now);
  l.room.advance_left = 1;
  l.room.running = true;
  CHECK(l.loop.turn() <= l.fake.now);
}

TEST_CASE("a tick is due for each interval that passes, each part of it at the speed of its time") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-2, 1), pause(0, 0.2);
  for (const double rate : {1.0, 5.0, 60.0, 1000.0}) {
    TickPacer pacer;
    double now = 100, speed = 1, passed = 0;  // simulated [s]
    std::uint64_t ticks = 0;
    pacer.restart(now);
    pacer.set_interval(1 / rate, now);
    const auto run_to = [&](double end) {
      while (pacer.next() <= end) {
        passed += (pacer.next() - now) * speed;
        now = pacer.next();
        REQUIRE(pacer.take_due(now));
        CHECK(passed * rate == Approx(static_cast<double>(ticks++)).margin(1e-6));
      }
      passed += (end - now) * speed;
      now = end;
    };
    for (int k = 0; k < 300; ++k) {
      run_to(now + pause(random));
      speed = std::pow(10, exponent(random));
      pacer.set_interval(1 / (rate * speed), now);
    }
    CHECK(static_cast<double>(ticks) >= passed * rate);
  }
}

TEST_CASE(
    "a room that was set to 0.01 of its speed ticks within a tick's time once it is set back") {
  for (const double rate : {1.0, 5.0, 60.0}) {
    Loop l;
    l.room.interval = 1 / rate;
    l.run_for(1.5);
    l.room.interval = 100 / rate;
    l.run_for(1.5 / rate);
    const int before = l.room.ticks;
    l.room.interval = 1 / rate;
    l.run_for(1.01 / rate);
    CHECK(l.room.ticks - before >= 1);
    CHECK(l.room.ticks - before <= 2);  // nothing is caught up with
  }
}

TEST_CASE("the real-time factor is 1 at full speed and tells slow motion") {
  RealTimeMeter meter;
  const auto run = [&meter](double per_tick) {
    meter.restart(50);
    double now = 50;
    for (int i = 0; i < 300; ++i) meter.add(1.0 / 60, now += per_tick);
    return meter.factor(now, 1);
  };
  CHECK(run(1.0 / 60) == Approx(1).margin(1e-9));
  CHECK(run(1.0 / 20) == Approx(1.0 / 3).margin(1e-9));
}

}  // namespace
}  // namespace weft::server
