#pragma once

#include "tests/support/random.h"
#include "tests/support/repeat.h"

namespace weft::test {

/// Random numbers of a test case that has one seed: `WEFT_SEED`, or the usual one. What fails while
/// they live prints the line that repeats it.
class SeededRandom : public Random {
 public:
  explicit SeededRandom(unsigned usual) : Random(seed_or(usual)), repeatable_(seed_or(usual)) {}

 private:
  Repeatable repeatable_;
};

}  // namespace weft::test
