#include "server/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <thread>

#include <catch2/catch.hpp>

using namespace weft::server;

TEST_CASE("a patient thread gets what others leave, a prompt one is as nice as before, alone") {
  const int policy = sched_getscheduler(0), niceness = getpriority(PRIO_PROCESS, 0);
  int patient = 0, prompt = 0, prompt_niceness = 0;
  std::thread([&] {
    be_patient();
    patient = sched_getscheduler(0);
  }).join();
  std::thread([&] {
    be_prompt();
    prompt = sched_getscheduler(0);
    prompt_niceness = getpriority(PRIO_PROCESS, 0);
  }).join();
  CHECK(patient == SCHED_IDLE);
  CHECK(prompt == policy);
  CHECK(prompt_niceness == niceness);
  CHECK(sched_getscheduler(0) == policy);
}
