// How a room's time passes, apart from the room.

#include "server/room/room_clock.h"

#include <catch2/catch.hpp>

namespace weft::server {
namespace {

TEST_CASE("a paused room makes as many ticks as were asked for, and a pause forgets the others") {
  RoomClock clock(true, 0);
  CHECK_FALSE(clock.runs());
  clock.add_steps(2, 1);
  clock.add_steps(1, 1);
  CHECK(clock.runs());
  CHECK_FALSE(clock.take_step());
  CHECK_FALSE(clock.take_step());
  CHECK(clock.take_step());
  CHECK_FALSE(clock.runs());
  clock.add_steps(5, 2);
  clock.pause();
  CHECK(clock.steps_left() == 0);
  clock.resume(3);
  CHECK(clock.runs());
  CHECK_FALSE(clock.take_step());  // a room that runs counts none
}

TEST_CASE("the median of the latest ticks follows them, and one slow tick does not change it") {
  TickTimes times;
  CHECK_FALSE(times.median());
  for (int k = 0; k < 9; ++k) times.add(0.001);
  times.add(5);
  CHECK(times.median() == 0.001);
  for (std::size_t k = 0; k < kTickTimes; ++k) times.add(0.002);
  CHECK(times.median() == 0.002);
  times.clear();
  CHECK_FALSE(times.median());
}

TEST_CASE(
    "slow motion is told after some patience, again after a pause, and not while time keeps up") {
  SlowMotion slow;
  CHECK_FALSE(slow.look(0.5, 1, 10));
  CHECK_FALSE(slow.look(0.5, 1, 10 + kSlowPatience * 0.9));
  CHECK(slow.look(0.5, 1, 10 + kSlowPatience));
  CHECK_FALSE(slow.look(0.5, 1, 11 + kSlowPatience));
  CHECK(slow.look(0.5, 1, 10 + kSlowPatience + kSlowNoticePause));
  CHECK_FALSE(slow.look(1, 1, 40));  // it keeps up, and patience begins anew
  CHECK_FALSE(slow.look(0.5, 1, 50));
  CHECK(slow.look(0.5, 1, 50 + kSlowPatience));
  SlowMotion half;
  CHECK_FALSE(half.look(0.5, 0.5, 0));  // as slow as it was asked to be
  CHECK_FALSE(half.look(0.5, 0.5, 100));
}

TEST_CASE("another scene begins with springs as it says, and keeps the wanted speed") {
  RoomClock clock(false, 0);
  clock.set_speed(0.25);
  clock.set_softness(0.1);
  clock.note_tick(0.01);
  clock.begin_scene({});
  CHECK(clock.wanted_softness() == 1);
  CHECK(clock.speed() == 0.25);
  CHECK_FALSE(clock.median_tick());
}

}  // namespace
}  // namespace weft::server
