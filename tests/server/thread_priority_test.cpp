#include "server/thread_priority.h"

#include <algorithm>
#include <sys/resource.h>
#include <thread>

#include <catch2/catch.hpp>

using namespace weft::server;

namespace {

int own_niceness() {
  return getpriority(PRIO_PROCESS, 0);
}

}  // namespace

TEST_CASE("a patient thread is nicer by what was asked, a prompt one is as nice as before, alone") {
  const int usual = own_niceness();
  int patient = 0, prompt = 0;
  std::thread([&] {
    be_patient(3);
    patient = own_niceness();
  }).join();
  std::thread([&] {
    be_patient(2);
    be_prompt();
    prompt = own_niceness();
  }).join();
  CHECK(patient == std::min(usual + 3, 19));
  CHECK(prompt == std::min(usual + 2, 19));
  CHECK(own_niceness() == usual);
}
