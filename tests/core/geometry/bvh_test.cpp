#include "core/geometry/bvh.h"

#include <algorithm>
#include <limits>

#include <catch2/catch.hpp>

#include "core/geometry/distance.h"
#include "core/geometry/ray_cast.h"
#include "tests/support/seeded_random.h"

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

/// Boxes of every kind: spread, flat, points, all the same, on one line, far from the origin.
template <class Real>
std::vector<Aabb<Real>> boxes_of_kind(int kind, int count, Random& random) {
  std::vector<Aabb<Real>> boxes(static_cast<std::size_t>(count));
  for (Aabb<Real>& box : boxes) {
    Vec3d centre = random.vector(1), size = random.vector(0.1).cwiseAbs();
    if (kind == 1) size[1] = 0;
    if (kind == 2) size.setZero();
    if (kind == 3) centre.setZero(), size.setConstant(0.01);
    if (kind == 4) centre[1] = centre[2] = 0;
    if (kind == 5) centre = centre * 900 + Vec3d(1e3, -1e3, 1e3);
    box.add((centre - size).template cast<Real>());
    box.add((centre + size).template cast<Real>());
  }
  return boxes;
}

template <class Real>
std::vector<Index> overlaps_of(const Bvh<Real>& tree, const Aabb<Real>& box) {
  std::vector<Index> found;
  tree.for_each_overlap(box, [&](Index i) { found.push_back(i); });
  return found;
}

/// The tree may report more than overlap, as leaves are not tested one by one, but nothing twice.
template <class Real>
void check_queries(const Bvh<Real>& tree, const std::vector<Aabb<Real>>& boxes, Random& random) {
  for (int n = 0; n < 50; ++n) {
    Aabb<Real> query;
    if (!boxes.empty() && n % 2)
      query = boxes[static_cast<std::size_t>(random.index(static_cast<Index>(boxes.size())))];
    query.add(random.vector(1.2).template cast<Real>());
    if (n % 5 == 0) query.add(random.vector(1.2).template cast<Real>());
    std::vector<Index> found = overlaps_of(tree, query);
    CHECK(overlaps_of(tree, query) == found);
    std::sort(found.begin(), found.end());
    REQUIRE(std::adjacent_find(found.begin(), found.end()) == found.end());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!boxes[i].overlaps(query)) continue;
      INFO("box " << i << " of " << boxes.size());
      REQUIRE(std::binary_search(found.begin(), found.end(), static_cast<Index>(i)));
    }
  }
}

template <class Real>
void check_kinds() {
  SeededRandom random(4);
  for (int kind = 0; kind < 6; ++kind) {
    for (const int count : {0, 1, 2, 5, 64, 1000}) {
      INFO("kind " << kind << " count " << count);
      std::vector<Aabb<Real>> boxes = boxes_of_kind<Real>(kind, count, random);
      Bvh<Real> tree;
      tree.build(boxes);
      check_queries(tree, boxes, random);
      for (Aabb<Real>& box : boxes) {
        const Vec3<Real> shift = random.vector(0.3).template cast<Real>();
        box.lower += shift;
        box.upper += shift;
      }
      tree.refit(boxes);
      check_queries(tree, boxes, random);
    }
  }
}

}  // namespace

TEST_CASE("box queries find all that brute force finds, after building and after refitting") {
  SECTION("double") {
    check_kinds<double>();
  }
  SECTION("float") {
    check_kinds<float>();
  }
}

TEST_CASE("a query far away visits nothing") {
  SeededRandom random(5);
  Bvh<double> tree;
  tree.build(boxes_of_kind<double>(0, 500, random));
  Aabb<double> query;
  query.add(Vec3d(10, 10, 10));
  CHECK(overlaps_of(tree, query).empty());
}

TEST_CASE("a query without bounds visits everything once, whatever the count of the boxes") {
  SeededRandom random(9);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Aabb<float> everywhere;
  everywhere.lower.setConstant(-kInfinity);
  everywhere.upper.setConstant(kInfinity);
  // 0 to 40 boxes: every count of children that a node can lack.
  for (int count = 0; count <= 40; ++count) {
    INFO("count " << count);
    Bvh<float> tree;
    tree.build(boxes_of_kind<float>(0, count, random));
    std::vector<Index> found = overlaps_of(tree, everywhere);
    std::sort(found.begin(), found.end());
    REQUIRE(found.size() == static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) CHECK(found[static_cast<std::size_t>(i)] == i);
  }
}

TEST_CASE("a query with a bound that is no number ends") {
  SeededRandom random(10);
  Bvh<float> tree;
  tree.build(boxes_of_kind<float>(0, 13, random));
  for (int axis = 0; axis < 3; ++axis) {
    Aabb<float> query;
    query.add(Vec3<float>(-2, -2, -2));
    query.add(Vec3<float>(2, 2, 2));
    query.lower[axis] = std::numeric_limits<float>::quiet_NaN();
    CHECK(overlaps_of(tree, query).size() <= 13);
  }
}

TEST_CASE("a query of a small region visits a small part of the tree") {
  SeededRandom random(6);
  const auto boxes = boxes_of_kind<double>(2, 10000, random);
  Bvh<double> tree;
  tree.build(boxes);
  std::size_t visited = 0;
  for (int n = 0; n < 100; ++n) {
    Aabb<double> query;
    query.add(random.vector(1));
    visited += overlaps_of(tree, query.grown(0.02)).size();
  }
  // 0.08 boxes lie in such a region on average; leaves hold four.
  CHECK(visited < 100 * 16);
}

TEST_CASE("a hundred thousand boxes in one place build a tree that can be searched") {
  SeededRandom random(7);
  const auto boxes = boxes_of_kind<float>(3, 100000, random);
  Bvh<float> tree;
  tree.build(boxes);
  CHECK(overlaps_of(tree, boxes[0]).size() == boxes.size());
}

TEST_CASE("nearest triangle by the tree is as near as by brute force") {
  SeededRandom random(8);
  for (const int kind : {0, 1, 2}) {
    Vec3Array<double> positions;
    std::vector<Triangle> triangles;
    for (Index t = 0; t < 300; ++t) {
      const Vec3d at = random.vector(1);
      for (int k = 0; k < 3; ++k) positions.push_back(at + random.vector(kind == 1 ? 0 : 0.1));
      if (kind == 2)
        positions.back() = positions[positions.size() - 2] * 2 - positions[positions.size() - 3];
      triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const auto distance2 = [&](const Vec3d& p, Index t) {
      const auto k = static_cast<std::size_t>(3 * t);
      return (closest_on_triangle<double>(p, positions[k], positions[k + 1], positions[k + 2])
                  .point -
              p)
          .squaredNorm();
    };
    std::vector<Aabb<double>> boxes;
    triangle_boxes<double>(positions, triangles, boxes);
    Bvh<double> tree;
    tree.build(boxes);
    for (int n = 0; n < 300; ++n) {
      const Vec3d p = random.vector(1.5);
      double brute = 1e9;
      for (Index t = 0; t < 300; ++t) brute = std::min(brute, distance2(p, t));
      std::size_t tests = 0;
      const double found = tree.nearest(
          1e9, [&](const Aabb<double>& box) { return box.squared_distance(p); },
          [&](Index t, double bound) {
            ++tests;
            return std::min(bound, distance2(p, t));
          });
      INFO("kind " << kind << " n " << n);
      REQUIRE(found == brute);
      REQUIRE(tests < 150);
    }
  }
}
