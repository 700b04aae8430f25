#include "server/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <thread>

#include <catch2/catch.hpp>

using namespace weft::server;

TEST_CASE("a prompt thread has no more of the processor than before, and no other is changed") {
  const int policy = sched_getscheduler(0), niceness = getpriority(PRIO_PROCESS, 0);
  int prompt = 0, prompt_niceness = 0;
  std::thread([&] {
    be_prompt();
    prompt = sched_getscheduler(0);
    prompt_niceness = getpriority(PRIO_PROCESS, 0);
  }).join();
  CHECK(prompt == policy);
  CHECK(prompt_niceness == niceness);
  CHECK(sched_getscheduler(0) == policy);
}
