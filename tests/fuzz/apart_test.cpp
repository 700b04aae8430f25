#include "tests/fuzz/apart.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/time.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace weft::fuzz {
namespace {

constexpr double kLong = 100;  // more than any of these takes [s]

TEST_CASE("a process that does its work ends well, and what it wrote is kept") {
  Apart apart([] { std::fputs("done\n", stderr); }, kLong);
  const Ending ending = apart.ending();
  CHECK(ending.kind == Ending::Kind::well);
  CHECK(ending.words == "done\n");
}

TEST_CASE("a signal, an exit code and an exception are crashes, told by what they were") {
  Apart aborted([] { std::abort(); }, kLong);
  const Ending abort = aborted.ending();
  CHECK(abort.kind == Ending::Kind::crashed);
  CHECK(abort.how == "signal 6");

  Apart left([] { ::_exit(3); }, kLong);
  const Ending exit = left.ending();
  CHECK(exit.kind == Ending::Kind::crashed);
  CHECK(exit.how == "exit code 3");
}

TEST_CASE("a loop that its own timer ends is told as hung, with the place where it was") {
  Apart apart(
      [] {
        itimerval timer{};
        timer.it_value.tv_usec = 20000;
        ::setitimer(ITIMER_PROF, &timer, nullptr);
        volatile bool goes_on = true;
        while (goes_on) continue;
      },
      kLong);
  const Ending ending = apart.ending();
  CHECK(ending.kind == Ending::Kind::hung);
  CHECK(ending.words.find("it was here") != ending.words.npos);
}

TEST_CASE("what neither ends nor computes is killed") {
  Apart apart([] { ::pause(); }, 0.05);
  CHECK(apart.ending().kind == Ending::Kind::killed);
}

TEST_CASE("a process that is no longer wanted does not outlive its handle") {
  int pipe_ends[2];
  REQUIRE(::pipe(pipe_ends) == 0);
  {
    Apart apart([] { ::pause(); }, kLong);
    ::close(pipe_ends[1]);
  }
  char none = 0;
  CHECK(::read(pipe_ends[0], &none, 1) == 0);  // whoever could write is gone
  ::close(pipe_ends[0]);
}

}  // namespace
}  // namespace weft::fuzz
