#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/contact/guard/spread_pass.h"
#include "core/contact/guard/stray_pass.h"
#include "tests/support/seeded_random.h"
#include "tests/support/targets.h"

// The guard's vector passes beside the same, particle by particle and triangle by triangle.

using namespace weft;
using test::for_each_target;
using test::SeededRandom;

namespace {

Quad<float> random_quad(SeededRandom& random, double size) {
  return to_quad<float>(random.vector(size).cast<float>());
}

/// Particles that go along their paths, more or less.
struct Crowd {
  Vec3Array<float> x, v;
  QuadArray<float> from, displacement, path, velocity;
  std::vector<float> since;
  StrayPass<float> pass;

  Crowd(std::size_t count, SeededRandom& random) {
    pass.dt = 1e-3f;
    pass.elapsed = 0.01f;
    pass.off = random_quad(random, 1e-3);
    pass.soon2 = 1e-6f;
    pass.limit2 = 2e-6f;
    for (std::size_t i = 0; i < count; ++i) {
      velocity.push_back(random_quad(random, 1));
      path.push_back(random_quad(random, 1));
      since.push_back(static_cast<float>(random.uniform(0, 0.005)));
      const Quad<float> there = path[i] + velocity[i] * (pass.elapsed - pass.dt - since[i]);
      from.push_back(there + random_quad(random, 1e-4));
      x.push_back(to_vector(from[i] + random_quad(random, 1e-4)));
      v.push_back(to_vector(velocity[i] + random_quad(random, 0.5)));
    }
    displacement.assign(count, {});
    pass.x = x.data()->data();
    pass.v = v.data()->data();
    pass.from = from.data();
    pass.displacement = displacement.data();
    pass.path = path.data();
    pass.velocity = velocity.data();
    pass.since = since.data();
  }
};

/// A rectangle of a grid by the least eigenvalue of each triangle.
bool spread_one_by_one(const SpreadPass<double>& pass) {
  const auto at = [&](int r, int c) { return pass.x[r * pass.particles + c]; };
  for (int r = 0; r < pass.rows; ++r) {
    for (int c = 0; c < pass.columns; ++c) {
      const bool falls = pass.falls[r * pass.cells + c] > 0;
      for (int k = 0; k < 2; ++k) {
        const int column = (k == 0) == falls ? c + 1 : c;
        const Quad<double> u = at(r + k, c + 1) - at(r + k, c),
                           v = at(r + 1, column) - at(r, column);
        double g[4] = {};
        for (std::size_t axis = 0; axis < 4; ++axis) {
          for (int i = 0; i < 3; ++i)
            g[axis] += (axis < 2 ? u : v)[i] * pass.axes[static_cast<std::size_t>(i)][axis];
        }
        const double middle = (g[0] + g[3]) / 2,
                     apart = std::hypot((g[0] - g[3]) / 2, (g[1] + g[2]) / 2);
        if (!(middle - apart > pass.least)) return false;
      }
    }
  }
  return true;
}

/// Part of a grid whose particles are off their places by up to a random distance.
struct SpreadRectangle {
  QuadArray<double> x;
  std::vector<double> falls;
  SpreadPass<double> pass;

  SpreadRectangle(int rows, int columns, SeededRandom& random) {
    pass.rows = rows;
    pass.columns = columns;
    pass.cells = columns + 2;
    pass.particles = pass.cells + 1;
    pass.axes = {{{1, 0, 1, 0}, {0, 1, 0, 1}, {0, 0, 0, 0}}};
    pass.least = 0.3;
    const double size = random.uniform(0, 0.6);
    for (int r = 0; r <= rows; ++r) {
      for (int c = 0; c < pass.particles; ++c)
        x.push_back(to_quad<double>(Vec3d(c, r, 0) + random.vector(size)));
    }
    for (int cell = 0; cell < rows * pass.cells; ++cell)
      falls.push_back(random.uniform(0, 1) < 0.5 ? 0 : 1);
    pass.x = x.data();
    pass.falls = falls.data();
  }
  SpreadRectangle(const SpreadRectangle&) = delete;
  SpreadRectangle& operator=(const SpreadRectangle&) = delete;
};

}  // namespace

TEST_CASE("a look at all particles finds the strays that a look at each finds, on any machine") {
  SeededRandom random(11);
  for (const std::size_t count : {1u, 3u, 15u, 16u, 17u, 64u, 100u}) {
    Crowd crowd(count, random);
    if (count == 17) crowd.v[5][1] = std::numeric_limits<float>::quiet_NaN();
    const std::size_t first = count / 5;
    std::vector<Index> expected;
    double sum[3] = {};
    bool left = false;
    for (std::size_t i = first; i < count; ++i) {
      const Quad<float> moved =
          (to_quad(crowd.x[i]) - crowd.from[i]) + to_quad(crowd.v[i]) * crowd.pass.dt;
      const Quad<float> there =
          crowd.path[i] + crowd.velocity[i] * (crowd.pass.elapsed - crowd.since[i]);
      const Quad<float> off = crowd.from[i] + moved - there, own = off - crowd.pass.off;
      for (int k = 0; k < 3; ++k) sum[k] += static_cast<double>(off[k]);
      if (dot(own, own) <= crowd.pass.soon2) continue;
      expected.push_back(static_cast<Index>(i));
      left |= !(dot(own, own) <= crowd.pass.limit2);
    }
    Quad<float> before;
    bool is_first = true;
    for_each_target([&] {
      std::vector<Index> strays;
      const StrayLook<float> found = look_for_strays(crowd.pass, first, count, strays);
      CHECK(strays == expected);
      CHECK(found.left == left);
      for (int k = 0; k < 3 && count != 17; ++k) {
        CHECK(static_cast<double>(found.sum[k]) == Approx(sum[k]).margin(1e-7));
        CHECK((is_first || found.sum[k] == before[k]));
      }
      before = found.sum;
      is_first = false;
    });
  }
}

TEST_CASE("a rectangle is stretched out where each of its triangles is, on any machine") {
  SeededRandom random(12);
  int spread = 0, runs = 0;
  for (int run = 0; run < 400; ++run) {
    const auto rows = static_cast<int>(random.uniform(1, 6)),
               columns = static_cast<int>(random.uniform(1, 20));
    const SpreadRectangle all(rows, columns, random);
    const bool expected = spread_one_by_one(all.pass);
    spread += expected ? 1 : 0;
    ++runs;
    for_each_target([&] { CHECK(is_spread(all.pass) == expected); });
  }
  CHECK(spread > runs / 5);
  CHECK(spread < runs * 4 / 5);
}

TEST_CASE("a cell is stretched out by itself as it is in a rectangle of its own, on any machine") {
  SeededRandom random(13);
  int spread = 0, cells = 0;
  for (int run = 0; run < 100; ++run) {
    const auto rows = static_cast<int>(random.uniform(1, 9)),
               columns = static_cast<int>(random.uniform(1, 9));
    const SpreadRectangle all(rows, columns, random);
    std::uint64_t expected = 0;
    for (int r = 0; r < all.pass.rows; ++r) {
      for (int c = 0; c < all.pass.columns; ++c) {
        SpreadPass<double> one = all.pass;
        one.x += r * one.particles + c;
        one.falls += r * one.cells + c;
        one.rows = one.columns = 1;
        ++cells;
        if (!spread_one_by_one(one)) continue;
        ++spread;
        expected |= std::uint64_t{1} << (kMostSpreadCells * r + c);
      }
    }
    for_each_target([&] { CHECK(spread_cells(all.pass) == expected); });
  }
  CHECK(spread > cells / 5);
  CHECK(spread < cells * 9 / 10);
}
