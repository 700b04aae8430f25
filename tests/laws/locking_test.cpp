#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// Fabric that locks: beyond a strain its threads are stiffer, in the energy.

using namespace weft;

namespace {

constexpr double kWidth = 0.3, kLength = 0.4;  // [m]

FabricDef locking() {
  FabricDef f;
  f.stretch_warp = 300;
  f.stretch_weft = 200;
  f.shear = 0;
  f.bending_warp = f.bending_weft = 0;
  f.locking_strain = 0.04;
  f.locking_factor = 12;
  return f;
}

/// Energy per area of a thread of stiffness Y that is stretched so far [J/m^2].
double energy_of_thread(const FabricDef& f, double stiffness, double strain) {
  const double beyond = std::max(strain - f.locking_strain, 0.0);
  return stiffness * (strain * strain + (f.locking_factor - 1) * beyond * beyond) / 2;
}

/// A grid whose warp runs along x and its weft along z, and meshes with warp along x and weft
/// against y.
std::vector<ClothDef> sheets() {
  std::vector<ClothDef> all = {test::flat_cloth(9, 7, kWidth, kLength)};
  for (const test::Cut cut : test::kCuts)
    all.push_back(test::triangle_sheet(cut, kWidth, kLength, 0.05));
  for (ClothDef& sheet : all) sheet.fabric = locking();
  return all;
}

std::string name_of(const ClothDef& sheet) {
  return sheet.mesh ? "mesh of " + std::to_string(sheet.mesh->mesh.triangles.size()) : "grid";
}

}  // namespace

TEST_CASE("a stretched thread has the energy of both phases, on grids and any mesh, to 1e-9") {
  for (const ClothDef& sheet : sheets()) {
    const ClothModel<double> model = build_cloth<double>(sheet);
    const int down = sheet.mesh ? 1 : 2;
    for (const double warp : {-0.1, 0.02, 0.1}) {
      for (const double weft : {-0.05, 0.03, 0.2}) {
        INFO(name_of(sheet) << ", strains " << warp << " and " << weft);
        Vec3Array<double> x = model.rest_positions;
        for (Vec3d& p : x) p[0] *= 1 + warp, p[down] *= 1 + weft;
        const double expected =
            energy_of_thread(sheet.fabric, 300, warp) + energy_of_thread(sheet.fabric, 200, weft);
        CHECK(elastic_energy(model, x).stretch / (kWidth * kLength) ==
              Approx(expected).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("the forces of locked threads are the slope of their energy, and sum to zero") {
  for (const ClothDef& sheet : sheets()) {
    INFO(name_of(sheet));
    const ClothModel<double> model = build_cloth<double>(sheet);
    Vec3Array<double> x = model.rest_positions, force(x.size(), Vec3d::Zero());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto k = static_cast<double>(i);
      x[i] = x[i] * 1.15 + 0.004 * Vec3d(std::sin(7 * k), std::cos(5 * k), std::sin(3 * k));
    }
    add_locking_forces(model, model.parts[0], x, force);
    const Vec3Array<double> rest(x.size(), Vec3d::Zero());
    add_spring_forces(model, x, rest, force);
    add_membrane_forces(model, x, rest, force);
    Vec3d sum = Vec3d::Zero();
    for (const Vec3d& f : force) sum += f;
    CHECK(sum.norm() < 1e-10);
    for (const std::size_t i : {std::size_t{0}, x.size() / 2, x.size() - 1}) {
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 1e-6;
        const auto energy = [&](double moved) {
          Vec3Array<double> y = x;
          y[i][axis] += moved;
          return elastic_energy(model, y).stretch;
        };
        const double slope = (energy(kStep) - energy(-kStep)) / (2 * kStep);
        CHECK(force[i][axis] == Approx(-slope).margin(1e-5));
      }
    }
  }
}

TEST_CASE("a strip that hangs by its own weight is as long as both phases say, to 0.5 %") {
  for (const bool mesh : {false, true}) {
    INFO((mesh ? "mesh" : "grid"));
    ClothDef sheet = mesh ? test::triangle_sheet(test::Cut::irregular, 0.06, kLength, 0.01)
                          : test::flat_cloth(41, 7, 0.06, kLength);
    sheet.fabric = locking();
    sheet.fabric.areal_density = 5;
    WorldDef def = test::empty_world(sheet);
    def.environment.gravity = Vec3d(0, mesh ? -9.81 : 0, mesh ? 0 : 9.81);
    if (mesh)
      def.pins = test::upper_border(sheet);
    else
      def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
    World<double> world(def);
    CHECK(test::settle(world, 15, 3) < 1e-4);
    // At s from the upper border the tension is sigma g (L - s).
    constexpr int kParts = 10000;
    double length = 0;
    for (int k = 0; k < kParts; ++k) {
      const double s = (k + 0.5) / kParts * kLength, tension = 5 * 9.81 * (kLength - s);
      const double slack = std::min(tension / 200, 0.04);
      length += (1 + slack + (tension - 200 * slack) / (200 * 12)) * kLength / kParts;
    }
    double lowest = 0;
    for (const Vec3d& x : world.state().x) lowest = std::max(lowest, mesh ? -x[1] : x[2]);
    const double free = world.model().rest_positions.front()[mesh ? 1 : 2];
    CHECK(lowest - (mesh ? 0 : free) == Approx(length).epsilon(0.005));
    CHECK(length > 1.03 * kLength);  // so most of it is locked, or nearly
  }
}

TEST_CASE("cloth that is thrown into its locks and back keeps its energy to 2 %") {
  for (const bool mesh : {false, true}) {
    INFO((mesh ? "mesh" : "grid"));
    ClothDef sheet = mesh ? test::triangle_sheet(test::Cut::alternating, kWidth, kLength, 0.05)
                          : test::flat_cloth(9, 7, kWidth, kLength);
    sheet.fabric = locking();
    sheet.fabric.shear = 20;
    sheet.fabric.damping_ratio = 0;
    World<double> world(test::empty_world(sheet));
    for (std::size_t i = 0; i < world.state().v.size(); ++i)
      world.state().v[i] = 15 * (world.model().rest_positions[i] - test::centre_of_mass(world));
    world.accept_state();
    const double before = world.report().energies.total();
    double most = 0;
    for (int tick = 0; tick < 60; ++tick) {
      REQUIRE_FALSE(world.step().divergence);
      most = std::max(most, world.report().largest_strain);
      REQUIRE(world.report().energies.total() == Approx(before).epsilon(0.02));
    }
    CHECK(most > 1.5 * sheet.fabric.locking_strain);
  }
}

TEST_CASE(
    "let fall by two corners, locking cloth without damping keeps its energy to 2 % for 5 s") {
  for (const double factor : {3.0, 40.0}) {
    INFO("factor " << factor);
    ClothDef sheet = test::flat_cloth(15, 19, 0.5, 0.37);
    FabricDef& fabric = sheet.fabric;
    fabric.areal_density = 0.2;
    fabric.stretch_warp = 300, fabric.stretch_weft = 200, fabric.shear = 25;
    fabric.bending_warp = 3e-5, fabric.bending_weft = 1e-5;
    fabric.locking_strain = 0.02, fabric.locking_factor = factor;
    fabric.damping_ratio = 0;
    WorldDef def = test::empty_world(sheet);
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.pins = {{0, 0, {}}, {18, 0, {}}};
    World<float> world(def);
    const double before = world.report().energies.total(), scale = 0.363;  // its fall's [J]
    double most = 0;
    for (int tick = 0; tick < 300; ++tick) {
      REQUIRE_FALSE(world.step().divergence);
      most = std::max(most, std::abs(world.report().energies.total() - before));
    }
    CHECK(most < 0.02 * scale);
  }
}

TEST_CASE("what cannot lock is refused by name: other solvers and springs without threads") {
  const auto refused = [](const WorldDef& def) {
    try {
      const World<float> world(def);
    } catch (const DefinitionError& error) {
      return error.field;
    }
    return std::string();
  };
  ClothDef sheet = test::flat_cloth(5, 5);
  sheet.fabric = locking();
  WorldDef def = test::empty_world(sheet);
  CHECK(refused(def).empty());
  for (const SolverKind kind : {SolverKind::implicit, SolverKind::relaxation}) {
    def.solver.kind = kind;
    CHECK(refused(def) == "fabric.locking_strain");
  }
  def.solver.kind = SolverKind::verlet;
  def.cloths[0] = test::triangle_sheet(test::Cut::irregular, kWidth, kLength, 0.05);
  def.cloths[0].fabric = locking();
  CHECK(refused(def).empty());
  def.cloths[0].membrane_model = MembraneModel::springs;
  CHECK(refused(def) == "fabric.locking_strain");
}
