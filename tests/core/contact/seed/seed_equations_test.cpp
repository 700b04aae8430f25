#include "core/contact/seed/seed_equations.h"

#include <limits>

#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"

using namespace weft;
using namespace weft::seed;

namespace {

const Vec3d kX1(0, 0, 0), kX2(4, 0, 0), kX3(0, 0, 2);  // area 4, normal down

bool is(const Vec3d& a, const Vec3d& b) {
  return (a - b).norm() < 1e-14;
}

}  // namespace

TEST_CASE("(7), (8): weights and distance of a particle over a triangle") {
  // x13 = (0,0,-2), x23 = (4,0,-2), x43 = (1, 0.1, -1.5). Matrix [4 4; 4 20], right side (3, 7):
  // w1 = (20*3 - 4*7)/64 = 0.5, w2 = (4*7 - 4*3)/64 = 0.25, w3 = 0.25. The normal is x13 x x23 =
  // (0,-8,0)/8, so the distance is -0.1.
  const auto p = proximity<double>(Vec3d(1, 0.1, 0.5), kX1, kX2, kX3, 0.2);
  CHECK(p.near);
  CHECK(p.weight[0] == Approx(0.5));
  CHECK(p.weight[1] == Approx(0.25));
  CHECK(p.weight[2] == Approx(0.25));
  CHECK(is(p.normal, Vec3d(0, -1, 0)));
  CHECK(p.distance == Approx(-0.1));
  // (9): 0.5 (0,0,0) + 0.25 (4,0,0) + 0.25 (0,0,2) = (1, 0, 0.5), right below the particle.
  CHECK(is(weighted<double>(p.weight, kX1, kX2, kX3), Vec3d(1, 0, 0.5)));
}

TEST_CASE("a particle is near below h, over the triangle grown by delta = h / sqrt(area)") {
  // Area 4: delta = 0.2/2 = 0.1.
  const auto near = [](double x, double y, double z) {
    return proximity<double>(Vec3d(x, y, z), kX1, kX2, kX3, 0.2).near;
  };
  CHECK(near(1, 0.199, 0.5));
  CHECK_FALSE(near(1, 0.2, 0.5));
  CHECK(near(1, -0.199, 0.5));
  CHECK(near(-0.39, 0, 1));        // w2 = -0.39/4 = -0.0975
  CHECK_FALSE(near(-0.41, 0, 1));  // w2 = -0.1025
  CHECK_FALSE(near(4.5, 0, 0));    // w2 = 1.125
  CHECK_FALSE(proximity<double>(Vec3d(1, 0, 0), kX1, kX2, Vec3d(2, 0, 0), 0.2).near);  // no area
}

TEST_CASE("(10): friction takes k_f |v_N| off the tangential speed, dissipation turns v_N") {
  const Vec3d n(0, 1, 0);
  // v_T = (3, 0, 4), 5 long; v_N = -2. k_f = 1: |v_T| becomes 5 - 2 = 3: (1.8, 0, 2.4).
  // k_diss = 0.25: the normal part becomes +0.5.
  CHECK(is(after_contact<double>({3, -2, 4}, n, 1, 0.25), {1.8, 0.5, 2.4}));
  // k_f = 3: 5 < 6, so it sticks.
  CHECK(is(after_contact<double>({3, -2, 4}, n, 3, 0.25), {0, 0.5, 0}));
  // k_f = 0 slides freely, k_f = infinity never slides.
  CHECK(is(after_contact<double>({3, -2, 4}, n, 0, 0), {3, 0, 4}));
  CHECK(is(after_contact<double>({3, -2, 4}, n, std::numeric_limits<double>::infinity(), 0),
           {0, 0, 0}));
  CHECK(is(after_contact<double>({0, 0, 0}, n, 1, 0.5), {0, 0, 0}));
}

TEST_CASE("(11): two equal masses exchange m v_N / 2 and end with the same normal velocity") {
  // m = 0.5, v_N = 3: I = 0.75; each changes by I/m = 1.5. One came with -3: both end with -1.5.
  using Two = std::array<double, 2>;
  const Two weight = {1, -1};
  const double impulse = weighted_impulse(3.0, weight, Two{2, 2});
  CHECK(impulse == Approx(0.5 * 3 / 2));
  CHECK(-3 + impulse * 2 == Approx(0 - impulse * 2));
  CHECK(weighted_impulse(3.0, weight, Two{2, 0}) == Approx(1.5));  // a pinned one: all of it
  CHECK(weighted_impulse(3.0, weight, Two{0, 0}) == 0);
}

TEST_CASE("(12): a particle on the middle of a triangle") {
  // m = 2, w = 1/3 each, v_N = 1: I = m v_N/2 = 1, I~ = 2 I/(1 + 3/9) = 1.5. The particle changes
  // by I~/m = 0.75, each corner by w I~/m = 0.25: from -1 and 0 to -0.25 all.
  const double third = 1.0 / 3;
  const std::array<double, 4> weight = {1, -third, -third, -third}, w = {0.5, 0.5, 0.5, 0.5};
  const double impulse = weighted_impulse(1.0, weight, w);
  CHECK(impulse == Approx(1.5));
  CHECK(-1 + impulse * 0.5 == Approx(-0.25));
  CHECK(-third * impulse * 0.5 == Approx(-0.25));
}

TEST_CASE("two crossing edges, closest in their middles") {
  // Weights 1/2, 1/2, -1/2, -1/2 and m = 1: 1 + ... becomes 4/4 = 1, so the impulse is m v_N = 2;
  // every end changes by 1: from -2 and 0 to -1 both.
  const std::array<double, 4> weight = {0.5, 0.5, -0.5, -0.5}, w = {1, 1, 1, 1};
  CHECK(weighted_impulse(2.0, weight, w) == Approx(2));
}

TEST_CASE("the fold map lifts the deepest to eps, leaves tau, and keeps the order") {
  // phi_min = -0.01, tau = 0.03, eps = 0.002: 0.01 goes to 0.002 + 0.02 * 0.028/0.04 = 0.016.
  CHECK(fold_map(0.01, -0.01, 0.03, 0.002) == Approx(0.016));
  CHECK(fold_map(-0.01, -0.01, 0.03, 0.002) == Approx(0.002));
  CHECK(fold_map(0.03, -0.01, 0.03, 0.002) == 0.03);
  CHECK(fold_map(0.05, -0.01, 0.03, 0.002) == 0.05);
  CHECK(fold_map(0.01, 0.004, 0.03, 0.002) == 0.01);  // nothing is too deep
  test::SeededRandom random(1);
  for (int n = 0; n < 1000; ++n) {
    const double deepest = random.uniform(-0.05, 0);
    double a = random.uniform(deepest, 0.04), b = random.uniform(deepest, 0.04);
    if (a > b) std::swap(a, b);
    const double low = fold_map(a, deepest, 0.03, 0.002), high = fold_map(b, deepest, 0.03, 0.002);
    REQUIRE(low <= high);
    REQUIRE(low >= 0.002 - 1e-15);
    REQUIRE((a == b || low < high));
  }
}
