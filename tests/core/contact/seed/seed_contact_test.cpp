#include "core/contact/seed/seed_contact.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/cloths.h"
#include "tests/support/meshes.h"
#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;
using namespace weft::test;

namespace {

/// Cloths of four particles each, all far from each other until a test places them.
struct Scene {
  SeedContactDef def;
  std::vector<ClothDef> cloths;
  std::vector<ColliderDef> colliders;
  ClothModel<double> model;
  ClothState<double> state;
  Profile profile;

  explicit Scene(int count, double thickness = 0.01) {
    for (int k = 0; k < count; ++k) {
      ClothDef cloth = flat_cloth(2, 2, 0.4, 0.4);
      cloth.origin = Vec3d(0, 10 + k, 0);
      cloth.mass_lumping = MassLumping::equal;
      cloth.fabric.thickness = thickness;
      cloth.fabric.friction = 0.5;
      cloth.fabric.restitution = 0.25;
      cloths.push_back(cloth);
    }
    model = build_cloths<double>(cloths);
    state = initial_state(model);
  }
  SeedContact<double> contact() const { return SeedContact<double>(def, model, colliders); }
};

bool is(const Vec3d& a, const Vec3d& b) {
  return (a - b).norm() < 1e-12;
}

}  // namespace

TEST_CASE("(7) to (10) on an open mesh: the particle goes back to the side that it came from") {
  // At y = -0.003 after 0.01 s with v_y = -0.4 it came from y = +0.001. v_T = (0.3, 0, 0), k_f
  // |v_N| = 0.2: v' = (0.1, 0.25 * 0.4, 0).
  Scene scene(1);
  scene.def.lift = GENERATE(0.0, 0.002);
  scene.colliders = {{"sheet", MeshDef{sheet(1)}}};
  const double side = GENERATE(1.0, -1.0);
  scene.state.x[0] = Vec3d(0.2, -0.003 * side, 0.1);
  scene.state.v[0] = Vec3d(0.3, -0.4 * side, 0);
  scene.contact().collide(scene.state, 0.01, scene.profile);
  CHECK(is(scene.state.x[0], Vec3d(0.2, side * scene.def.lift, 0.1)));
  CHECK(is(scene.state.v[0], Vec3d(0.1, 0.1 * side, 0)));
}

TEST_CASE("proximity to simple shapes is analogous: out along the normal, friction along it") {
  const auto [shape, inside, normal] = GENERATE(table<ShapeDef, Vec3d, Vec3d>({
      {PlaneDef{}, Vec3d(0.3, -0.02, 0), Vec3d(0, 1, 0)},
      {SphereDef{Vec3d(0, 1, 0), 0.5}, Vec3d(0.48, 1, 0), Vec3d(1, 0, 0)},
      {CapsuleDef{Vec3d(0, 0, 0), Vec3d(0, 1, 0), 0.2}, Vec3d(0, 0.5, 0.18), Vec3d(0, 0, 1)},
      {BoxDef{Vec3d(0, 1, 0), Vec3d(0.5, 0.2, 0.3), Eigen::Quaterniond::Identity()},
       Vec3d(0.1, 0.82, 0), Vec3d(0, -1, 0)},
  }));
  Scene scene(1);
  scene.colliders = {{"object", shape}};
  const Vec3d along = Vec3d(normal[1], normal[2], normal[0]);
  scene.state.x[0] = inside;
  scene.state.v[0] = along * 0.3 - normal * 0.4;
  scene.contact().collide(scene.state, 0.01, scene.profile);
  CHECK(is(scene.state.x[0], inside + normal * 0.02));
  CHECK(is(scene.state.v[0], along * 0.1 + normal * 0.1));
}

TEST_CASE("who leaves a surface is left alone, and so is who is pinned or far") {
  Scene scene(1);
  scene.colliders = {{"ground", PlaneDef{}}};
  scene.state.x[0] = Vec3d(0, 0.005, 0);
  scene.state.v[0] = Vec3d(1, 0.1, 0);
  scene.state.x[1] = Vec3d(1, -0.005, 0);
  scene.state.inverse_mass[1] = 0;
  scene.state.x[2] = Vec3d(2, 0.0101, 0);
  scene.state.v[2] = Vec3d(0, -0.1, 0);
  const ClothState<double> before = scene.state;
  scene.contact().collide(scene.state, 0.01, scene.profile);
  CHECK(scene.state.x == before.x);
  CHECK(scene.state.v == before.v);
}

TEST_CASE("projection flattens a fold that the fold map keeps") {
  // Three particles of a fold that sank by 0.01: at -0.01, -0.004 and 0.01. tau = 0.03, eps =
  // 0.002: the map gives 0.002, 0.002 + 0.006 * 0.7 = 0.0062 and 0.016; projection gives 0.002
  // thrice if they come down.
  Scene scene(1, 0.02);
  scene.def.lift = 0.002;
  scene.def.fold_depth = 0.03;
  scene.def.correction = GENERATE(Correction::projection, Correction::fold_map);
  scene.colliders = {{"ground", PlaneDef{}}};
  const std::array<double, 3> height = {-0.01, -0.004, 0.01};
  for (std::size_t k = 0; k < 3; ++k) {
    scene.state.x[k] = Vec3d(static_cast<double>(k), height[k], 0);
    scene.state.v[k] = Vec3d(0, -0.1, 0);
  }
  scene.contact().collide(scene.state, 0.01, scene.profile);
  const bool map = scene.def.correction == Correction::fold_map;
  CHECK(scene.state.x[0][1] == Approx(0.002));
  CHECK(scene.state.x[1][1] == Approx(map ? 0.0062 : 0.002));
  CHECK(scene.state.x[2][1] == Approx(map ? 0.016 : 0.002));
}

TEST_CASE("(11) between two cloths: the approach is shared, what is along the surface stays") {
  Scene scene(2);
  scene.def.self = SelfContact::particles;
  scene.state.x[0] = Vec3d(0, 0.005, 0);
  scene.state.x[4] = Vec3d(0, 0, 0);
  scene.state.v[0] = Vec3d(0.3, -2, 0);
  scene.contact().separate(scene.state, scene.profile);
  CHECK(is(scene.state.v[0], Vec3d(0.3, -1, 0)));
  CHECK(is(scene.state.v[4], Vec3d(0, -1, 0)));
  scene.state.v[0] = Vec3d(0, 1, 0);
  scene.contact().separate(scene.state, scene.profile);
  CHECK(is(scene.state.v[0], Vec3d(0, 1, 0)));  // apart already
}

TEST_CASE("(12) between two cloths: a particle meets the middle of a triangle, which gives way") {
  Scene scene(2);
  scene.def.self = GENERATE(SelfContact::triangles, SelfContact::particles);
  const Triangle& t = scene.model.triangles[0];
  Vec3d middle = Vec3d::Zero();
  for (const Index i : t) middle += scene.state.x[static_cast<std::size_t>(i)] / 3;
  const double side = GENERATE(1.0, -1.0);
  scene.state.x[4] = middle + Vec3d(0, 0.005 * side, 0);
  scene.state.v[4] = Vec3d(0.2, -1 * side, 0);
  scene.contact().separate(scene.state, scene.profile);
  const bool seen = scene.def.self == SelfContact::triangles;  // no particle is within h
  CHECK(is(scene.state.v[4], Vec3d(0.2, (seen ? -0.25 : -1) * side, 0)));
  for (const Index i : t)
    CHECK(is(scene.state.v[static_cast<std::size_t>(i)], Vec3d(0, seen ? -0.25 * side : 0, 0)));
}

TEST_CASE("edges that cross are seen by edge-edge pairs alone") {
  Scene scene(2);
  scene.def.self = GENERATE(SelfContact::triangles_and_edges, SelfContact::triangles);
  // Edge 0-1 along x; edge 4-5 across its middle, 5 mm above; all other particles far away.
  scene.state.x = {{-0.2, 0, 0},     {0.2, 0, 0},     {-0.2, -9, 0}, {0.2, -9, 0},
                   {0, 0.005, -0.2}, {0, 0.005, 0.2}, {0, 9, -0.2},  {0, 9, 0.2}};
  scene.state.v[4] = scene.state.v[5] = Vec3d(0, -2, 0);
  scene.contact().separate(scene.state, scene.profile);
  const bool seen = scene.def.self == SelfContact::triangles_and_edges;
  CHECK(is(scene.state.v[0], Vec3d(0, seen ? -1 : 0, 0)));
  CHECK(is(scene.state.v[1], scene.state.v[0]));
  CHECK(is(scene.state.v[4], Vec3d(0, seen ? -1 : -2, 0)));
  CHECK(is(scene.state.v[5], scene.state.v[4]));
}

TEST_CASE("an edge of the cloth on a sharp edge of a mesh is held by edge pairs alone") {
  // The blade's edge is at y = 0 along z; the cloth's edge hangs across it, 4 mm too low, coming
  // down with 1 m/s. k_diss = 0.25.
  Scene scene(1);
  scene.def.objects = GENERATE(ObjectContact::particles_and_edges, ObjectContact::particles);
  scene.colliders = {{"blade", MeshDef{blade(1, 0.5, 1)}}};
  scene.state.x[0] = Vec3d(-0.2, -0.004, 0.1);
  scene.state.x[1] = Vec3d(0.2, -0.004, 0.1);
  scene.state.v[0] = scene.state.v[1] = Vec3d(0, -1, 0);
  scene.contact().collide(scene.state, 0.001, scene.profile);
  const bool seen = scene.def.objects == ObjectContact::particles_and_edges;
  for (std::size_t k : {0u, 1u}) {
    CHECK(scene.state.x[k][1] == Approx(seen ? 0 : -0.004).margin(1e-12));
    CHECK(scene.state.v[k][1] == Approx(seen ? 0.25 : -1));
  }
}

TEST_CASE("self-collision keeps the total momentum") {
  ClothDef cloth = flat_cloth(9, 9);
  cloth.fabric.thickness = 0.06;
  const ClothModel<double> model = build_cloth<double>(cloth);
  SeedContactDef def;
  def.self =
      GENERATE(SelfContact::particles, SelfContact::triangles, SelfContact::triangles_and_edges);
  def.passes = 2;
  SeedContact<double> contact(def, model, {});
  SeededRandom random(4);
  ClothState<double> state = initial_state(model);
  state.x = shaken(model, 0.15, random);
  state.v = random_velocities(model, 1, random);
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < state.v.size(); ++i) sum += state.v[i] * model.mass[i];
    return sum;
  };
  const Vec3d before = momentum();
  const Vec3Array<double> v = state.v;
  Profile profile;
  contact.separate(state, profile);
  CHECK(state.v != v);
  CHECK((momentum() - before).norm() < 1e-14);
}

TEST_CASE("the seed's contact is chosen by name, works with either solver and takes no memory") {
  WorldDef def = empty_world(flat_cloth(15, 15));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -0.1, 0), Vec3d::UnitY()}},
                   {"box", MeshDef{box_mesh(Vec3d(0.05, 0.05, 0.05))}}};
  for (Vec3d& p : std::get<MeshDef>(def.colliders[1].shape).mesh.positions)
    p += Vec3d(0.5, -0.06, 0.5);
  set_field(def, "contact.model", "seed");
  set_field(def, "contact.self", "triangles_and_edges");
  set_field(def, "contact.objects", "particles_and_edges");
  set_field(def, "contact.correction", GENERATE("projection", "fold_map"));
  set_field(def, "solver.kind", GENERATE("verlet", "relaxation"));
  set_field(def, "relaxation.substeps", "4");
  World<float> world(def), again(def);
  for (int tick = 0; tick < 30; ++tick) {
    world.step();
    again.step();
  }
  CHECK(world.hash() == again.hash());
  const std::size_t before = count_allocations();
  for (int tick = 0; tick < 5; ++tick) REQUIRE_FALSE(world.step().divergence);
  CHECK(count_allocations() == before);
  for (const Vec3f& x : world.state().x) CHECK(x[1] > -0.1f - 1e-5f);
}

TEST_CASE("settings that do not go together are refused by name") {
  WorldDef def = empty_world(flat_cloth(3, 3));
  set_field(def, "contact.self", "particles");
  CHECK_THROWS_WITH(World<float>(def), Catch::Contains("contact.self = particles"));
  set_field(def, "model", "seed");
  CHECK_NOTHROW(World<float>(def));
  set_field(def, "contact.correction", "fold_map");
  set_field(def, "contact.lift", "0.05");
  CHECK_THROWS_WITH(World<float>(def), Catch::Contains("contact.lift = 0.05"));
}
