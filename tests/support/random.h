#pragma once

#include <random>

#include "core/types.h"

namespace weft::test {

/// Random numbers that are the same for the same seed. A test case that has one seed takes a
/// SeededRandom; one that tries several tells each by a Repeatable, so that failures can be
/// repeated.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Vec3d vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Index index(Index count) { return static_cast<Index>(engine_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937 engine_;
};

}  // namespace weft::test
