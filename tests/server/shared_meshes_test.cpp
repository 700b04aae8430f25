#include "server/room/shared_meshes.h"

#include <memory>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/world.h"

// What rooms share of the objects in them.

namespace weft::server {
namespace {

TEST_CASE("equal meshes are prepared once, for as long as one of them is held") {
  SharedMeshes meshes;
  const TriangleMesh box = box_mesh(Vec3d(0.1, 0.2, 0.3));
  auto first = meshes.prepared(box);
  CHECK(meshes.prepared(TriangleMesh(box)) == first);
  TriangleMesh moved = box;
  moved.positions[0][0] -= 1e-9;
  CHECK(meshes.prepared(moved) != first);
  TriangleMesh turned = box;
  std::swap(turned.triangles[0], turned.triangles[1]);
  CHECK(meshes.prepared(turned) != first);
  const std::weak_ptr<const MeshShape<float>> held = first;
  first.reset();
  CHECK(held.expired());
  CHECK(meshes.prepared(box)->triangles.size() == 12);
}

TEST_CASE("a world with a shared mesh takes the same ticks, bit for bit, as one with its own") {
  SharedMeshes meshes;
  Runtime sharing;
  sharing.meshes = &meshes;
  const WorldDef scene = make_scene("default");
  World<float> own(scene), one(scene, sharing), other(scene, sharing);
  for (int tick = 0; tick < 60; ++tick) {
    own.step();
    one.step();
    other.step();
  }
  CHECK(one.hash() == own.hash());
  CHECK(other.hash() == own.hash());
}

}  // namespace
}  // namespace weft::server
