#include <iostream>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"

// Properties that fail on purpose for some seed, for repeat_test.py to repeat. All are hidden.

using namespace weft::test;

namespace {

/// Fails for seed 3 alone, and tells which seeds it was tried with.
void check_all_but_three(const char* test) {
  for (const unsigned seed : seeds(1, 5)) {
    const Repeatable repeatable(seed);
    std::cout << "tried " << seed << " in " << test << '\n';
    CHECK(seed != 3);
  }
}

}  // namespace

TEST_CASE("plain", "[.fails]") {
  check_all_but_three("plain");
}

TEST_CASE("plain, with a comma", "[.fails]") {
  check_all_but_three("comma");
}

TEST_CASE("a, b, and c: commas", "[.fails]") {
  check_all_but_three("commas");
}

TEST_CASE("with [brackets], a ~, a \\ and a\"quote\"", "[.fails]") {
  check_all_but_three("brackets");
}

TEST_CASE("\"quoted\", it's $HOME and `false` (x) * 2 < 3 | 4 & 5; # 6", "[.fails]") {
  check_all_but_three("shell");
}

TEMPLATE_TEST_CASE("of a type, with a comma", "[.fails]", float, double) {
  check_all_but_three(sizeof(TestType) == 4 ? "float" : "double");
}

TEST_CASE("one seed, as a number of its own", "[.fails]") {
  SeededRandom random(7);
  const double first = random.uniform(0, 1);
  std::cout << "tried " << seed_or(7) << " in random\n";
  std::cout << "number " << first << '\n';
  CHECK(first > 1);
}

TEST_CASE("thrown, and not checked", "[.fails]") {
  for (const unsigned seed : seeds(1, 3)) {
    const Repeatable repeatable(seed);
    std::cout << "tried " << seed << " in thrown\n";
    if (seed == 3) throw std::runtime_error("three");
  }
}

TEST_CASE("cases, each with its seed", "[.fails]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    if (!is_chosen(seed)) continue;
    const Repeatable repeatable(seed);
    std::cout << "tried " << seed << " in cases\n";
    CHECK(seed != 2);
  }
}
