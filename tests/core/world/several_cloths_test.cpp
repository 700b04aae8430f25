#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

/// A grid that fits the row-wise forces, and one that needs hinges, a metre apart.
std::vector<ClothDef> row_wise_and_hinged() {
  ClothDef first = test::flat_cloth(7, 9, 0.6, 0.5);
  ClothDef second = test::flat_cloth(6, 5, 0.4, 0.5);
  second.name = "second";
  second.origin = Vec3d(1.5, 0.2, 0);
  second.bending_model = BendingModel::hinges;
  second.rest_angle = 0.2;
  second.fabric.air_normal = 2;
  second.fabric.areal_density = 0.3;
  return {first, second};
}

WorldDef windy_world(std::vector<ClothDef> cloths) {
  WorldDef def;
  def.cloths = std::move(cloths);
  def.environment.wind = Vec3d(0.5, 1, 2);
  def.environment.gust_speed = 1;
  def.solver.min_substeps = 40;  // more than either needs alone
  return def;
}

template <class F>
std::string refused_field(F&& change) {
  WorldDef def = windy_world(row_wise_and_hinged());
  change(def);
  try {
    World<float> world(def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "nothing";
}

}  // namespace

TEST_CASE("cloths that do not touch move bit for bit as each does alone") {
  const std::vector<ClothDef> cloths = row_wise_and_hinged();
  World<float> both(windy_world(cloths));
  World<float> alone[] = {World<float>(windy_world({cloths[0]})),
                          World<float>(windy_world({cloths[1]}))};
  for (int tick = 0; tick < 30; ++tick) {
    both.step();
    for (World<float>& world : alone) world.step();
  }
  REQUIRE(both.report().substeps == 40);
  REQUIRE(both.model().parts.size() == 2);
  std::size_t i = 0;
  for (const World<float>& world : alone) {
    for (std::size_t k = 0; k < world.state().x.size(); ++k, ++i) {
      CHECK(both.state().x[i] == world.state().x[k]);
      CHECK(both.state().v[i] == world.state().v[k]);
    }
  }
  CHECK(i == both.state().x.size());
  CHECK(both.report().energies.total() ==
        Approx(alone[0].report().energies.total() + alone[1].report().energies.total()));
}

TEST_CASE("no element of a model joins two cloths") {
  const ClothModel<double> model = build_cloths<double>(row_wise_and_hinged());
  for (const ClothPart<double>& part : model.parts) {
    const auto all_inside = [&part](const auto& list, const IndexRange& range, auto&& corners) {
      for (Index n = range.first; n < range.end(); ++n) {
        for (const Index i : corners(list[static_cast<std::size_t>(n)]))
          if (!part.particles.contains(i)) return false;
      }
      return true;
    };
    const auto itself = [](const auto& element) { return element; };
    CHECK(all_inside(model.triangles, part.triangles, itself));
    CHECK(all_inside(model.edges, part.edges, itself));
    CHECK(all_inside(model.springs, part.springs, [](const Spring<double>& s) {
      return std::array{s.i, s.j};
    }));
    CHECK(all_inside(model.hinges, part.hinges,
                     [](const Hinge<double>& h) { return std::to_array(h.x); }));
  }
  CHECK(model.parts[0].hinges.count == 0);
  CHECK(model.parts[1].hinges.count > 0);
  CHECK(model.parts[1].particles.end() == model.particle_count());
  CHECK(part_of_particle(model, 62).name == "cloth");
  CHECK(part_of_particle(model, 63).name == "second");
}

TEST_CASE("each cloth keeps its own thickness and friction") {
  WorldDef def;
  def.cloths = {test::flat_cloth(5, 5, 0.2, 0.2), test::flat_cloth(5, 5, 0.2, 0.2)};
  def.cloths[0].fabric.thickness = 0.004;
  def.cloths[0].fabric.friction = 0.8;
  def.cloths[1].fabric.thickness = 0.02;
  def.cloths[1].fabric.friction = 0.1;
  for (ClothDef& cloth : def.cloths) cloth.origin = Vec3d(0, cloth.fabric.thickness, 0);
  def.cloths[1].origin[0] = 1;
  def.cloths[1].name = "thick";
  def.environment.gravity = Vec3d(9.81 * 0.5, -9.81, 0);  // atan 0.5 is between both frictions
  def.colliders = {{"ground", PlaneDef{}}};
  World<double> world(def);
  test::advance(world, 0.5);
  const auto mean = [&](std::size_t part) {
    Vec3d sum = Vec3d::Zero();
    const IndexRange range = world.model().parts[part].particles;
    for (Index i = range.first; i < range.end(); ++i)
      sum += world.state().x[static_cast<std::size_t>(i)];
    return Vec3d(sum / range.count);
  };
  CHECK(mean(0)[1] == Approx(0.004).margin(1e-4));
  CHECK(mean(1)[1] == Approx(0.02).margin(1e-4));
  CHECK(mean(0)[0] == Approx(0.1).margin(1e-3));  // sticks
  // Slides by (g sin - mu g cos) t^2 / 2.
  CHECK(mean(1)[0] - 1.1 == Approx(0.5 * 9.81 * (0.5 - 0.1) * 0.25).epsilon(0.03));
}

TEST_CASE("a hand's and a pin's disc stay in their cloth") {
  World<double> world(windy_world(row_wise_and_hinged()));
  const IndexRange second = world.model().parts[1].particles;
  GrabDef hand;
  hand.triangle = world.model().parts[1].triangles.first;
  hand.barycentric = {1, 0, 0};
  hand.radius = 100;
  world.grab(hand);
  for (const Index i : world.grabs().list[0].particles) CHECK(second.contains(i));
  CHECK(static_cast<Index>(world.grabs().list[0].particles.size()) == second.count);
  CHECK(particles_in_disc(world.model(), 3, 100.0).size() == 63);
  CHECK(particles_in_disc(world.model(), second.first, 100.0).front() == second.first);
}

TEST_CASE("a key that is none is refused with the one that may be meant") {
  WorldDef def = windy_world(row_wise_and_hinged());
  const auto hint = [&def](const std::string& key) -> std::string {
    try {
      set_field(def, key, "1");
    } catch (const DefinitionError& error) {
      return error.hint;
    }
    return "taken";
  };
  CHECK(hint("wind") == "did you mean environment.wind?");
  CHECK(hint("fabric.frction") == "did you mean fabric.friction?");
  CHECK(hint("colliders[0].friction") == "colliders are set in the scene's own text alone");
  CHECK(hint("zzzzzzzz").empty());
}

TEST_CASE("a field of a later cloth is set and refused by its place in the list") {
  WorldDef def = windy_world(row_wise_and_hinged());
  set_field(def, "cloths[1].rows", "12");
  set_field(def, "cloths[1].fabric.friction", "0.9");
  set_field(def, "cloths[0].columns", "5");
  set_field(def, "cloths[0].fabric.friction", "0.7");
  CHECK(def.cloths[1].rows == 12);
  CHECK(def.cloths[1].fabric.friction == 0.9);
  CHECK(def.cloths[0].columns == 5);
  CHECK(def.cloths[0].fabric.friction == 0.7);
  CHECK_THROWS_AS(set_field(def, "cloths[2].rows", "12"), DefinitionError);
  for (const std::string key : {"cloths[0].fabric.friction", "cloths[1].rows", "fabric.shear"}) {
    try {
      set_field(def, key, "-7");
      FAIL("it is refused");
    } catch (const DefinitionError& error) {
      CHECK(error.field == key);  // as it was given
    }
  }
  CHECK(refused_field([](WorldDef& d) { d.cloths[1].rows = 1; }) == "cloths[1].rows");
  CHECK(refused_field([](WorldDef& d) { d.cloths[1].fabric.shear = 1e5; }) ==
        "cloths[1].fabric.shear");
  CHECK(refused_field([](WorldDef& d) { d.cloths[0].fabric.shear = 1e5; }) == "fabric.shear");
  CHECK(refused_field([](WorldDef& d) { d.cloths[1].name = "cloth"; }) == "cloths[1].name");
  CHECK(refused_field([](WorldDef& d) { d.cloths.clear(); }) == "cloths");
  CHECK(refused_field([](WorldDef& d) { d.cloths.resize(65); }) == "cloths");
}
