#pragma once

#include <thread>

#include "core/executor.h"

namespace weft::test {

/// Runs chunks on two threads, the last ones first, and counts those that went to the second one.
class TwoThreads : public Executor {
 public:
  void run(int chunks, void (*work)(void*, int), void* context) override {
    const auto every_second = [=](int last) {
      for (int chunk = last; chunk >= 0; chunk -= 2) work(context, chunk);
    };
    std::thread other([&] { every_second(chunks - 2); });
    every_second(chunks - 1);
    other.join();
    shared_ += chunks / 2;
  }
  int shared() const { return shared_; }

 private:
  int shared_ = 0;
};

}  // namespace weft::test
