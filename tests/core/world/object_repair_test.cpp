#include "core/world/object_repair.h"

#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "core/world/crossing_counter.h"
#include "core/world/world.h"

using namespace weft;

namespace {

/// A ball of triangles of the given radius, each face of a cube blown up.
TriangleMesh ball(double radius) {
  TriangleMesh mesh = box_mesh(Vec3d(1, 1, 1));
  for (int round = 0; round < 3; ++round) {
    std::vector<Triangle> finer;
    const std::vector<MeshEdge> edges = edges_of(mesh);
    const auto first = static_cast<Index>(mesh.positions.size());
    const auto middle = [&](Index a, Index b) {
      for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e].a == std::min(a, b) && edges[e].b == std::max(a, b))
          return first + static_cast<Index>(e);
      }
      return kNone;
    };
    for (const MeshEdge& e : edges)
      mesh.positions.push_back((mesh.positions[static_cast<std::size_t>(e.a)] +
                                mesh.positions[static_cast<std::size_t>(e.b)]) /
                               2);
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangles = finer;
  }
  for (Vec3d& p : mesh.positions) p *= radius / p.norm();
  return mesh;
}

/// A cloth that falls on an object.
WorldDef scene_of(TriangleMesh mesh) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 15;
  cloth.width = cloth.height = 0.6;
  cloth.origin = Vec3d(-0.3, 0.27, -0.3);
  cloth.v = Vec3d::UnitZ();
  def.colliders = {{"model", MeshDef{std::move(mesh)}}};
  return def;
}

struct Run {
  std::vector<std::string> told;
  std::uint64_t hash = 0;
  std::size_t crossings = 0;
};

Run run(WorldDef def, int ticks = 40) {
  Run result;
  result.told = repair_objects(def);
  World<float> world(def);
  CrossingCounter<float> counter;
  for (int i = 0; i < ticks; ++i) {
    world.step();
    result.crossings += counter.count(world).total();
  }
  result.hash = world.hash();
  return result;
}

}  // namespace

TEST_CASE("a ball that is turned inside out is named, and holds the cloth as the ball does") {
  const TriangleMesh model = ball(0.25);
  TriangleMesh inward = model;
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  const Run right = run(scene_of(model)), turned = run(scene_of(inward));
  CHECK(right.told.empty());
  CHECK(turned.told ==
        std::vector<std::string>{
            "model: its triangles faced inwards and are turned, so that it is solid"});
  CHECK(turned.hash == right.hash);
  CHECK(turned.crossings == 0);
}

TEST_CASE("triangles without area change nothing of an object but its list, and are told") {
  const TriangleMesh model = ball(0.25);
  TriangleMesh littered = model;
  littered.triangles.push_back({0, 0, 1});
  littered.triangles.insert(littered.triangles.begin(), {5, 7, 5});
  const Run right = run(scene_of(model)), clean = run(scene_of(littered));
  REQUIRE(clean.told.size() == 1);
  CHECK(clean.told[0] == "model: 2 of its " + std::to_string(model.triangles.size() + 2) +
                             " triangles have no area and are left out");
  CHECK(clean.hash == right.hash);
}

TEST_CASE("an object without a name is told by its place, and one that is no mesh is left alone") {
  TriangleMesh inward = box_mesh(Vec3d(0.1, 0.1, 0.1));
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  WorldDef def;
  def.colliders = {{"ground", PlaneDef{}}, {"", MeshDef{inward}}};
  const std::vector<std::string> told = repair_objects(def);
  REQUIRE(told.size() == 1);
  CHECK(told[0].starts_with("object 1: "));
  CHECK(repair_objects(def).empty());
}
