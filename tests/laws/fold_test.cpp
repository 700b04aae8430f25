#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/forces/cell_misfit.h"
#include "core/forces/force_pass.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

// What a fold costs beside its bending: nothing, whatever its direction. A sheet rolled onto a
// cylinder of radius R should only bend; but springs and triangles measure chords, which are
// shorter than arcs by a part of (length / R)^2 / 24. Where the sheet may stretch until they fit,
// nothing is left. The springs of a grid's four directions have one measure more than a plane has
// strains, so that aslant they cannot all fit; cell_misfit.h takes off what that costs.

using namespace weft;
using test::Cut;

namespace {

constexpr int kCells = 40;

/// Rolled about an axis at an angle to x, stretched by a across it and by b along it, turned by c.
Vec3Array<double> rolled(const Vec3Array<double>& flat, double angle, double radius,
                         const std::array<double, 3>& strain) {
  const double c = std::cos(angle), s = std::sin(angle);
  Vec3Array<double> x;
  for (const Vec3d& p : flat) {
    const double across = p[0] * c + p[1] * s, along = p[1] * c - p[0] * s;
    const double arc = across * (1 + strain[0]) + strain[2] * along;
    const double height = along * (1 + strain[1]) + strain[2] * across;
    x.emplace_back(radius * std::sin(arc / radius), height, radius * std::cos(arc / radius));
  }
  return x;
}

/// Least energy of the membrane over the bending's on a cylinder, over all uniform strains.
double least_share(const ClothModel<double>& model, double angle, double radius) {
  std::array<double, 3> strain = {};
  const auto energy = [&] {
    return elastic_energy(model, rolled(model.rest_positions, angle, radius, strain));
  };
  double least = energy().stretch;
  for (double step = 0.02; step > 1e-6;) {
    bool moved = false;
    for (double& e : strain) {
      for (const double way : {step, -step}) {
        e += way;
        const double now = energy().stretch;
        if (now < least) {
          least = now;
          moved = true;
          break;
        }
        e -= way;
      }
    }
    if (!moved) step /= 2;
  }
  return least / energy().bending;
}

ClothModel<double> flat_grid(const FabricDef& fabric, double cell) {
  ClothDef def;
  def.rows = def.columns = kCells + 1;
  def.width = def.height = kCells * cell;
  def.u = Vec3d::UnitX();
  def.v = Vec3d::UnitY();
  def.fabric = fabric;
  return build_cloth<double>(def);
}

/// Energy of the membrane at the bottom of a random descent.
double least_energy(const ClothModel<double>& model, Vec3Array<double> x,
                    test::SeededRandom& random) {
  double least = elastic_energy(model, x).stretch;
  for (double step = 0.3; step > 1e-4;) {
    bool moved = false;
    for (int trial = 0; trial < 60; ++trial) {
      Vec3Array<double> y = x;
      for (Vec3d& p : y) p += random.vector(step);
      const double now = elastic_energy(model, y).stretch;
      if (!(now < least)) continue;
      least = now;
      x = std::move(y);
      moved = true;
    }
    if (!moved) step *= 0.7;
  }
  return least;
}

constexpr double kAslant = 3.14159265358979323846 / 4;

}  // namespace

TEST_CASE("folds of a grid cost their bending alone in all directions, at cells of a third of R") {
  for (const char* preset : {"silk", "cotton", "wool", "leather", "nylon"}) {
    const FabricDef f = make_fabric(preset);
    const double radius = std::cbrt(f.bending_warp / (f.areal_density * 9.81));
    const ClothModel<double> model = flat_grid(f, radius / 3);
    ClothModel<double> springs = model;
    springs.parts[0].grid_springs->misfit = 0;
    for (const double angle : {0.0, 0.2, 0.4, 0.6, kAslant, 1.2}) {
      INFO(preset << " at " << angle);
      const double alone = least_share(springs, angle, radius);
      CHECK(std::abs(least_share(model, angle, radius)) < 1e-3 + 0.01 * alone);
    }
  }
}

TEST_CASE("without that the springs of a grid cost h^4/(256 B R^2 (1/G + 1/S_w + 1/S_f)) aslant") {
  for (const char* preset : {"silk", "cotton", "wool", "leather"}) {
    const FabricDef f = make_fabric(preset);
    const double bending = f.bending_warp;
    const double radius = std::cbrt(bending / (f.areal_density * 9.81));
    for (const double cell : {radius / 3, radius / 6}) {
      INFO(preset << ", cells of " << 1e3 * cell << " mm");
      ClothModel<double> model = flat_grid(f, cell);
      model.parts[0].grid_springs->misfit = 0;
      CHECK(least_share(model, 0, radius) < 1e-6);
      // Structural springs have stretch less shear; a diagonal has twice the shear.
      const double give =
          1 / f.shear + 1 / (f.stretch_warp - f.shear) + 1 / (f.stretch_weft - f.shear);
      const double closed = std::pow(cell, 4) / (256 * bending * radius * radius * give);
      CHECK(least_share(model, kAslant, radius) == Approx(closed).epsilon(0.05));
    }
  }
}

TEST_CASE("homogeneous strains of a grid have no misfit, and no state has less than no energy") {
  const FabricDef silk = make_fabric("silk");
  const ClothModel<double> model = flat_grid(silk, 0.01);
  test::SeededRandom random(5);
  for (int run = 0; run < 200; ++run) {
    Vec3Array<double> sheared;
    const Vec3d a = random.vector(0.3), b = random.vector(0.3);
    for (const Vec3d& p : model.rest_positions) sheared.push_back(p + a * p[0] + b * p[1]);
    CHECK(misfit_energy(model.parts[0], sheared) == Approx(0).margin(1e-20));
    const double amount = std::pow(10, random.uniform(-5, 1));
    const Vec3Array<double> x = test::shaken(model, amount, random);
    CHECK(elastic_energy(model, x).stretch >= 0);
  }
}

TEST_CASE("a cell that gives way as far as it can has no less energy than none, at any twist") {
  for (const char* preset : {"silk", "cotton", "wool", "denim", "leather", "nylon"}) {
    for (const double width : {0.5, 1.0, 1.5}) {
      ClothDef def;
      def.rows = def.columns = 2;
      def.width = width;
      def.height = 1;
      def.fabric = make_fabric(preset);
      const ClothModel<double> model = build_cloth<double>(def);
      test::SeededRandom random(7);
      INFO(preset << ", a cell " << width << " as wide as high");
      for (int run = 0; run < 4; ++run)
        CHECK(least_energy(model, test::shaken(model, 0.3 * (1 + run), random), random) >= 0);
    }
  }
}

TEST_CASE("folds of a mesh cost their bending alone wherever all its cells are cut alike") {
  const FabricDef silk = make_fabric("silk");
  const double radius = std::cbrt(silk.bending_warp / (silk.areal_density * 9.81));
  for (const double angle : {0.0, 0.3, kAslant, 1.2}) {
    INFO(angle);
    ClothDef def = test::triangle_sheet(Cut::one_diagonal, 0.1, 0.1, radius / 3, 0);
    def.fabric = silk;
    CHECK(least_share(build_cloth<double>(def), angle, radius) < 1e-3);
  }
}
