#include "core/geometry/bottom_up_tree.h"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "core/cloth/cloth_model.h"
#include "core/error.h"
#include "core/geometry/bvh.h"
#include "core/geometry/triangle_mesh.h"
#include "core/scenes/dress_form.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"

using namespace weft;
using namespace weft::test;

namespace {

using Pairs = std::set<std::array<Index, 2>>;

template <class Real, std::size_t Corners>
std::vector<Aabb<Real>> boxes_around(const Vec3Array<Real>& x,
                                     const std::vector<std::array<Index, Corners>>& primitives,
                                     Real margin) {
  std::vector<Aabb<Real>> boxes;
  for (const std::array<Index, Corners>& p : primitives) {
    Aabb<Real> box;
    for (const Index v : p) box.add(x[static_cast<std::size_t>(v)]);
    boxes.push_back(box.grown(margin));
  }
  return boxes;
}

template <class Real>
Pairs pairs_by_brute_force(const std::vector<Aabb<Real>>& a, const std::vector<Aabb<Real>>& b) {
  Pairs pairs;
  for (std::size_t p = 0; p < a.size(); ++p) {
    for (std::size_t q = 0; q < b.size(); ++q) {
      if (a[p].overlaps(b[q])) pairs.insert({static_cast<Index>(p), static_cast<Index>(q)});
    }
  }
  return pairs;
}

template <class Real>
Pairs pairs_by_default_tree(const std::vector<Aabb<Real>>& a, const std::vector<Aabb<Real>>& b) {
  Pairs pairs;
  Bvh<Real> tree;
  tree.build(b);
  for (std::size_t p = 0; p < a.size(); ++p) {
    tree.for_each_overlap(a[p], [&](Index q) { pairs.insert({static_cast<Index>(p), q}); });
  }
  return pairs;
}

/// A cloth, crumpled at random, with boxes of its particles, edges and triangles.
template <class Real>
struct Crumpled {
  ClothModel<Real> model = build_cloth<Real>(flat_cloth(13, 17));
  std::vector<std::array<Index, 1>> particles;
  std::vector<Aabb<Real>> particle_boxes, triangle_boxes, edge_boxes;

  Crumpled() {
    for (Index i = 0; i < model.particle_count(); ++i) particles.push_back({i});
  }
  void shake(unsigned seed) {
    Random random(seed);
    const Vec3Array<Real> x = shaken(model, random.uniform(0, 0.3), random);
    particle_boxes = boxes_around(x, particles, Real(0.02));
    triangle_boxes = boxes_around(x, model.triangles, Real(0.001));
    edge_boxes = boxes_around(x, model.edges, Real(0.001));
  }
};

}  // namespace

TEMPLATE_TEST_CASE("the seed's trees give the pairs of brute force and of the default tree", "",
                   float, double) {
  using Real = TestType;
  Crumpled<Real> cloth;
  cloth.shake(1);
  BottomUpTree<Real> particles, triangles;
  particles.build(cloth.particle_boxes, cloth.model.edges);
  triangles.build(cloth.triangle_boxes, pairs_that_touch(cloth.model.triangles));
  for (const unsigned seed : seeds(1, 5)) {
    const Repeatable repeatable(seed);
    cloth.shake(seed);
    particles.refit(cloth.particle_boxes);
    triangles.refit(cloth.triangle_boxes);
    std::size_t visits = 0;
    Pairs pairs;
    particles.for_each_pair(triangles, [&](Index p, Index t) {
      pairs.insert({p, t});
      ++visits;
    });
    const Pairs expected = pairs_by_brute_force(cloth.particle_boxes, cloth.triangle_boxes);
    CHECK(expected.size() > cloth.model.triangles.size());
    CHECK(pairs == expected);
    CHECK(pairs == pairs_by_default_tree(cloth.particle_boxes, cloth.triangle_boxes));
    CHECK(visits == pairs.size());
  }
}

TEST_CASE("pairs within a tree are every two overlapping primitives once") {
  Crumpled<double> cloth;
  cloth.shake(7);
  BottomUpTree<double> edges;
  edges.build(cloth.edge_boxes, pairs_that_touch(cloth.model.edges));
  std::size_t visits = 0;
  Pairs pairs;
  edges.for_each_own_pair([&](Index a, Index b) {
    pairs.insert({std::min(a, b), std::max(a, b)});
    ++visits;
  });
  Pairs expected;
  for (const auto& pair : pairs_by_brute_force(cloth.edge_boxes, cloth.edge_boxes)) {
    if (pair[0] < pair[1]) expected.insert(pair);
  }
  CHECK(pairs == expected);
  CHECK(visits == expected.size());
}

TEST_CASE("each level groups two by two what is below it, up to one box around everything") {
  // 221 particles: 221, 111, 56, 28, 14, 7, 4, 2, 1.
  Crumpled<double> cloth;
  cloth.shake(3);
  BottomUpTree<double> tree;
  tree.build(cloth.particle_boxes, cloth.model.edges);
  REQUIRE(tree.level_count() == 9);
  std::size_t expected = 221;
  for (int level = 8; level >= 0; --level, expected = (expected + 1) / 2) {
    const auto boxes = tree.boxes_of_level(level);
    CHECK(boxes.size() == expected);
    CHECK(boxes_of_level(tree, level).size() == expected);
    Aabb<double> all;
    for (const Aabb<double>& box : boxes) all.add(box);
    CHECK(all.lower == tree.boxes_of_level(0)[0].lower);
    CHECK(all.upper == tree.boxes_of_level(0)[0].upper);
  }
  CHECK(tree.boxes_of_level(9).empty());
  CHECK(tree.boxes_of_level(-1).empty());
}

TEST_CASE("neighbours are grouped: boxes of the level above the triangles hold two that touch") {
  const TriangleMesh form = make_dress_form();
  Vec3Array<double> x(form.positions.begin(), form.positions.end());
  const auto boxes = boxes_around<double>(x, form.triangles, 0);
  BottomUpTree<double> tree;
  tree.build(boxes, pairs_that_touch(form.triangles));
  // Unless neighbours were grouped, half of the boxes would span the form; a pair of neighbours
  // spans less than two of the longest edge.
  double longest = 0;
  for (const Triangle& t : form.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(
          longest,
          (x[static_cast<std::size_t>(t[k])] - x[static_cast<std::size_t>(t[(k + 1) % 3])]).norm());
  }
  const auto pairs = tree.boxes_of_level(tree.level_count() - 2);
  const auto wide = std::count_if(pairs.begin(), pairs.end(), [&](const Aabb<double>& box) {
    return (box.upper - box.lower).norm() > 2 * longest;
  });
  // What greedy matching leaves alone is paired with what else is alone.
  CHECK(static_cast<double>(wide) < 0.1 * static_cast<double>(pairs.size()));
}

TEST_CASE("trees of nothing, of one and of primitives without neighbours work") {
  BottomUpTree<double> none, one, strangers;
  none.build({}, {});
  CHECK(none.level_count() == 0);
  CHECK(none.boxes_of_level(0).empty());
  Aabb<double> box;
  box.add(Vec3d::Zero());
  one.build({box}, {});
  CHECK(one.level_count() == 1);
  strangers.build(std::vector<Aabb<double>>(5, box), {});
  std::size_t visits = 0;
  const auto count = [&](Index, Index) { ++visits; };
  strangers.for_each_pair(one, count);
  CHECK(visits == 5);
  strangers.for_each_own_pair(count);
  CHECK(visits == 5 + 10);
  strangers.for_each_pair(none, count);
  none.for_each_own_pair(count);
  CHECK(visits == 15);
}

TEST_CASE("refitting and walking the trees take no memory") {
  Crumpled<float> cloth;
  cloth.shake(3);
  BottomUpTree<float> particles, triangles;
  particles.build(cloth.particle_boxes, cloth.model.edges);
  triangles.build(cloth.triangle_boxes, pairs_that_touch(cloth.model.triangles));
  const std::size_t before = count_allocations();
  std::size_t visits = 0;
  particles.refit(cloth.particle_boxes);
  triangles.refit(cloth.triangle_boxes);
  particles.for_each_pair(triangles, [&](Index, Index) { ++visits; });
  triangles.for_each_own_pair([&](Index, Index) { ++visits; });
  CHECK(visits > 0);
  CHECK(count_allocations() == before);
}

TEST_CASE("a world shows the boxes of its trees by level, around the cloth as it is now") {
  World<float> world(make_scene("default"));
  CHECK(world.debug_tree_names() ==
        std::vector<std::string>{"particles", "edges", "triangles", "object:form"});
  for (int tick = 0; tick < 20; ++tick) world.step();
  Aabb<float> cloth;
  for (const Vec3f& p : world.state().x) cloth.add(p);
  for (const char* tree : {"particles", "edges", "triangles"}) {
    const auto boxes = world.debug_boxes(tree, 0);
    REQUIRE(boxes.size() == 1);
    CHECK(boxes[0].lower == cloth.lower);
    CHECK(boxes[0].upper == cloth.upper);
    for (const int level : {3, 5}) {  // more than half of 2^level
      CHECK(world.debug_boxes(tree, level).size() > 1u << (level - 1));
      CHECK(world.debug_boxes(tree, level).size() <= 1u << level);
    }
  }
  // 600 particles; what is deeper than the last level is the last.
  CHECK(world.debug_tree_levels("object:form") > 1);
  CHECK_THROWS_AS(world.debug_tree_levels("object:nobody"), DefinitionError);
  CHECK(world.debug_boxes("particles", world.debug_tree_levels("particles") - 1).size() == 600);
  CHECK(world.debug_boxes("particles", world.debug_tree_levels("particles") - 2).size() < 600);
  CHECK(world.debug_boxes("particles", 99).size() == 600);
  CHECK(world.debug_boxes("object:form", 99).size() == 1418);
  CHECK_THROWS_AS(world.debug_boxes("object:nobody", 0), DefinitionError);
  CHECK_THROWS_AS(world.debug_boxes("particles", -1), DefinitionError);
}
