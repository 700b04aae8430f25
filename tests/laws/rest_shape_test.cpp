#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// A mesh whose (u, v) in metres are its fabric laid flat, wherever its vertices lie.

using namespace weft;

namespace {

/// An irregular sheet whose rest shape is its (u, v), and places of its vertices.
template <class Place>
ClothDef sheet_at(Place&& place) {
  ClothDef sheet = test::triangle_sheet(test::Cut::irregular, 0.3, 0.2, 0.025, 0.5);
  sheet.rest_shape = RestShape::uv;
  sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-3;
  for (Vec3d& p : sheet.mesh->mesh.positions) p = place(p);
  return sheet;
}

std::string refused(const ClothDef& sheet) {
  try {
    build_cloth<float>(sheet);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return {};
}

}  // namespace

TEST_CASE(
    "a mesh that starts stretched has the strain, mass and area of its uv, in any direction") {
  constexpr double kStretch = 1.1;
  ClothDef sheet = sheet_at([&](const Vec3d& p) { return Vec3d(kStretch * p); });
  sheet.fabric.poisson = 0.3;
  const World<double> world(test::empty_world(sheet));
  const FabricDef& f = sheet.fabric;
  // Both threads have the same strain.
  const double strain = kStretch - 1, coupling = 0.3 * f.stretch_weft;
  const double density = strain * strain * (f.stretch_warp + f.stretch_weft + 2 * coupling) / 2;
  CHECK(world.report().energies.stretch == Approx(density * 0.06).epsilon(1e-9));
  double mass = 0;
  for (const double m : world.model().mass) mass += m;
  CHECK(mass == Approx(0.06 * f.areal_density));
  CHECK(world.report().largest_strain == Approx(strain).epsilon(1e-6));
}

TEST_CASE("one that starts bent onto a cylinder is flat at rest: it has the energy of that bend") {
  constexpr double kRadius = 0.4;
  const auto bent = [](const Vec3d& p) {
    return Vec3d(kRadius * std::sin(p[0] / kRadius), p[1], kRadius * std::cos(p[0] / kRadius));
  };
  const ClothDef sheet = sheet_at(bent);
  const World<double> world(test::empty_world(sheet));
  // Free borders aside, B/2 over the area and the squared radius.
  const double expected = 1e-3 / 2 / (kRadius * kRadius) * 0.06;
  CHECK(world.report().energies.bending == Approx(expected).epsilon(0.03));
  CHECK(world.model().hinges.empty());
  ClothDef placed = sheet;
  placed.rest_shape = RestShape::placed;
  CHECK(World<double>(test::empty_world(placed)).report().energies.bending < 1e-3 * expected);
}

TEST_CASE(
    "where it lies flat and unstrained it is the cloth that it would be without, and so moves") {
  const auto turned = [](const Vec3d& p) { return Vec3d(p[2], p[0], p[1]); };
  ClothDef sheet = sheet_at(turned);
  const auto lowest = [](const ClothDef& cloth) {
    WorldDef def = test::empty_world(cloth);
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.environment.damping = 1;
    def.pins = {{0, 0.03, {}}};
    World<double> world(def);
    test::advance(world, 0.5);
    return test::centre_of_mass(world);
  };
  const Vec3d by_uv = lowest(sheet);
  sheet.rest_shape = RestShape::placed;
  CHECK((lowest(sheet) - by_uv).norm() < 1e-6);
}

TEMPLATE_TEST_CASE(
    "a mesh let go at up to twice its length gains no energy without damping, to 6 %", "", float,
    double) {
  for (const double stretch : {1.2, 1.5, 1.9, 1.95, 2.0}) {
    INFO("at " << stretch << " times its length");
    ClothDef sheet = sheet_at([&](const Vec3d& p) { return Vec3d(stretch * p); });
    sheet.fabric.damping_ratio = 0;
    World<TestType> world(test::empty_world(sheet));
    const double start = world.report().energies.total();
    double most = 0;
    for (int tick = 0; tick < 60; ++tick) {
      REQUIRE_FALSE(world.step().divergence);
      most = std::max(most, world.report().energies.total());
    }
    CHECK(most < 1.06 * start);
    CHECK(most > 0.9 * start);
  }
}

TEST_CASE("uv that cannot be a rest shape are refused by name") {
  const auto as_it_is = [](const Vec3d& p) { return p; };
  CHECK(refused(sheet_at(as_it_is)).empty());
  ClothDef sheet = sheet_at(as_it_is);
  sheet.mesh->uv.clear();
  CHECK(refused(sheet) == "cloth.rest_shape");
  sheet = sheet_at(as_it_is);
  sheet.mesh->uv.pop_back();
  CHECK(refused(sheet) == "cloth.mesh.uv");
  sheet = sheet_at(as_it_is);  // a vertex pulled over its neighbours turns a triangle over
  const Triangle& t = sheet.mesh->mesh.triangles[20];
  auto& uv = sheet.mesh->uv;
  uv[static_cast<std::size_t>(t[0])] = {uv[static_cast<std::size_t>(t[1])][0] + 0.1,
                                        uv[static_cast<std::size_t>(t[1])][1] + 0.1};
  CHECK(refused(sheet) == "cloth.rest_shape");
  ClothDef grid = test::flat_cloth(5, 5);
  grid.rest_shape = RestShape::uv;
  CHECK(refused(grid) == "cloth.rest_shape");
}
