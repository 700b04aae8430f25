#include "core/contact/guard/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "core/contact/feature_pair.h"
#include "tests/support/seeded_random.h"

// What regions promise after any number of waves of anchoring.

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

constexpr std::size_t kParticles = 60, kPairs = 400;

/// Particles in a box, and pairs of any four of them.
template <class Real>
struct Soup {
  GuardedPairs<Real> pairs;
  GuardedStep<Real> step;
  Regions<Real> regions;
  GuardCounts counts;

  explicit Soup(Random& random) {
    step.from.resize(kParticles);
    step.displacement.assign(kParticles, {});
    for (Quad<Real>& x : step.from) x = to_quad<Real>(random.vector(0.1).template cast<Real>());
    regions.smallest_gap = Real(1e-6);
    regions.anchor = step.from;
    regions.sizes.assign(kParticles, Quad<Real>{{0, 0, -1, 0}});
    regions.wave_of.assign(kParticles, 0);
    regions.anchored_at.assign(kParticles, 0);
    regions.parts.resize(16);
    pairs.is_active.assign(kParticles, 0);
    while (pairs.all.size() < kPairs) add_pair(random);
    pairs.list_all(kParticles, nullptr);
    step.number = 1;
    share_all_gaps(pairs, step, nullptr, regions);
  }

  void add_pair(Random& random) {
    GuardedPair<Real> pair;
    pair.kind = random.index(2) == 0 ? PairKind::vertex_triangle : PairKind::edge_edge;
    for (Index& i : pair.particle) i = static_cast<Index>(random.index(kParticles));
    std::array<Index, 4> sorted = pair.particle;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return;
    measure(regions, pair);
    if (pair.bound > regions.smallest_gap) pairs.all.push_back(pair);
  }

  /// All want to move, most of them little; those that would leave their regions get new ones, and
  /// go no farther than these allow.
  void go_on(Random& random) {
    ++step.number;
    regions.anchored.clear();
    const double most = std::pow(10, random.uniform(-4, -1.5));
    for (Quad<Real>& way : step.displacement) {
      const double size = random.uniform(0, 1) < 0.1 ? most : most / 30;
      way = to_quad<Real>(random.vector(size).template cast<Real>());
    }
    find_loose(pairs.active, step, regions);
    loose = regions.loose;
    anchor_loose(pairs, step, regions, nullptr, counts);
  }

  void move() {
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Quad<Real> off = step.from[i] + step.displacement[i] - regions.anchor[i];
      if (dot(off, off) <= regions.radius(i) * regions.radius(i))
        step.from[i] += step.displacement[i];
    }
  }

  std::vector<Index> loose;
};

/// Distance of a pair's sides, as separate_pair finds it in double precision [m].
template <class Real>
double true_gap(const GuardedPair<Real>& pair, const QuadArray<Real>& x) {
  PairPoints<double> points;
  for (std::size_t k = 0; k < 4; ++k)
    points[k] = to_vector(x[at_index(pair.particle[k])]).template cast<double>();
  return separate_pair(pair.kind, points).gap;
}

/// After each wave the bound of a pair is no more than the gap between its anchors, and its sides'
/// regions do not fill more than that.
template <class Real>
void check_regions(unsigned seed) {
  SeededRandom random(seed);
  Soup<Real> soup(random);
  int lowered = 0, anchored = 0;
  for (int n = 0; n < 300; ++n) {
    const std::vector<GuardedPair<Real>> before = soup.pairs.all;
    soup.go_on(random);
    const Regions<Real>& regions = soup.regions;
    for (const Index k : soup.loose) {
      const Quad<Real> off = soup.step.from[at_index(k)] - regions.anchor[at_index(k)];
      CHECK(dot(off, off) == 0);
    }
    for (std::size_t k = 0; k < soup.pairs.all.size(); ++k) {
      const GuardedPair<Real>& pair = soup.pairs.all[k];
      const double gap = true_gap(pair, regions.anchor);
      const auto [first, second] =
          largest_on_sides(pair, [&](std::size_t i) { return regions.radius(i); });
      INFO("step " << n << ", pair " << k << ", bound " << pair.bound << ", gap " << gap);
      REQUIRE(static_cast<double>(pair.bound) <= gap + 1e-7);
      REQUIRE(first + second <= std::max(Real(0), pair.bound - regions.smallest_gap) + Real(1e-7));
      lowered +=
          pair.bound < before[k].bound && static_cast<double>(pair.bound) < gap - 1e-5 ? 1 : 0;
    }
    for (std::size_t i = 0; i < kParticles; ++i) CHECK(regions.sizes[i][kAheadLane] == -1);
    anchored += static_cast<int>(regions.anchored.size());
    soup.move();
  }
  // Both ways to renew a bound were taken.
  CHECK(lowered > 100);
  CHECK(anchored > 1000);
}

}  // namespace

TEST_CASE("bounds of gaps never exceed them, and regions never fill more, however anchors move",
          "[core][guard]") {
  check_regions<float>(11);
  check_regions<double>(12);
}
