#include "core/contact/guard/row_slabs.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "core/types.h"
#include "tests/support/seeded_random.h"
#include "tests/support/two_threads.h"

using namespace weft;
using namespace weft::test;

namespace {

/// Particles all over a box, and rows among those that are near each other; a few are long.
struct Pile {
  SeededRandom random;
  QuadArray<float> x;
  std::vector<Index> particles;
  std::vector<std::array<Index, 4>> rows;

  explicit Pile(unsigned seed, std::size_t count = 3000) : random(seed) {
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(to_quad<float>({static_cast<float>(random.uniform(0, 0.2)),
                                  static_cast<float>(random.uniform(0, 1)),
                                  static_cast<float>(random.uniform(0, 0.2))}));
      particles.push_back(static_cast<Index>(i));
    }
    // Numbered along the box, so that near ones have near numbers.
    std::sort(x.begin(), x.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    const auto last = static_cast<double>(count) - 1;
    for (std::size_t r = 0; r < 2 * count; ++r) {
      const double middle = random.uniform(0, last), reach = r % 100 == 0 ? last : 30;
      std::array<Index, 4> row{};
      for (Index& i : row)
        i = static_cast<Index>(std::clamp(middle + random.uniform(-reach, reach), 0.0, last));
      rows.push_back(row);
    }
  }

  RowSlabs<float> slabs() const {
    RowSlabs<float> slabs;
    slabs.cut(particles, x);
    for (std::size_t r = 0; r < rows.size(); ++r) slabs.add(static_cast<Index>(r), rows[r]);
    return slabs;
  }
};

/// Sweeps rows whose outcome depends on their order within what they share.
std::vector<double> swept(const Pile& pile, Executor* executor) {
  RowSlabs<float> slabs = pile.slabs();
  std::vector<double> value(pile.x.size(), 1);
  for (int sweep = 0; sweep < 3; ++sweep) {
    slabs.largest(executor, [&](Index r) {
      const std::array<Index, 4>& row = pile.rows[static_cast<std::size_t>(r)];
      for (std::size_t k = 0; k < 4; ++k)
        value[static_cast<std::size_t>(row[k])] +=
            0.3 * value[static_cast<std::size_t>(row[(k + 1) % 4])] / (1 + r % 7);
      return 0.F;
    });
  }
  return value;
}

}  // namespace

TEST_CASE("rows of slabs that are swept at the same time have no particle in common") {
  const Pile pile(1);
  const RowSlabs<float> slabs = pile.slabs();
  std::size_t lists = 0;
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    std::vector<std::size_t> owner(pile.x.size(), RowSlabs<float>::kLists);
    for (std::size_t list = first; list < RowSlabs<float>::kSlabs; list += 2) {
      if (!slabs.list(list).empty()) ++lists;
      for (const Index r : slabs.list(list)) {
        for (const Index i : pile.rows[static_cast<std::size_t>(r)]) {
          std::size_t& mine = owner[static_cast<std::size_t>(i)];
          CHECK((mine == RowSlabs<float>::kLists || mine == list));
          mine = list;
        }
      }
    }
  }
  CHECK(lists == RowSlabs<float>::kSlabs);
  // Short rows have their slabs, and no slab has much more than its part.
  CHECK(slabs.list(RowSlabs<float>::kSlabs).size() < pile.rows.size() / 50);
  for (std::size_t list = 0; list < RowSlabs<float>::kSlabs; ++list)
    CHECK(slabs.list(list).size() < pile.rows.size() / 4);
}

TEST_CASE("a sweep visits each row once, in the order of its list") {
  const Pile pile(2);
  RowSlabs<float> slabs = pile.slabs();
  std::vector<Index> visited;
  const float largest = slabs.largest(nullptr, [&](Index r) {
    visited.push_back(r);
    return static_cast<float>(r);
  });
  CHECK(largest == static_cast<float>(pile.rows.size() - 1));
  REQUIRE(visited.size() == pile.rows.size());
  std::vector<std::size_t> turn(visited.size(), visited.size());
  for (std::size_t k = 0; k < visited.size(); ++k) turn[static_cast<std::size_t>(visited[k])] = k;
  CHECK(std::find(turn.begin(), turn.end(), visited.size()) == turn.end());
  for (std::size_t list = 0; list < RowSlabs<float>::kLists; ++list) {
    const std::vector<Index>& rows = slabs.list(list);
    for (std::size_t k = 1; k < rows.size(); ++k)
      CHECK(turn[static_cast<std::size_t>(rows[k - 1])] < turn[static_cast<std::size_t>(rows[k])]);
  }
}

TEST_CASE("rows leave the same numbers on one thread and on two") {
  TwoThreads two_threads;
  const Pile pile(3);
  CHECK(swept(pile, nullptr) == swept(pile, &two_threads));
  CHECK(two_threads.shared() > 0);
}

TEST_CASE("few rows are swept without other threads, and particles that are nowhere do no harm") {
  TwoThreads two_threads;
  Pile pile(4, 100);
  pile.x[17].lanes[1] = std::numeric_limits<float>::quiet_NaN();
  pile.x[18].lanes[1] = std::numeric_limits<float>::infinity();
  CHECK(swept(pile, nullptr) == swept(pile, &two_threads));
  CHECK(two_threads.shared() == 0);
}
