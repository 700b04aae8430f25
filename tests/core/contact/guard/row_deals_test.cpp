#include "core/contact/guard/row_deals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "core/contact/guard/row_blocks.h"
#include "core/types.h"
#include "tests/support/seeded_random.h"
#include "tests/support/targets.h"
#include "tests/support/two_threads.h"

using namespace weft;
using namespace weft::test;

namespace {

/// A pile of particles and rows among near ones: some push, slide, stick, are free or crushed.
template <class Real>
struct Pile {
  QuadArray<Real> x, v;
  std::vector<Real> pressure;
  std::vector<GuardRow<Real>> rows;
  RowSlabs<Real> slabs;

  static auto numbers_of(SeededRandom& random) {
    const auto real = [&random](double from, double to) {
      return static_cast<Real>(random.uniform(from, to));
    };
    const auto quad = [real](double size) {
      return to_quad<Real>({real(-size, size), real(-size, size), real(-size, size)});
    };
    return std::pair{real, quad};
  }

  Pile(SeededRandom& random, std::size_t particles, std::size_t count) {
    const auto [real, quad] = numbers_of(random);
    std::vector<Index> all;
    for (std::size_t i = 0; i < particles; ++i) {
      x.push_back(quad(0.05));
      x.back().lanes[0] = static_cast<Real>(i) / static_cast<Real>(particles);
      v.push_back(quad(0.3));
      pressure.push_back(real(0, 1) < 0.1 ? real(0, 6e4) : real(0, 4e3));
      all.push_back(static_cast<Index>(i));
    }
    for (std::size_t r = 0; r < count; ++r) rows.push_back(row(random, static_cast<Index>(r)));
    slabs.cut(all, x);
    for (std::size_t r = 0; r < count; ++r) slabs.add(static_cast<Index>(r), rows[r].particle);
  }

  GuardRow<Real> row(SeededRandom& random, Index number) const {
    const auto [real, quad] = numbers_of(random);
    const auto last = static_cast<double>(x.size()) - 1;
    const double middle = random.uniform(0, last), reach = number % 50 == 0 ? last : 12;
    GuardRow<Real> row;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto taken = row.particle.begin() + static_cast<std::ptrdiff_t>(k);
      do {
        row.particle[k] =
            static_cast<Index>(std::clamp(middle + random.uniform(-reach, reach), 0.0, last));
      } while (std::find(row.particle.begin(), taken, row.particle[k]) != taken);
    }
    const Real s = real(0, 1), t = real(0, 1);
    row.weight = {1 - s, s, t - 1, -t};
    Real mobility = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      row.share[k] = row.weight[k] * real(2e4, 5e4);
      mobility += row.share[k] * row.weight[k];
    }
    row.inertia = 1 / mobility;
    row.normal = quad(1);
    row.normal = row.normal * (1 / length(row.normal));
    if (dot(row.normal, weighted(row, x)) < 0) row.normal = row.normal * Real(-1);
    row.drag = tangential(row, quad(1e-6));
    row.slip = tangential(row, quad(4e-5));
    row.apart = weighted(row, x) + quad(1e-5);
    row.radius = dot(row.normal, weighted(row, x)) * real(0.7, 1.7);
    row.friction = number % 5 == 0 ? Real(0) : real(0.1, 0.6);
    row.push = number % 3 == 0 ? Real(0) : real(0, 4e-6);
    row.key = random.uniform(0, 1) < 0.5 ? std::uint64_t(number) : ~std::uint64_t(number);
    return row;
  }
};

constexpr double kStep = 2e-4, kWarm = 0.97;

// What follows is the law of one row, as the header has it.

template <class Real>
void share_out(const GuardRow<Real>& row, const Quad<Real>& impulse, QuadArray<Real>& v) {
  for (std::size_t k = 0; k < 4; ++k)
    v[static_cast<std::size_t>(row.particle[k])] += impulse * row.share[k];
}

template <class Real>
Real pressure_on(const GuardRow<Real>& row, const std::vector<Real>& pressure) {
  Real both = 0;
  for (std::size_t n = 0; n < 4; ++n)
    both += std::abs(row.weight[n]) * pressure[static_cast<std::size_t>(row.particle[n])];
  return both / 2;
}

template <class Real>
void warm_one(GuardRow<Real>& row, Pile<Real>& pile) {
  const Quad<Real> apart = weighted(row, pile.x);
  row.room = dot(row.normal, apart) - row.radius;
  if (row.push == 0 && row.room > row.radius * static_cast<Real>(kBusyRoom)) {
    row.slip = {};
  } else if (row.friction > 0) {
    row.slip += tangential(row, apart - row.apart);
  }
  row.apart = apart;
  row.least_speed = row.room > 0 ? -row.room / static_cast<Real>(kStep) : Real(0);
  if (row.push == 0) return;
  const Real over = pressure_on(row, pile.pressure) / static_cast<Real>(kCrushing) - 1;
  const Real kept = static_cast<Real>(kWarm) *
                    (1 - static_cast<Real>(kLeak) * std::clamp(over, Real(0), Real(1)));
  row.push *= kept;
  row.drag = row.drag * kept;
  share_out(row, row.normal * row.push + row.drag, pile.v);
}

template <class Real>
Quad<Real> shortened(const Quad<Real>& v, Real most) {
  const Real length2 = dot(v, v);
  return length2 > most * most ? v * (most / std::sqrt(length2)) : v;
}

template <class Real>
Real solve_one(GuardRow<Real>& row, QuadArray<Real>& velocities) {
  const Quad<Real> v = weighted(row, velocities);
  const Real speed = dot(row.normal, v);
  if (row.push == 0 && speed >= row.least_speed) return 0;
  const Real push = std::max(Real(0), row.push + (row.least_speed - speed) * row.inertia);
  const Real more = push - row.push;
  Quad<Real> change = row.normal * more;
  row.push = push;
  if (row.friction > 0) {
    const Quad<Real> slide = v - row.normal * speed;
    const Quad<Real> back =
        shortened(row.slip * static_cast<Real>(1 / kStickTime), static_cast<Real>(kFastestReturn));
    const Quad<Real> wanted = row.drag - (slide + back) * row.inertia;
    const Real most = row.friction * push, size2 = dot(wanted, wanted);
    const bool slides = size2 > most * most;
    const Quad<Real> drag = slides ? wanted * (most / std::sqrt(size2)) : wanted;
    if (slides) row.slip = shortened(row.slip, row.radius * static_cast<Real>(kMostSlip));
    change += drag - row.drag;
    row.drag = drag;
  }
  share_out(row, change, velocities);
  return std::abs(more) / row.inertia;
}

/// One row after the other, in the order of the slabs.
template <class Real, class Visit>
void one_by_one(const RowSlabs<Real>& slabs, bool upwards, Visit&& visit) {
  const auto list = [&](std::size_t number) {
    std::vector<Index> rows = slabs.list(number);
    if (!upwards) std::reverse(rows.begin(), rows.end());
    for (const Index row : rows) visit(row);
  };
  constexpr std::size_t kSlabs = RowSlabs<Real>::kSlabs;
  if (!upwards) list(kSlabs);
  for (std::size_t k = upwards ? 0 : 1; k < kSlabs; k += 2) list(k);
  for (std::size_t k = upwards ? 1 : 0; k < kSlabs; k += 2) list(k);
  if (upwards) list(kSlabs);
}

template <class Real>
struct Outcome {
  std::vector<Real> numbers, changes;
  bool operator==(const Outcome&) const = default;
};

template <class Real>
Outcome<Real> outcome(const Pile<Real>& pile, const std::vector<Real>& changes) {
  Outcome<Real> all{{}, changes};
  for (const GuardRow<Real>& row : pile.rows) {
    for (const Quad<Real>& q : {row.drag, row.slip, row.apart})
      all.numbers.insert(all.numbers.end(), {q[0], q[1], q[2]});
    all.numbers.insert(all.numbers.end(), {row.room, row.least_speed, row.push});
  }
  for (const Quad<Real>& q : pile.v) all.numbers.insert(all.numbers.end(), {q[0], q[1], q[2]});
  return all;
}

template <class Real>
Outcome<Real> singly(Pile<Real> pile) {
  std::vector<Real> changes;
  one_by_one(pile.slabs, true,
             [&](Index k) { warm_one(pile.rows[static_cast<std::size_t>(k)], pile); });
  for (const bool upwards : {true, false, true}) {
    Real most = 0;
    one_by_one(pile.slabs, upwards, [&](Index k) {
      most = std::max(most, solve_one(pile.rows[static_cast<std::size_t>(k)], pile.v));
    });
    changes.push_back(most);
  }
  return outcome(pile, changes);
}

template <class Real>
Outcome<Real> in_blocks(Pile<Real> pile, Executor* executor, RowDeals<Real>& deals) {
  deals.take(pile.slabs, pile.rows, pile.x.size(), executor);
  const Real most_pressure = *std::max_element(pile.pressure.begin(), pile.pressure.end());
  const RowPass<Real> pass{pile.x.data(),
                           pile.v.data(),
                           pile.pressure.data(),
                           most_pressure,
                           static_cast<Real>(kStep),
                           static_cast<Real>(kWarm)};
  deals.largest(executor, true, [&](auto blocks) { return Real(warm_rows(blocks, pass)); });
  std::vector<Real> changes;
  for (const bool upwards : {true, false, true}) {
    changes.push_back(deals.largest(
        executor, upwards, [&](auto blocks) { return sweep_rows(blocks, upwards, pass); }));
  }
  deals.give_back(pile.rows, executor);
  return outcome(pile, changes);
}

template <class Real>
Outcome<Real> in_blocks(const Pile<Real>& pile, Executor* executor) {
  RowDeals<Real> deals;
  return in_blocks(pile, executor, deals);
}

}  // namespace

TEMPLATE_TEST_CASE("rows that respond in blocks have the bits of one after the other", "", float,
                   double) {
  for (const std::size_t rows : {3u, 90u, 2500u}) {
    CAPTURE(rows);
    SeededRandom random(7);
    const Pile<TestType> pile(random, 900, rows);
    const Outcome<TestType> expected = singly(pile);
    REQUIRE(expected.changes.front() > 0);
    for_each_target([&] { CHECK(in_blocks(pile, nullptr) == expected); });
    TwoThreads two_threads;
    CHECK(in_blocks(pile, &two_threads) == expected);
    CHECK((two_threads.shared() > 0) == (rows > 1000));
  }
}

TEMPLATE_TEST_CASE("nothing is crushed below the pressure from which rows let go", "", float,
                   double) {
  SeededRandom random(8);
  Pile<TestType> pile(random, 600, 800);
  for (TestType& p : pile.pressure) p = std::min(p, static_cast<TestType>(0.98 * kCrushing));
  CHECK(in_blocks(pile, nullptr) == singly(pile));
}

TEST_CASE("each busy row is dealt once, into a block where nobody shares a particle with it") {
  SeededRandom random(9);
  const Pile<float> pile(random, 900, 2500);
  RowDeals<float> deals;
  deals.take(pile.slabs, pile.rows, pile.x.size(), nullptr);
  std::vector<int> dealt(pile.rows.size(), 0);
  std::size_t blocks = 0, full = 0;
  for (std::size_t number = 0; number < RowDeals<float>::kDeals; ++number) {
    for (const RowBlock<float>& block : deals.blocks(number)) {
      std::vector<std::size_t> particles;
      for (std::size_t k = 0; k < block.count; ++k) {
        ++dealt[static_cast<std::size_t>(block.row[k])];
        for (std::size_t n = 0; n < 4; ++n) particles.push_back(block.particle(n, k));
      }
      std::sort(particles.begin(), particles.end());
      CHECK(std::adjacent_find(particles.begin(), particles.end()) == particles.end());
      ++blocks;
      full += block.count == kBatchRows ? 1 : 0;
    }
  }
  CHECK(std::all_of(dealt.begin(), dealt.end(), [](int times) { return times == 1; }));
  // Else there would be no use in them.
  CHECK(full > blocks / 2);
}

TEST_CASE(
    "busy rows that stay, go, come or stand for others have the bits of one after the other") {
  SeededRandom random(12);
  Pile<float> pile(random, 900, 2500);
  RowDeals<float> deals;
  const auto take_again = [&] { CHECK(in_blocks(pile, nullptr, deals) == singly(pile)); };
  // Whether the busy rows have changed.
  const auto choose = [&pile](auto&& is_busy) {
    const std::uint64_t before = pile.slabs.changes(0);
    pile.slabs.choose(nullptr, is_busy);
    return pile.slabs.changes(0) != before;
  };
  const auto all = [](Index) { return true; };
  const auto not_every = [](Index one_of) {
    return [one_of](Index row) { return row % one_of != 0; };
  };
  take_again();
  CHECK(choose(not_every(4)));
  take_again();
  // The same rows are busy, and lie otherwise.
  for (GuardRow<float>& row : pile.rows) row.normal = row.normal * -1.0F;
  CHECK_FALSE(choose(not_every(4)));
  take_again();
  CHECK(choose(not_every(3)));
  take_again();
  CHECK(choose(all));
  take_again();
  // The last of each list go.
  CHECK(choose([](Index row) { return row < 2000; }));
  take_again();
  // One goes and another one comes.
  const std::vector<Index> list = pile.slabs.list(0);
  CHECK(choose([&](Index row) { return row < 2000 && row != list[9]; }));
  take_again();
  CHECK(choose([&](Index row) { return row < 2000 && row != list[8]; }));
  take_again();
  CHECK(choose(all));
  pile.rows.push_back(pile.row(random, 2500));
  pile.slabs.add(2500, pile.rows.back().particle);
  take_again();
  // As many rows, of other particles.
  pile.slabs.clear();
  for (Index k = 0; k <= 2500; ++k) {
    pile.rows[static_cast<std::size_t>(k)] = pile.row(random, k);
    pile.slabs.add(k, pile.rows[static_cast<std::size_t>(k)].particle);
  }
  CHECK_FALSE(choose(all));
  take_again();
  pile.slabs.clear();
  take_again();
}

TEST_CASE("a row that comes later is behind all others, and gives back what it did") {
  SeededRandom random(10);
  Pile<float> pile(random, 300, 200);
  RowDeals<float> deals;
  deals.take(pile.slabs, pile.rows, pile.x.size(), nullptr);
  CHECK(deals.pushes());
  const auto number = static_cast<Index>(pile.rows.size());
  pile.rows.push_back(pile.row(random, number));
  GuardRow<float>& late = pile.rows.back();
  late.push = 1e-3F;
  const std::size_t list = pile.slabs.add(number, late.particle);
  deals.add(list, number, pile.rows);
  Pile<float> other = pile;
  const RowPass<float> pass{pile.x.data(), pile.v.data(), nullptr, 0, 0, 0};
  deals.largest(nullptr, true, [&](auto blocks) { return sweep_rows(blocks, true, pass); });
  CHECK(late.push == 1e-3F);
  deals.give_back(pile.rows, nullptr);
  one_by_one(other.slabs, true,
             [&](Index k) { solve_one(other.rows[static_cast<std::size_t>(k)], other.v); });
  CHECK(outcome(pile, {}) == outcome(other, {}));
  deals.clear();
  CHECK_FALSE(deals.pushes());
}

TEST_CASE("blocks tell which rows lack more of their radius than pressure takes") {
  SeededRandom random(11);
  const Pile<double> pile(random, 600, 900);
  Pile<double> aimed = pile;
  RowDeals<double> deals;
  deals.take(aimed.slabs, aimed.rows, aimed.x.size(), nullptr);
  const RowPass<double> pass{aimed.x.data(), aimed.v.data(), aimed.pressure.data(), 6e4,
                             kStep,          kWarm};
  const double any =
      deals.largest(nullptr, true, [&](auto blocks) { return double(warm_rows(blocks, pass)); });
  deals.give_back(aimed.rows, nullptr);
  int lacking = 0, enough = 0;
  for (std::size_t number = 0; number < RowDeals<double>::kDeals; ++number) {
    for (const RowBlock<double>& block : deals.blocks(number)) {
      for (std::size_t k = 0; k < block.count; ++k) {
        const GuardRow<double>& row = aimed.rows[static_cast<std::size_t>(block.row[k])];
        const double taken =
            std::min(pressure_on(row, aimed.pressure) / kFlattening, kMostFlattening);
        const double lack = -row.room - row.radius * taken, slack = row.radius * kPushSlack;
        const bool is_short = -row.room > slack;
        CHECK((block.lacks >> k & 1) == (is_short && lack > slack ? 1u : 0u));
        if ((block.lacks >> k & 1) != 0) CHECK(block.lack[k] == Approx(lack).epsilon(1e-12));
        ++(block.lacks >> k & 1 ? lacking : enough);
      }
    }
  }
  CHECK(any == 1);
  CHECK(lacking > 20);
  CHECK(enough > 100);
}
