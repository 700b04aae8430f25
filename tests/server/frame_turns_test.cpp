// When frames to all are due, and to whom they need not go.

#include "server/room/frame_turns.h"

#include <limits>

#include <catch2/catch.hpp>

namespace weft::server {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kTick = 0.02;  // [s]

TEST_CASE("a tick of the clock makes a frame at once, and only one") {
  FrameTurns turns;
  CHECK(turns.next(false) == kNever);
  turns.note_tick();
  CHECK(turns.next(false) == -kNever);
  turns.sent(1, kTick);
  CHECK(turns.next(false) == kNever);
}

TEST_CASE("while no ticks make frames commands make one in a tick's time, else none of their own") {
  FrameTurns turns;
  turns.sent(1, kTick);
  turns.note_command();
  CHECK(turns.next(true) == 1 + kTick);
  CHECK(turns.next(false) == kNever);
}

TEST_CASE("the first frame after the state was replaced waits for nothing, the next one does") {
  FrameTurns turns;
  turns.note_command();
  turns.sent(1, kTick);
  turns.note_jump();
  CHECK(turns.jumped());
  CHECK(turns.next(false) <= 1);
  turns.sent(1.001, kTick);
  CHECK_FALSE(turns.jumped());
  turns.note_jump();
  CHECK(turns.next(true) == 1.001 + kTick);
}

TEST_CASE("a frame to one viewer delays those to all as theirs do") {
  FrameTurns turns;
  turns.sent_to_one(2, kTick);
  turns.note_advance();
  CHECK(turns.next(false) == 2 + kTick);
  CHECK(turns.next_idle() == 2 + kTick);
}

TEST_CASE("the viewer of an advance is left out until something else changes") {
  FrameTurns turns;
  turns.note_command();  // is shown together with the coming ticks
  turns.begin_advance(7);
  CHECK(turns.next(true) < kNever);
  CHECK(turns.excluded() == 7);
  turns.sent(1, kTick);
  turns.note_advance();
  CHECK(turns.excluded() == 7);
  turns.note_command();
  CHECK(turns.excluded() == 0);
  turns.sent(2, kTick);
  turns.note_advance();
  CHECK(turns.excluded() == 0);
}

}  // namespace
}  // namespace weft::server
