#include "core/diagnostics/crossings.h"

#include <catch2/catch.hpp>

#include "core/cloth/cloth_model.h"
#include "core/math/exact_sign.h"
#include "tests/support/cloths.h"
#include "tests/support/meshes.h"
#include "tests/support/seeded_random.h"

using namespace weft;
using namespace weft::test;

namespace {

__extension__ typedef __int128 Wide;

/// The sign by whole numbers that cannot overflow.
int whole_orientation(const std::array<std::array<long long, 3>, 4>& p) {
  std::array<std::array<Wide, 3>, 3> d;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) d[r][k] = p[r][k] - p[3][k];
  Wide sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = (k + 1) % 3, n = (k + 2) % 3;
    sum += d[0][k] * (d[1][m] * d[2][n] - d[1][n] * d[2][m]);
  }
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

Vec3d in_double(const std::array<long long, 3>& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

TEST_CASE("the sign of a volume is exact where floating point is not") {
  SeededRandom random(11);
  int wrong = 0, zeros = 0;
  for (int n = 0; n < 20000; ++n) {
    // A point of the plane through three others, moved by one or not at all.
    std::array<std::array<long long, 3>, 4> p;
    const long long i = random.index(7) - 3, j = random.index(7) - 3;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t r = 0; r < 3; ++r) p[r][k] = random.index(1 << 30) - (1 << 29);
      p[3][k] = p[0][k] + i * (p[1][k] - p[0][k]) + j * (p[2][k] - p[0][k]) + random.index(3) - 1;
    }
    const Vec3d a = in_double(p[0]), b = in_double(p[1]), c = in_double(p[2]), d = in_double(p[3]);
    const int expected = whole_orientation(p);
    REQUIRE(orientation(a, b, c, d) == expected);
    const double plain = (a - d).dot((b - d).cross(c - d));
    wrong += (plain > 0 ? 1 : plain < 0 ? -1 : 0) != expected;
    zeros += expected == 0;
  }
  CHECK(wrong > 0);  // or the exact part was not needed
  CHECK(zeros > 0);
}

TEST_CASE("an edge through a triangle crosses it; through its border or corner it touches") {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 0, 1);
  const auto from_above = [&](double x, double z, double low) {
    return crossing_of({x, 1, z}, {x, low, z}, a, b, c);
  };
  CHECK(from_above(0.25, 0.25, -1).proper == 1);
  CHECK(from_above(0.25, 0.25, 0.125).proper == 0);  // ends above
  CHECK(from_above(0.25, 0.25, 0).touching == 1);    // ends on it
  CHECK(from_above(0.5, 0.5, -1).touching == 1);     // through the border
  CHECK(from_above(0, 0, -1).touching == 1);         // through a corner
  CHECK(from_above(0.75, 0.75, -1).proper == 0);     // beside it
  CHECK(from_above(0.75, 0.75, -1).touching == 0);
  const Crossings flat = crossing_of({-1, 0, 0.25}, {1, 0, 0.25}, a, b, c);
  CHECK(flat.proper + flat.touching == 0);  // coplanar
}

TEST_CASE("a needle through k layers crosses k triangles, and its own neighbours never count") {
  const int layers = GENERATE(1, 5, 40);
  Vec3Array<float> x = {Vec3f(0.2f, 1, 0.2f), Vec3f(0.2f, -1, 0.2f)};
  const std::vector<Edge> edges = {{0, 1}};
  std::vector<Triangle> triangles = {{0, 1, 2}};  // shares particles with the edge
  for (int k = 0; k < layers; ++k) {
    const float y = 0.9f - 0.04f * static_cast<float>(k);
    const auto first = static_cast<Index>(x.size());
    x.insert(x.end(), {Vec3f(0, y, 0), Vec3f(1, y, 0), Vec3f(0, y, 1)});
    triangles.push_back({first, first + 1, first + 2});
  }
  CHECK(count_self_crossings(x, edges, triangles).proper == static_cast<std::size_t>(layers));
  CHECK(count_self_crossings(x, edges, triangles).touching == 0);
}

TEST_CASE("a flat cloth that a box stands in: both count, cloth edges and box edges") {
  // One cell of 2 m with a box of 0.4 m in its middle, on one side of the diagonal: no edge of the
  // cloth meets the box, its four upright edges pierce the cloth. Of the box's faces diagonals,
  // four stand upright and pierce it too.
  const ClothModel<double> model = build_cloth<double>(flat_cloth(2, 2, 2, 2));
  TriangleMesh box = box_mesh(Vec3d(0.2, 0.2, 0.2));
  for (Vec3d& p : box.positions) p += Vec3d(1.4, 0.01, 0.5);
  const Crossings crossings =
      count_crossings(model.rest_positions, model.edges, model.triangles, box);
  CHECK(crossings.proper == 8);
  CHECK(crossings.touching == 0);
}

TEST_CASE("crossings of a crumpled cloth are those of Moeller and Trumbore's test of all pairs") {
  const ClothModel<float> model = build_cloth<float>(flat_cloth(9, 8));
  SeededRandom random(3);
  for (int n = 0; n < 5; ++n) {
    const Vec3Array<float> x = shaken(model, 0.2, random);
    std::size_t expected = 0;
    for (const Edge& e : model.edges) {
      for (const Triangle& t : model.triangles) {
        bool joined = false;
        for (const Index i : e) joined |= i == t[0] || i == t[1] || i == t[2];
        const auto p = [&](Index i) {
          return x[static_cast<std::size_t>(i)].cast<double>().eval();
        };
        expected += !joined && pierces(p(e[0]), p(e[1]), p(t[0]), p(t[1]), p(t[2]));
      }
    }
    CHECK(expected > 20);
    CHECK(count_self_crossings(x, model.edges, model.triangles).proper == expected);
  }
}
