#include "core/world/mesh_damping.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// What is told of a fabric's damping on the mesh of its cloth.

using namespace weft;

namespace {

WorldDef cotton(double stretch, double shear, double bending) {
  WorldDef def = test::empty_world(test::flat_cloth(21, 21));
  FabricDef& f = def.cloths[0].fabric;
  f.stretch_damping = stretch;
  f.shear_damping = shear;
  f.bending_damping = bending;
  return def;
}

}  // namespace

TEST_CASE("a fabric that damps less than its mesh needs is told, with what a wave loses by that") {
  CHECK(damping_of_meshes(World<double>(cotton(0, 0, 0))).empty());
  const WorldDef def = cotton(1e-6, 0, 0);
  const World<double> world(def);
  const auto found = damping_of_meshes(world);
  REQUIRE(found.size() == 1);
  CHECK(found[0].asked == 1e-6);
  const double omega2 = world.model().parts[0].bounds.membrane_omega2;
  CHECK(found[0].given == Approx(2 * 0.05 / std::sqrt(omega2)));
  // A metre of 220 N/m and 0.2 kg/m^2: its first wave goes with pi^2 1100 / s^2.
  CHECK(found[0].loss == Approx(1 - std::exp(-found[0].given * 10856.6)).epsilon(1e-4));
  CHECK(describe(found[0]).find("needs") != std::string::npos);
  CHECK(describe(found[0]).find("substeps") == std::string::npos);
}

TEST_CASE("the substeps that damping takes are told, and are those of the world") {
  const auto [stretch, shear, bending] =
      GENERATE(table<double, double, double>({{2e-3, 0, 0}, {0, 2e-3, 0.5}}));
  const WorldDef def = cotton(stretch, shear, bending);
  const World<double> world(def);
  const auto found = damping_of_meshes(world);
  REQUIRE(found.size() == 1);
  CHECK(found[0].given == 0);
  CHECK(found[0].substeps == world.cost_in(def.environment).substeps);
  CHECK(found[0].undamped == World<double>(cotton(0, 0, 0)).cost_in(def.environment).substeps);
  CHECK(found[0].substeps > found[0].undamped);
}

TEST_CASE(
    "damped bending takes no substeps, on however fine a mesh, and so nothing is told of it") {
  const WorldDef def = cotton(0, 0, 1);
  const World<double> world(def);
  CHECK(damping_of_meshes(world).empty());
  CHECK(world.cost_in(def.environment).substeps ==
        World<double>(cotton(0, 0, 0)).cost_in(def.environment).substeps);
}

TEST_CASE("relaxation, whose membrane has no dashpots, tells nothing of them") {
  WorldDef def = cotton(1e-6, 0, 0);
  def.solver.kind = SolverKind::relaxation;
  CHECK(damping_of_meshes(World<double>(def)).empty());
}

TEST_CASE("a grid whose diagonals damp stretch by more than was asked tells by how much") {
  // Of cells twice as long the diagonals have 4 G of the warp: 80 of 220 N/m, and 5 of the weft.
  const auto [stretch, shear, given] = GENERATE(
      table<double, double, double>({{2e-3, 2e-3, 0}, {2e-3, 5e-3, 0}, {2e-3, 11e-3, 4e-3}}));
  WorldDef def = cotton(stretch, shear, 0);
  def.cloths[0].columns = 11;
  def.cloths[0].fabric.damping_ratio = 0;
  const auto found = damping_of_meshes(World<double>(def));
  REQUIRE(found.size() == 1);
  CHECK(found[0].of_shear == Approx(given));
  const bool told = describe(found[0]).find("diagonals") != std::string::npos;
  CHECK(told == (given > 0));
}
