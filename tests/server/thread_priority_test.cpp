#include "server/thread_priority.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <sched.h>
#include <sys/resource.h>
#include <thread>

#include <catch2/catch.hpp>

#include "server/rooms/shared_pool.h"
#include "server/thread_pool.h"

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

TEST_CASE("threads that help a patient one are patient, those that help a prompt one are not") {
  ThreadPool prompt(2), patient(2, be_patient);
  bool alone = false;
  SharedPool shared(prompt, patient, [&] { return alone; });
  // Chunks that last until two threads have one, so that the caller cannot run both.
  struct Meeting {
    std::atomic<int> arrived = 0;
    std::array<int, 2> policies{};
  };
  const auto meet = [](void* context, int chunk) {
    auto& meeting = *static_cast<Meeting*>(context);
    meeting.policies[static_cast<std::size_t>(chunk)] = sched_getscheduler(0);
    ++meeting.arrived;
    while (meeting.arrived < 2) std::this_thread::yield();
  };
  const auto policies_of = [&](void (*become)()) {
    Meeting meeting;
    std::thread([&] {
      become();
      shared.run(2, meet, &meeting);
    }).join();
    return meeting.policies;
  };
  CHECK(policies_of(be_patient) == std::array{SCHED_IDLE, SCHED_IDLE});
  alone = true;
  const int usual = sched_getscheduler(0);
  CHECK(policies_of(be_prompt) == std::array{usual, usual});
}
