#include <cmath>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "tests/laws/bending_matrix.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// The bending of flat meshes: one fabric, whatever the triangles.

using namespace weft;
using test::Cut;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWarpRigidity = 3e-5, kWeftRigidity = 1e-5;  // rigidities [N m]

/// A sheet of unequal rigidities that does not resist stretch.
ClothDef sheet(Cut cut, double width, double height, double h, double grain) {
  ClothDef def = test::triangle_sheet(cut, width, height, h, grain);
  def.fabric.bending_warp = kWarpRigidity;
  def.fabric.bending_weft = kWeftRigidity;
  def.bending_model = BendingModel::quadratic;
  return def;
}

/// Energy of a whole sheet rolled onto a cylinder, over the continuum's.
/// @param angle  of the curved direction from the sheet's own x [rad]
double rolled_energy(Cut cut, double h_over_radius, double grain, double angle) {
  constexpr double kWidth = 1, kHeight = 0.8, kRadius = 0.5;
  const ClothModel<double> model =
      build_cloth<double>(sheet(cut, kWidth, kHeight, h_over_radius * kRadius, grain));
  const double c = std::cos(angle), s = std::sin(angle);
  Vec3Array<double> x = model.rest_positions;
  for (Vec3d& p : x) {
    const double along = (c * p[0] + s * p[1]) / kRadius, across = -s * p[0] + c * p[1];
    p = Vec3d(kRadius * std::sin(along), across, kRadius * (1 - std::cos(along)));
  }
  // The weft runs down, and the warp is turned by the grain towards it.
  const double u = std::cos(angle - grain), v = std::sin(angle - grain);
  const double rigidity = kWarpRigidity * std::pow(u, 4) + kWeftRigidity * std::pow(v, 4) +
                          (kWarpRigidity + kWeftRigidity) * u * u * v * v;
  return elastic_energy(model, x).bending /
         (0.5 * rigidity / (kRadius * kRadius) * kWidth * kHeight);
}

double worst_rolled_error(Cut cut, double h_over_radius) {
  double worst = 0;
  for (const double grain : {0.0, 0.5}) {
    for (int k = 0; k < 8; ++k)
      worst = std::max(worst, std::abs(rolled_energy(cut, h_over_radius, grain, k * kPi / 8) - 1));
  }
  return worst;
}

/// The squared frequencies of a free unit square of unit density and rigidity, ascending.
Eigen::VectorXd squared_frequencies(Cut cut, int cells) {
  ClothDef def = test::triangle_sheet(cut, 1, 1, 1.0 / cells);
  def.fabric.bending_warp = def.fabric.bending_weft = 1;
  def.fabric.areal_density = 1;
  const ClothModel<double> model = build_cloth<double>(def);
  const auto n = static_cast<Eigen::Index>(model.mass.size());
  Eigen::MatrixXd matrix = test::bending_matrix(model);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double root = std::sqrt(model.mass[static_cast<std::size_t>(i)]);
    matrix.row(i) /= root;
    matrix.col(i) /= root;
  }
  CHECK(std::sqrt(model.parts[0].bounds.bending_omega2) >=
        std::sqrt(matrix.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff()));
  return matrix.selfadjointView<Eigen::Lower>().eigenvalues();
}

/// What the tip of a strip drops over how far it reaches, at rest under its own weight.
struct Overhang {
  Cut cut;
  int segments;
  SolverKind solver = SolverKind::verlet;

  static constexpr double kLength = 0.15, kDensity = 0.2, kGravity = 9.81, kGamma = 10;

  double drop_over_reach() const {
    // Three lines of particles are pinned, which clamp half a cell behind the last.
    const double length = kLength / (1 - 1.5 / rows()), line = length / rows();
    const double cell = length / (segments + 2);
    ClothDef strip = test::triangle_sheet(cut, 4 * cell, length, cell);
    test::straighten(cut, cell, *strip.mesh);
    FabricDef& f = strip.fabric;
    f.areal_density = kDensity;
    f.bending_warp = f.bending_weft = kDensity * kGravity * std::pow(kLength, 3) / kGamma;
    f.stretch_warp = f.stretch_weft = 2000 * kDensity * kGravity * kLength;
    f.shear = 0.3 * f.stretch_warp;
    f.poisson = 0;
    WorldDef def = test::empty_world(strip);
    def.environment.gravity = Vec3d(0, 0, -kGravity);
    const ClothModel<double> model = build_cloth<double>(strip);
    for (std::size_t i = 0; i < model.rest_positions.size(); ++i) {
      if (model.rest_positions[i][1] > -2 * line - 1e-6)
        def.pins.push_back({static_cast<Index>(i), 0, {}});
    }
    def.solver.kind = solver;
    if (solver == SolverKind::relaxation) {
      def.relaxation.compliance = 1;
      def.relaxation.substeps = 100;
      def.relaxation.sweeps = 1;
      def.relaxation.damping = 0;
    }
    World<double> world(def);
    const double frequency = 1.2 * std::sqrt(kGravity / kLength);
    test::settle(world, 1.5 * frequency, 25 / frequency);
    double y = 0, z = 0, count = 0;
    for (std::size_t i = 0; i < model.rest_positions.size(); ++i) {
      if (model.rest_positions[i][1] > -length + 1e-6) continue;
      y += world.state().x[i][1], z += world.state().x[i][2], ++count;
    }
    return -z / (-y - 1.5 * line * count);
  }

 private:
  /// Rows of triangles, of which the first two are held.
  double rows() const { return test::rows_of(cut, segments + 2); }
};

}  // namespace

TEST_CASE("rolled in any of 8 directions a mesh has its fabric's bending energy, to h^2") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    const double coarse = worst_rolled_error(cut, 0.1), fine = worst_rolled_error(cut, 0.05);
    INFO("at h = R/10 " << coarse << ", at R/20 " << fine);
    CHECK(coarse < 0.003);
    CHECK(fine < 0.3 * coarse);
  }
}

TEST_CASE("patch test: curved alike everywhere, inner particles of a mesh feel no force") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    constexpr double kEdge = 0.05, kCurvature = 0.1;
    const ClothModel<double> model = build_cloth<double>(sheet(cut, 1, 0.8, kEdge, 0.4));
    Vec3Array<double> x = model.rest_positions, force(x.size(), Vec3d::Zero());
    for (Vec3d& p : x)
      p[2] = 0.5 * kCurvature * (p[0] * p[0] - 0.3 * p[1] * p[1] + 0.7 * p[0] * p[1]);
    add_quadratic_bending_forces(model, x, force);
    double inner = 0, border = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      // A border's forces are those of the moment there, which reach as far as slopes look.
      const double from_border = std::min({x[i][0], 1 - x[i][0], -x[i][1], 0.8 + x[i][1]});
      (from_border < 3.5 * kEdge ? border : inner) =
          std::max(from_border < 3.5 * kEdge ? border : inner, force[i].norm());
    }
    CHECK(border > 0.01 * kWeftRigidity * kCurvature);
    CHECK(inner < 1e-9 * border);
  }
}

TEST_CASE("a free square mesh vibrates as a plate does, and only what is flat has no energy") {
  // The lowest modes of the energy density 1/2 (w_uu^2 + w_vv^2 + 2 w_uv^2) on the unit square by
  // Ritz's method with Legendre polynomials of degree 13.
  constexpr double kModes[] = {250.355732, 500.563902, 500.563902};
  for (const Cut cut : test::kCuts) {
    if (cut == Cut::equilateral) continue;  // a square of its own shape only
    INFO(test::name_of(cut));
    const Eigen::VectorXd modes = squared_frequencies(cut, 16);
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(modes[k]) < 1e-6 * modes[3]);
      CHECK(modes[3 + k] == Approx(kModes[k]).epsilon(0.04));
    }
  }
  const Eigen::VectorXd modes = squared_frequencies(Cut::equilateral, 16);
  for (int k = 0; k < 3; ++k) CHECK(std::abs(modes[k]) < 1e-6 * modes[3]);
  CHECK(modes[3] == Approx(kModes[0]).epsilon(0.04));
}

TEST_CASE("a cantilever of any triangles takes the shape of the heavy elastica, to 0.3 %") {
  // heavy_elastica_cantilever.table: drop/x at Gamma = 10.
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    CHECK(Overhang{cut, 40}.drop_over_reach() == Approx(1.066802320433074).epsilon(0.003));
  }
}

TEST_CASE("implicit and XPBD bend an irregular mesh as verlet does") {
  for (const SolverKind solver : {SolverKind::implicit, SolverKind::relaxation}) {
    INFO(static_cast<int>(solver));
    CHECK(Overhang{Cut::irregular, 20, solver}.drop_over_reach() ==
          Approx(Overhang{Cut::irregular, 20}.drop_over_reach()).epsilon(0.005));
  }
}
