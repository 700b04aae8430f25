#include "core/world/crossing_counter.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "tests/support/allocations.h"

// Crossings of a world, counted again and again.

using namespace weft;
using weft::test::count_allocations;

namespace {

/// A sheet that stands upright, another that lies across it, and a box far off that moves on
/// command. Nothing keeps the sheets apart.
WorldDef crossed_sheets() {
  WorldDef def;
  ClothDef& sheet = def.cloths[0];
  sheet.rows = sheet.columns = 9;
  sheet.width = sheet.height = 0.4;
  sheet.origin = Vec3d(-0.2, 0.5, -0.2);
  sheet.v = Vec3d::UnitZ();
  def.cloths.push_back(sheet);
  def.cloths[1].name = "upright";
  def.cloths[1].origin = Vec3d(-0.21, 0.32, 0.013);
  def.cloths[1].v = Vec3d::UnitY();
  def.colliders = {{"box", BoxDef{Vec3d(2, 0.5, 0), Vec3d(0.05, 0.05, 0.05)}}};
  def.contact.seed.self = SelfContact::none;
  def.environment.gravity.setZero();
  return def;
}

TEST_CASE("a rod whose axis goes through a cloth is counted with the objects") {
  WorldDef def = crossed_sheets();
  def.cloths.pop_back();
  def.colliders = {{"rod", CapsuleDef{Vec3d(0.03, 0.8, 0.06), Vec3d(0.03, 1.2, 0.06), 0.01}}};
  World<float> world(def);
  CrossingCounter<float> counter;
  CHECK(counter.count(world).total() == 0);
  for (auto& p : world.state().x) p[1] = 1;
  const WorldCrossings found = counter.count(world);
  CHECK(found.cloths.all() == 0);
  CHECK(found.objects.proper == 1);
}

TEST_CASE("a counter finds what the counts of one state find, where objects are now") {
  World<float> world(crossed_sheets());
  CrossingCounter<float> counter;
  const ClothModel<float>& model = world.model();
  const std::size_t alone = counter.count(world).total();
  CHECK(alone == count_self_crossings(world.state().x, model.edges, model.triangles).all());
  CHECK(alone > 10);
  for (const Vec3d& target : {Vec3d(0.1, 0.5, 0), Vec3d(2, 0.5, 0)}) {
    MoveDef move;
    move.target.position = target;
    move.target.rotation = rotation_by(Vec3d(0.3, 0.2, 0.1));
    move.speed = 20;
    move.turn_speed = 60;
    move.force = true;
    world.move_collider(0, move);
    for (int tick = 0; tick < 60; ++tick) world.step();
    const Pose& pose = world.colliders()[0].pose;
    REQUIRE(pose.position == target);
    TriangleMesh box = box_mesh(Vec3d(0.05, 0.05, 0.05));
    for (Vec3d& p : box.positions) p = pose.position + pose.rotation * p;
    const Vec3Array<float>& x = world.state().x;
    const std::size_t with = count_crossings(x, model.edges, model.triangles, box).all();
    CHECK(counter.count(world).total() ==
          with + count_self_crossings(x, model.edges, model.triangles).all());
  }
}

TEST_CASE("the second count of a world allocates nothing, also of objects that have moved") {
  World<float> world(crossed_sheets());
  MoveDef move;
  move.target.position = Vec3d(0.1, 0.5, 0);
  move.speed = 20;
  move.force = true;
  world.move_collider(0, move);
  CrossingCounter<float> counter;
  counter.count(world);
  for (int tick = 0; tick < 30; ++tick) world.step();
  const std::size_t before = count_allocations();
  counter.count(world);
  CHECK(count_allocations() == before);
}

TEST_CASE("the smallest gap is that of what lies on an object, and none where nothing is near") {
  WorldDef def = crossed_sheets();
  def.cloths.pop_back();
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 5;
  World<float> world(def);
  CHECK(std::isinf(smallest_gap(world)));
  def.colliders = {{"floor", PlaneDef{Vec3d(0, 0.48, 0), Vec3d::UnitY()}}};
  World<float> lying(def);
  for (int tick = 0; tick < 300; ++tick) lying.step();
  const double thickness = lying.model().parts[0].fabric.thickness;
  CHECK(smallest_gap(lying) == Approx(thickness).epsilon(0.1));
}

TEST_CASE("what starts where it should not be is known before the first tick, by a look ahead") {
  WorldDef def = crossed_sheets();
  def.contact.seed.self = SelfContact::automatic;
  def.colliders[0] = {"ball", SphereDef{Vec3d(0, 0.5, 0), 0.1}};
  World<float> world(def);
  const std::uint64_t before = world.hash();
  CHECK(world.bad_starts().empty());
  const BadStarts coming = world.coming_bad_starts();
  CHECK(world.hash() == before);
  CHECK(world.tick() == 0);
  world.step();
  CHECK(coming.what == world.bad_starts());
  CHECK(coming.what.size() >= 3);  // two in the ball, and through each other
  CHECK(coming.pairs == world.open_pairs());
  CHECK(coming.pairs > 10);
}

}  // namespace
