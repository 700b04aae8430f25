#include <memory>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/worlds.h"

// A cloth that becomes another fabric while it moves.

using namespace weft;

namespace {

FabricDef heavy_fabric() {
  FabricDef fabric;
  fabric.areal_density = 0.5;
  fabric.stretch_warp = 2000;
  fabric.stretch_weft = 900;
  fabric.shear = 90;
  fabric.bending_warp = fabric.bending_weft = 2e-4;
  fabric.damping_ratio = 0.2;
  fabric.friction = 0.1;
  return fabric;
}

/// A cloth that swings from its upper border against a ball, and rubs on it.
WorldDef swinging(SolverKind solver) {
  ClothDef cloth = test::flat_cloth(11, 11, 0.5, 0.5);
  cloth.bending_model = BendingModel::hinges;
  cloth.origin = Vec3d(0, 1, 0);
  WorldDef def;
  def.cloths = {cloth};
  def.solver.kind = solver;
  def.pins = {{EdgeStrip{Side::top, 0.06}, 0, "cloth"}};
  def.colliders = {{"ball", SphereDef{Vec3d(0.25, 0.75, 0.3), 0.15}}};
  return def;
}

void step(World<float>& world, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) world.step();
}

StartDef start_of(const World<float>& world) {
  StartDef start;
  for (const Vec3f& x : world.state().x) start.x.push_back(x.cast<double>());
  for (const Vec3f& v : world.state().v) start.v.push_back(v.cast<double>());
  return start;
}

}  // namespace

TEST_CASE("a fabric changed in motion has the future of a scene of it that starts in this state") {
  const auto solver = GENERATE(SolverKind::verlet, SolverKind::implicit, SolverKind::relaxation);
  CAPTURE(static_cast<int>(solver));
  WorldDef def = swinging(solver);
  World<float> before(def);
  step(before, 40);
  const auto changed = before.with_fabric(0, heavy_fabric());
  def.cloths[0].fabric = heavy_fabric();
  def.start = start_of(before);
  World<float> loaded(def);
  for (int tick = 0; tick < 60; ++tick) {
    changed->step();
    loaded.step();
    REQUIRE(changed->state().x == loaded.state().x);
    REQUIRE(changed->state().v == loaded.state().v);
  }
  CHECK(changed->report().substeps == loaded.report().substeps);
  World<float> unchanged(swinging(solver));
  step(unchanged, 100);
  CHECK(changed->state().x != unchanged.state().x);
}

TEST_CASE("trying a fabric on leaves the world as it was, and a refused one is named") {
  World<float> world(swinging(SolverKind::verlet)), untouched(swinging(SolverKind::verlet));
  step(world, 20);
  step(untouched, 20);
  world.with_fabric(0, heavy_fabric());
  FabricDef wrong = heavy_fabric();
  wrong.areal_density = -1;
  try {
    world.with_fabric(0, wrong);
    FAIL("a negative density was taken");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "fabric.areal_density");
  }
  WorldDef both = swinging(SolverKind::verlet);
  both.cloths.push_back(test::flat_cloth(5, 5, 0.2, 0.2));
  both.cloths[1].name = "other";
  try {
    World<float>(both).with_fabric(1, wrong);
    FAIL("a negative density was taken");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "cloths[1].fabric.areal_density");
  }
  FabricDef stiff = heavy_fabric();
  stiff.areal_density = 1e-3;
  stiff.stretch_warp = stiff.stretch_weft = stiff.shear = 1e6;
  WorldDef fine = swinging(SolverKind::verlet);
  fine.cloths[0].rows = fine.cloths[0].columns = 31;
  CHECK_THROWS_AS(World<float>(fine).with_fabric(0, stiff), DefinitionError);
  step(world, 20);
  step(untouched, 20);
  CHECK(world.hash() == untouched.hash());
}

TEST_CASE(
    "a fabric that the present folds would wind up like a spring is refused with the energy") {
  WorldDef def;
  ClothDef cloth = test::flat_cloth(21, 21, 0.5, 0.5);
  cloth.origin = Vec3d(0, 0.5, 0);
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d(0, 1, 0.1).normalized();
  def.cloths = {cloth};
  def.colliders = {{"ground", PlaneDef{}}};
  def.contact.seed.self = SelfContact::guard;
  World<float> flat(def);
  FabricDef board = cloth.fabric;
  board.bending_warp = board.bending_weft = 10;
  CHECK_NOTHROW(flat.with_fabric(0, board));  // nothing is bent yet
  step(flat, 60);                             // it crumples
  const std::uint64_t hash = flat.hash();
  try {
    flat.with_fabric(0, board);
    FAIL("crumpled cloth became a board");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "fabric");
    CHECK_THAT(error.value, Catch::Contains(" J in the present shape"));
  }
  CHECK(flat.hash() == hash);
  board.bending_warp = board.bending_weft = 2 * cloth.fabric.bending_warp;
  CHECK_NOTHROW(flat.with_fabric(0, board));
}

TEST_CASE("stretched cloth is not made so light that its own energy would throw it") {
  FabricDef heavy;
  heavy.areal_density = 10;
  WorldDef def = swinging(SolverKind::verlet);
  def.cloths[0].fabric = heavy;
  World<float> world(def);
  step(world, 60);
  const Energies& energies = world.report().energies;
  const double energy = energies.stretch + energies.bending;
  const ClothDef& cloth = def.cloths[0];
  const double area = cloth.width * cloth.height;
  FabricDef light = heavy;
  // Released, all of it would be kinetic: the mass at which that is a speed of 30 m/s.
  light.areal_density = energy / (450 * area);
  REQUIRE(light.areal_density > 1.1e-3);
  light.areal_density *= 0.95;
  CHECK_THROWS_AS(world.with_fabric(0, light), DefinitionError);
  light.areal_density *= 1.1;
  CHECK_NOTHROW(world.with_fabric(0, light));
}

TEST_CASE("a fabric unlike the scene's is in the hash, survives a reset, and may be taken back") {
  const World<float> world(swinging(SolverKind::verlet));
  const auto changed = world.with_fabric(0, heavy_fabric());
  CHECK(changed->hash() != world.hash());
  changed->step();
  changed->reset();
  CHECK(changed->def().cloths[0].fabric.areal_density == 0.5);
  const auto back = changed->with_fabric(0, world.def().cloths[0].fabric);
  CHECK(back->hash() == world.hash());
}

TEST_CASE("a change of one cloth's fabric moves no other cloth") {
  WorldDef def = swinging(SolverKind::verlet);
  def.cloths.push_back(test::flat_cloth(9, 9, 0.4, 0.4));
  def.cloths[1].name = "other";
  def.cloths[1].origin = Vec3d(5, 1, 0);
  World<float> world(def);
  step(world, 20);
  const auto changed = world.with_fabric(0, heavy_fabric());
  const auto first = static_cast<std::size_t>(world.model().parts[1].particles.first);
  changed->step();
  world.step();
  const double dt = world.tick_seconds();
  for (std::size_t i = first; i < world.state().x.size(); ++i)
    CHECK((changed->state().x[i] - world.state().x[i]).norm() < 1e-3 * dt);
}

TEST_CASE("a hand keeps its grip through a change of fabric, with the damping of the new masses") {
  World<float> world(swinging(SolverKind::verlet));
  const ClothHit hit = *world.pick(Vec3d(0.25, 5, 0.4), -Vec3d::UnitY());
  GrabDef def;
  def.triangle = hit.triangle;
  def.barycentric = hit.barycentric;
  def.target = hit.position;
  const GrabId id = world.grab(def);
  const auto changed = world.with_fabric(0, heavy_fabric());
  REQUIRE(changed->grabs().list.size() == 1);
  CHECK(changed->grabs().list[0].id == id);
  WorldDef of_it = swinging(SolverKind::verlet);
  of_it.cloths[0].fabric = heavy_fabric();
  World<float> made(of_it);
  made.grab(def);
  CHECK(changed->grabs().list[0].damping == made.grabs().list[0].damping);
}

TEST_CASE("a disc holds the same particles whether its cloth bends or not, so also live") {
  ClothDef cloth = test::flat_cloth(21, 31, 0.6, 0.4);
  WorldDef def = test::empty_world(cloth);
  def.pins = {{10 * 31 + 15, 0.08}};
  const auto held = [](const World<float>& world) { return world.pins().list.at(0).particles; };
  const World<float> bends(def);
  FabricDef limp = def.cloths[0].fabric;
  limp.bending_warp = limp.bending_weft = 0;
  CHECK(held(*bends.with_fabric(0, limp)) == held(bends));
  def.cloths[0].fabric = limp;
  const World<float> falls(def);
  CHECK(held(falls) == held(bends));
}

TEST_CASE("a strip of a mesh that is pinned while it does not bend is clamped once it does") {
  ClothMesh mesh;
  for (Index r = 0; r < 5; ++r) {
    for (Index c = 0; c < 21; ++c) {
      mesh.mesh.positions.push_back(Vec3d(0.01 * c, 0, 0.01 * r));
      mesh.uv.push_back({0.01 * c, 0.01 * r});
    }
  }
  for (Index r = 0; r + 1 < 5; ++r) {
    for (Index c = 0; c + 1 < 21; ++c) {
      const Index a = 21 * r + c;
      mesh.mesh.triangles.push_back({a, a + 1, a + 21});
      mesh.mesh.triangles.push_back({a + 1, a + 22, a + 21});
    }
  }
  ClothDef strip;
  strip.mesh = mesh;
  strip.fabric.bending_warp = strip.fabric.bending_weft = 0;
  strip.fabric.bending_damping = 0;
  WorldDef def = test::empty_world(strip);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.pins = {{EdgeStrip{Side::left, 0.055}, 0, {}}};
  FabricDef stiff = strip.fabric;
  stiff.bending_warp = stiff.bending_weft = 1e-3;
  const std::unique_ptr<World<float>> changed = World<float>(def).with_fabric(0, stiff);
  def.cloths[0].fabric = stiff;
  World<float> built(def);
  for (int tick = 0; tick < 30; ++tick) {
    changed->step();
    built.step();
  }
  CHECK(changed->state().x == built.state().x);
}
