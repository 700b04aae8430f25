#include "core/world/effective_moduli.h"

#include <cmath>
#include <iostream>

#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

struct Case {
  int substeps = 8, sweeps = 1;
  double compliance = 1;
};

constexpr double kCell = 0.02;  // [m]

FabricDef fabric() {
  FabricDef f;
  f.areal_density = 0.2;
  f.stretch_warp = 500;
  f.stretch_weft = 400;
  f.shear = 80;
  f.bending_warp = f.bending_weft = 1e-7;
  return f;
}

/// Along v, over the compliance.
double modulus(const Case& c) {
  const FabricDef f = fabric();
  return (f.stretch_weft - f.shear * f.shear / f.stretch_warp) / c.compliance;
}

WorldDef world_of(const Case& c, ClothDef cloth, const Vec3d& gravity) {
  cloth.fabric = fabric();
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = gravity;
  def.environment.damping = 20;
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.substeps = c.substeps;
  def.relaxation.sweeps = c.sweeps;
  def.relaxation.compliance = c.compliance;
  return def;
}

/// A sheet of so many cells in the plane z = 0, u along x and v down.
WorldDef sheet(const Case& c, int cells_u, int cells_v, const Vec3d& gravity) {
  ClothDef cloth = test::flat_cloth(cells_v + 1, cells_u + 1, cells_u * kCell, cells_v * kCell);
  cloth.v = -Vec3d::UnitY();
  return world_of(c, cloth, gravity);
}

EffectiveModuli told_of(const WorldDef& def) {
  const std::vector<EffectiveModuli> told = effective_moduli(World<float>(def));
  REQUIRE(told.size() == 1);
  return told[0];
}

/// A strip that hangs by its upper border at rest: its modulus along v over that asked for, from
/// the extension of the middle third of its length, and what it narrows there per strain.
struct Hung {
  double share = 0, narrowing = 0;
};

Hung hung(const Case& c, WorldDef def, double width, double length) {
  // It stretches by a hundredth at its upper end, if it is as stiff as asked for.
  const double gravity = 0.01 * modulus(c) / (0.2 * length);
  def.environment.gravity = Vec3d(0, -gravity, 0);
  def.pins = {{EdgeStrip{Side::top, 0.0}, 0.0, {}}};
  World<float> world(def);
  test::advance(world, 3);
  // Least squares of a uniform strain over the middle: of y by v, and of x by u.
  double n = 0, v = 0, y = 0, vv = 0, vy = 0, uu = 0, ux = 0;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const auto& place = world.model().material[i];
    const double down = static_cast<double>(place[1]),
                 across = static_cast<double>(place[0]) - width / 2;
    if (down < length / 3 || down > 2 * length / 3) continue;
    const Vec3d at = world.state().x[i].cast<double>();
    ++n, v += down, y -= at[1], vv += down * down, vy -= down * at[1];
    uu += across * across, ux += across * (at[0] - width / 2);
  }
  const double strain = (n * vy - v * y) / (n * vv - v * v) - 1;
  return {0.2 * gravity * length / 2 / strain / modulus(c), (1 - ux / uu) / strain};
}

}  // namespace

TEST_CASE("XPBD's modulus told at load is that of a sheet that hangs, to 3 %") {
  const Case c = GENERATE(Case{16, 1}, Case{32, 1}, Case{16, 4}, Case{16, 2, 3});
  const WorldDef def = sheet(c, 24, 48, Vec3d::Zero());
  const EffectiveModuli told = told_of(def);
  const Hung measured = hung(c, def, 24 * kCell, 48 * kCell);
  std::cout << c.substeps << " x " << c.sweeps << ", compliance " << c.compliance << ": told "
            << told.warp << " warp, " << told.weft << " weft, " << told.shear << " shear, Poisson "
            << told.poisson << ", needs " << told.needed << "; hung " << measured.share
            << ", narrowing " << measured.narrowing << std::endl;
  CHECK(told.weft == Approx(measured.share).epsilon(0.03));
  CHECK(told.weft < 0.97);
}

TEST_CASE("XPBD's modulus told of a mesh is that of one that hangs, to 6 % where it is half") {
  const Case c = GENERATE(Case{16, 1}, Case{16, 4});
  const test::Cut cut = GENERATE(test::Cut::one_diagonal, test::Cut::irregular);
  const WorldDef def =
      world_of(c, test::triangle_sheet(cut, 24 * kCell, 48 * kCell, kCell), Vec3d::Zero());
  const EffectiveModuli told = told_of(def);
  const Hung measured = hung(c, def, 24 * kCell, 48 * kCell);
  std::cout << test::name_of(cut) << ", " << c.substeps << " x " << c.sweeps << ": told "
            << told.weft << " weft, hung " << measured.share << std::endl;
  CHECK(told.weft == Approx(measured.share).epsilon(measured.share > 0.4 ? 0.06 : 1.0 / 6));
}

TEST_CASE("XPBD's shear told at load is that in the middle of a sheet that sags, to 4 %") {
  const Case c = GENERATE(Case{16, 1}, Case{32, 1}, Case{16, 4});
  const int n = 24, rows = 73;
  const double gravity = 0.04 * fabric().shear / (0.2 * n * kCell);
  WorldDef def = sheet(c, n, rows - 1, Vec3d(0, -gravity, 0));
  def.pins = {{EdgeStrip{Side::left, 0.0}, 0.0, {}}, {EdgeStrip{Side::right, 0.0}, 0.0, {}}};
  World<float> world(def);
  test::advance(world, 3);
  const auto at = [&](int column) {
    return static_cast<double>(
        world.state().x[static_cast<std::size_t>(rows / 2 * (n + 1) + column)].y());
  };
  // Of the parabola, a quarter lies between a quarter and a half of the way.
  const double sag = gravity * 0.2 * n * kCell * n * kCell / (8 * fabric().shear);
  const double measured = 0.25 * sag / (at(n / 4) - at(n / 2));
  std::cout << c.substeps << " x " << c.sweeps << ": told " << told_of(def).shear
            << " shear, sags with " << measured << std::endl;
  CHECK(told_of(def).shear == Approx(measured).epsilon(0.04));
}

TEST_CASE("XPBD's told moduli tend to the fabric's as its substeps grow") {
  double before = 0;
  for (const int substeps : {8, 16, 32, 64, 128, 256}) {
    const EffectiveModuli told = told_of(sheet({substeps}, 12, 12, Vec3d::Zero()));
    CHECK(told.least() > before);
    before = told.least();
  }
  CHECK(before > 0.97);
}

TEST_CASE("the substeps told leave each modulus of XPBD a twentieth too soft at most") {
  const Case c = GENERATE(Case{8, 1}, Case{32, 1}, Case{32, 2}, Case{16, 1, 0.5});
  const EffectiveModuli told = told_of(sheet(c, 12, 12, Vec3d::Zero()));
  REQUIRE(told.needed > c.substeps);
  CHECK(describe({told}).size() == 1);
  Case enough = c;
  enough.substeps = told.needed;
  const EffectiveModuli then = told_of(sheet(enough, 12, 12, Vec3d::Zero()));
  CHECK(then.least() >= kLeastModulusShare);
  CHECK(then.least() < kLeastModulusShare + 0.02);
  CHECK(describe({then}).empty());
}

TEST_CASE("XPBD of a cloth whose moduli are not known says so, and other solvers say nothing") {
  WorldDef def = sheet({}, 12, 12, Vec3d::Zero());
  CHECK(effective_moduli(World<float>(def)).size() == 1);
  WorldDef curved =
      world_of({}, test::triangle_sheet(test::Cut::irregular, 0.4, 0.4, 0.04), Vec3d::Zero());
  for (Vec3d& p : curved.cloths[0].mesh->mesh.positions) p[2] = 3 * p[0] * p[0];
  CHECK_FALSE(told_of(curved).known);
  CHECK(describe({told_of(curved)}).size() == 1);
  def.relaxation.compliance = 0;
  CHECK(effective_moduli(World<float>(def)).empty());
  def.relaxation.compliance = 1;
  def.solver.kind = SolverKind::verlet;
  CHECK(effective_moduli(World<float>(def)).empty());
}
