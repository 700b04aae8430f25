#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/world/crossing_counter.h"
#include "core/world/world.h"
#include "tests/support/random.h"

// What is thinner than a cell of the cloth has no particle inside, and crosses it all the same.

using namespace weft;
using namespace weft::test;

namespace {

/// Four by four particles, 0.9 m, level at 0.5 m.
WorldDef coarse_sheet(const ShapeDef& thin) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.name = "sheet";
  cloth.rows = cloth.columns = 4;
  cloth.width = cloth.height = 0.9;
  cloth.origin = Vec3d(-0.45, 0.5, -0.45);
  cloth.v = Vec3d::UnitZ();
  def.colliders = {{"post", thin}};
  return def;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.positions) p += by;
  return mesh;
}

/// A flat sheet whose vertices lie so far off their places in its plane that triangles are turned
/// over on their neighbours.
WorldDef flipped_sheet(unsigned seed) {
  constexpr Index kSide = 25;
  constexpr double kCell = 0.02;
  Random random(seed);
  ClothMesh mesh;
  for (Index r = 0; r < kSide; ++r) {
    for (Index c = 0; c < kSide; ++c) {
      const double x = kCell * (c + random.uniform(-0.45, 0.45));
      const double z = kCell * (r + random.uniform(-0.45, 0.45));
      mesh.mesh.positions.emplace_back(x, 0.5, z);
    }
  }
  for (Index r = 0; r + 1 < kSide; ++r) {
    for (Index c = 0; c + 1 < kSide; ++c) {
      const Index a = r * kSide + c, b = a + 1, d = a + kSide, e = d + 1;
      mesh.mesh.triangles.push_back({a, e, b});
      mesh.mesh.triangles.push_back({a, d, e});
    }
  }
  WorldDef def;
  def.cloths[0].name = "sheet";
  def.cloths[0].mesh = mesh;
  // Turned over, a triangle of constant strain is at rest; edges part them within a tick.
  def.cloths[0].membrane_model = MembraneModel::springs;
  def.cloths[0].fabric.thickness = 0.001;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

}  // namespace

TEST_CASE("a thing that starts through a cloth between its particles is a bad start") {
  const Vec3d middle(0, 0.5, 0), corner(0.3, 0.5, 0.3);
  for (const Vec3d& at : {middle, corner}) {
    const Vec3d up(0, 0.4, 0);
    const ShapeDef shapes[] = {
        BoxDef{at, Vec3d(0.05, 0.4, 0.05)}, MeshDef{moved(box_mesh(Vec3d(0.04, 0.3, 0.06)), at)},
        CapsuleDef{at - up, at + up, 0.02}, CapsuleDef{at + Vec3d(0, 0.01, 0), at + up, 0.03},
        SphereDef{at + Vec3d(0.01, 0.02, 0), 0.05}};
    for (const ShapeDef& shape : shapes) {
      const World<float> world(coarse_sheet(shape));
      const ComingStarts starts = world.coming_bad_starts();
      INFO("shape " << shape.index() << " at " << at.transpose());
      REQUIRE(starts.what.size() == 1);
      CHECK(starts.what[0].find("sheet started ") == 0);
      CHECK(starts.pairs > 0);
    }
  }
}

TEST_CASE("what stands beside a cloth, and what only touches it, is no bad start") {
  const ShapeDef shapes[] = {BoxDef{Vec3d(0, 0.2, 0), Vec3d(0.05, 0.29, 0.05)},
                             CapsuleDef{Vec3d(0, 0, 0), Vec3d(0, 0.44, 0), 0.05},
                             SphereDef{Vec3d(0, 0.4, 0), 0.095},
                             BoxDef{Vec3d(0.6, 0.5, 0), Vec3d(0.1, 0.4, 0.1)}};
  for (const ShapeDef& shape : shapes) {
    const World<float> world(coarse_sheet(shape));
    const ComingStarts starts = world.coming_bad_starts();
    INFO("shape " << shape.index());
    CHECK(starts.what.empty());
    CHECK(starts.meetings.empty());
    CHECK(starts.pairs == 0);
  }
}

TEST_CASE("a look ahead tells of triangles that lie flat on their neighbours and go through them") {
  int crossed = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    World<float> world(flipped_sheet(seed));
    const ComingStarts starts = world.coming_bad_starts();
    CrossingCounter<float> counter;
    world.step();
    const std::size_t found = counter.count(world).total();
    INFO("seed " << seed << ", " << found << " crossings");
    crossed += found > 0 ? 1 : 0;
    if (found == 0) continue;
    REQUIRE_FALSE(starts.what.empty());
    CHECK(starts.what[0] == "sheet started through itself");
    CHECK(starts.pairs > 0);
  }
  CHECK(crossed > 0);
}

TEST_CASE("meetings add up to the crossings that are counted, with the objects and cloths named") {
  WorldDef def = coarse_sheet(BoxDef{Vec3d(0, 0.5, 0), Vec3d(0.05, 0.4, 0.05)});
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "upright";
  def.cloths[1].origin = Vec3d(-0.41, 0.2, 0.27);
  def.cloths[1].v = Vec3d::UnitY();
  def.colliders.push_back({"far", BoxDef{Vec3d(3, 0.5, 0), Vec3d(0.1, 0.1, 0.1)}});
  const World<float> world(def);
  CrossingCounter<float> counter;
  std::vector<Meeting> meetings;
  const WorldCrossings found = counter.count(world, &meetings);
  std::size_t cloths = 0, objects = 0;
  for (const Meeting& m : meetings) {
    (m.collider == kNone ? cloths : objects) += m.count;
    CHECK(m.collider != 1);
    if (m.collider == kNone) CHECK((m.cloth == 0 && m.other == 1));
  }
  CHECK(cloths == found.cloths.all());
  CHECK(objects == found.objects.all());
  CHECK(cloths > 0);
  CHECK(objects > 0);
}
