#include <cmath>

#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "tests/support/worlds.h"

// The moduli of an orthotropic fabric, of pieces so large that their borders do not matter.

using namespace weft;

namespace {

/// A homogeneous strain in the fabric's axes; gamma is the engineering shear.
struct Strain {
  double warp = 0, weft = 0, gamma = 0;
};

/// Energy per area of a homogeneous deformation [J/m^2]: that of one more period of the pattern in
/// both directions, so that the border's share drops out.
double energy_density(const ClothDef& def, const Strain& e) {
  const auto energy = [&](int columns, int rows) {
    ClothDef piece = def;
    piece.columns = columns;
    piece.rows = rows;
    piece.width = def.width * (columns - 1) / (def.columns - 1);
    piece.height = def.height * (rows - 1) / (def.rows - 1);
    const ClothModel<double> model = build_cloth<double>(piece);
    Vec3Array<double> x(model.mass.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double u = model.material[i][0], v = model.material[i][1];
      x[i] = Vec3d(u * (1 + e.warp) + v * e.gamma / 2, u * e.gamma / 2 + v * (1 + e.weft), 0);
    }
    return elastic_energy(model, x).stretch;
  };
  const int c = def.columns, r = def.rows;
  const double area = 4 * def.width * def.height / ((c - 1.0) * (r - 1.0));
  return (energy(c + 2, r + 2) - energy(c, r + 2) - energy(c + 2, r) + energy(c, r)) / area;
}

ClothDef fabric(double warp, double weft, double shear, double height = 1) {
  ClothDef def = test::flat_cloth(7, 7, 1, height);
  def.fabric.stretch_warp = warp;
  def.fabric.stretch_weft = weft;
  def.fabric.shear = shear;
  return def;
}

constexpr double kSmall = 1e-5;  // strain at which the springs' own geometry does not matter

/// Force per width and strain when pulled at 45 degrees with the sides free: the energy that is
/// least over the contraction and the skew that the pull brings about.
double bias_modulus(const ClothDef& def) {
  // In the fabric's axes an extension a along the bias, b across it and a skew s between them.
  const auto density = [&](double b, double s) {
    const double a = 1;
    return energy_density(
               def, {kSmall * ((a + b) / 2 + s), kSmall * ((a + b) / 2 - s), kSmall * (a - b)}) /
           (kSmall * kSmall);
  };
  // Least value of a quadratic function of two variables, from six of its values.
  const double f = density(0, 0), fb = density(1, 0), fs = density(0, 1), fbb = density(-1, 0),
               fss = density(0, -1), fbs = density(1, 1);
  const double gb = (fb - fbb) / 2, gs = (fs - fss) / 2;
  const double hbb = fb + fbb - 2 * f, hss = fs + fss - 2 * f, hbs = fbs - fb - fs + f;
  const double least =
      f - 0.5 * (hss * gb * gb - 2 * hbs * gb * gs + hbb * gs * gs) / (hbb * hss - hbs * hbs);
  return 2 * least;
}

/// Moment about a line across the strip [N m] that the part before it feels from the rest, of a
/// strip rolled along its length to the given curvature.
double moment(const ClothDef& def, bool along_warp, double curvature) {
  const ClothModel<double> model = build_cloth<double>(def);
  Vec3Array<double> x(model.mass.size());
  const double length = along_warp ? def.width : def.height;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double along = model.material[i][along_warp ? 0 : 1] - length / 2;
    const double across = model.material[i][along_warp ? 1 : 0];
    x[i] = Vec3d(std::sin(curvature * along) / curvature,
                 (1 - std::cos(curvature * along)) / curvature, across);
  }
  const Vec3Array<double> still(x.size(), Vec3d::Zero());
  Vec3Array<double> force = still;
  add_hinge_forces(model, x, still, force);
  add_quadratic_bending_forces(model, x, force);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i][0] < 0) sum += x[i][0] * force[i][1] - x[i][1] * force[i][0];
  }
  return sum;
}

}  // namespace

TEST_CASE("a spring grid has the tensor C11 = Y_w, C22 = Y_f, C12 = C66 = G, to 0.1 %") {
  const double height = GENERATE(1.0, 2.0, 0.6);
  const ClothDef def = fabric(500, 300, 40, height);
  const auto density = [&](const Strain& e) { return energy_density(def, e) / (kSmall * kSmall); };
  const double warp = density({kSmall, 0, 0}), weft = density({0, kSmall, 0});
  CHECK(2 * warp == Approx(500).epsilon(1e-3));
  CHECK(2 * weft == Approx(300).epsilon(1e-3));
  CHECK(2 * density({0, 0, kSmall}) == Approx(40).epsilon(1e-3));
  CHECK(density({kSmall, kSmall, 0}) - warp - weft == Approx(40).epsilon(1e-3));
}

TEST_CASE("pulled on the bias the modulus is that of the tensor, to 1 %") {
  // spring_grid_effective_moduli.E_45: k_s = 100 with k_d = 50, 100 and 10, so Y = k_s + k_d, G =
  // k_d.
  const auto [stretch, shear, modulus] =
      GENERATE(table<double, double, double>({{150, 50, 133.33333333333334},
                                              {200, 100, 240.00000000000006},
                                              {110, 10, 34.285714285714285}}));
  CHECK(bias_modulus(fabric(stretch, stretch, shear)) == Approx(modulus).epsilon(0.01));
}

TEST_CASE("an orthotropic fabric's bias modulus follows from its four constants, to 1 %") {
  // 4 / E_45 = S11 + S22 + 2 S12 + S66 with the compliances of C11 = 500, C22 = 300, C12 = C66
  // = 40.
  const double det = 500.0 * 300 - 40.0 * 40;
  const double modulus = 4 / ((300 + 500 - 2 * 40.0) / det + 1 / 40.0);
  CHECK(bias_modulus(fabric(500, 300, 40)) == Approx(modulus).epsilon(0.01));
  CHECK(bias_modulus(fabric(500, 300, 40, 0.7)) == Approx(modulus).epsilon(0.01));
}

TEST_CASE("a strip rolled along warp or weft resists with the moment B kappa a width, to 1 %") {
  const BendingModel bending = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  const bool along_warp = GENERATE(true, false);
  ClothDef def = test::flat_cloth(along_warp ? 5 : 12, along_warp ? 12 : 5,
                                  along_warp ? 0.22 : 0.08, along_warp ? 0.08 : 0.22);
  def.bending_model = bending;
  def.fabric.bending_warp = 4e-4;
  def.fabric.bending_weft = 1e-4;
  constexpr double kCurvature = 0.5, kWidth = 0.08;
  const double rigidity = along_warp ? 4e-4 : 1e-4;
  // The forces of the part before the cut turn it back, about -z or z by the handedness of the
  // axes.
  CHECK(std::abs(moment(def, along_warp, kCurvature)) ==
        Approx(rigidity * kCurvature * kWidth).epsilon(0.01));
}
