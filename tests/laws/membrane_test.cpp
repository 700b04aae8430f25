#include <cmath>

#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "core/forces/mesh_pass.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// The membrane of meshes: one fabric, whatever the triangles. Closed forms of plane stress.

using namespace weft;
using test::Cut;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kGrains[] = {0, 30 * kDegree, 45 * kDegree, 90 * kDegree};

FabricDef fabric(double warp, double weft, double shear, double poisson) {
  FabricDef f;
  f.stretch_warp = warp;
  f.stretch_weft = weft;
  f.shear = shear;
  f.poisson = poisson;
  return f;
}

/// Wool jersey and canvas, as it were: soft in shear, unlike in both ways, with ratios that no net
/// of springs has.
const FabricDef kFabrics[] = {fabric(600, 150, 20, kPoissonOfGrid), fabric(300, 300, 100, 0.5),
                              fabric(1500, 900, 50, 0.1)};

/// Compliances along and across a direction at an angle to the warp [m/N].
struct Compliance {
  double along, across_along, shear;  ///< 1/E, -nu/E, 1/G

  Compliance(const FabricDef& f, double angle) {
    const double c11 = f.stretch_warp, c22 = f.stretch_weft, c66 = f.shear;
    const double c12 = f.poisson == kPoissonOfGrid ? c66 : f.poisson * c22;
    const double det = c11 * c22 - c12 * c12;
    const double s11 = c22 / det, s22 = c11 / det, s12 = -c12 / det, s66 = 1 / c66;
    const double c = std::cos(angle), s = std::sin(angle), c2 = c * c, s2 = s * s;
    along = s11 * c2 * c2 + s22 * s2 * s2 + (2 * s12 + s66) * c2 * s2;
    across_along = (s11 + s22 - s66) * c2 * s2 + s12 * (c2 * c2 + s2 * s2);
    shear = 4 * (s11 + s22 - 2 * s12) * c2 * s2 + s66 * (c2 - s2) * (c2 - s2);
  }
};

/// Energy per area of a sheet whose plane is strained by a, b and the engineering shear g, along
/// its own sides [J/m^2].
double energy_density(const ClothModel<double>& model, double area, double a, double b, double g) {
  Vec3Array<double> x = model.rest_positions;
  for (Vec3d& p : x) p = Vec3d(p[0] * (1 + a) + 0.5 * g * p[1], 0.5 * g * p[0] + (1 + b) * p[1], 0);
  return elastic_energy(model, x).stretch / area;
}

/// The tensor in the sheet's own sides, from the energies of six strains.
Eigen::Matrix3d tensor_of(const ClothModel<double>& model, double area) {
  constexpr double kSmall = 1e-5;
  const auto density = [&](const Eigen::Vector3d& e) {
    return energy_density(model, area, e[0], e[1], e[2]);
  };
  Eigen::Matrix3d c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d ei = kSmall * Eigen::Vector3d::Unit(i),
                            ej = kSmall * Eigen::Vector3d::Unit(j);
      c(i, j) = (density(ei + ej) - density(ei - ej)) / (2 * kSmall * kSmall);
    }
  }
  return c;
}

}  // namespace

TEST_CASE("on any mesh modulus, shear and Poisson's ratio are the fabric's in every direction") {
  for (const Cut cut : test::kCuts) {
    for (const FabricDef& f : kFabrics) {
      for (const double grain : kGrains) {
        INFO(test::name_of(cut) << ", warp " << f.stretch_warp << " N/m, " << grain / kDegree);
        ClothDef def = test::triangle_sheet(cut, 0.3, 0.5, 0.05, grain);
        def.fabric = f;
        const ClothModel<double> model = build_cloth<double>(def);
        const Eigen::Matrix3d s = tensor_of(model, 0.15).inverse();
        // The sheet's x is at the grain's angle to the warp, its y at right angles to that.
        const Compliance along(f, grain), across(f, grain + 90 * kDegree);
        CHECK(s(0, 0) == Approx(along.along).epsilon(0.001));
        CHECK(s(1, 1) == Approx(across.along).epsilon(0.001));
        CHECK(s(0, 1) / s(0, 0) == Approx(along.across_along / along.along).epsilon(0.001));
        CHECK(s(2, 2) == Approx(along.shear).epsilon(0.001));
      }
    }
  }
}

TEST_CASE("patch test: stretched and sheared alike everywhere, inner particles feel no force") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    constexpr double kEdge = 0.02, kStrain = 0.2;
    ClothDef def = test::triangle_sheet(cut, 0.2, 0.16, kEdge, 0.4);
    def.fabric = kFabrics[0];
    def.fabric.bending_warp = def.fabric.bending_weft = 0;
    const ClothModel<float> model = build_cloth<float>(def);
    Vec3Array<float> x = model.rest_positions, v(x.size(), Vec3f::Zero()), force = v;
    for (Vec3f& p : x)
      p = Vec3f(p[0] * (1 + float(kStrain)), p[1] * (1 - 0.5F * float(kStrain)) + 0.07F * p[0], 0);
    MeshPass<float> pass;
    pass.prepare(model, model.parts[0]);
    REQUIRE(pass.fits());
    pass.compute_forces(x, v, force);
    double worst = 0;
    std::size_t inner = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3f& p = model.rest_positions[i];
      if (p[0] < 1e-4 || p[0] > 0.2F - 1e-4F || p[1] > -1e-4 || p[1] < -0.16F + 1e-4F) continue;
      worst = std::max(worst, static_cast<double>(force[i].norm()));
      ++inner;
    }
    REQUIRE(inner > 50);
    CHECK(worst < 1e-5 * def.fabric.stretch_warp * kStrain * kEdge);
  }
}

namespace {

/// A strip that hangs by its upper border, and 1/E of its lower half as its places at rest tell:
/// down from s to the free end at L it is longer by g sigma (L s - s^2/2) / E. Its upper half is
/// held from narrowing.
struct Hung {
  SolverKind solver = SolverKind::verlet;
  int substeps = 1, sweeps = 1;

  double compliance(const ClothDef& strip, double length) const {
    WorldDef def = test::empty_world(strip);
    def.environment.gravity = Vec3d(0, -1, 0);
    def.pins = test::upper_border(strip);
    def.solver.kind = solver;
    if (solver == SolverKind::relaxation) {
      def.relaxation.compliance = 1;
      def.relaxation.substeps = substeps;
      def.relaxation.sweeps = sweeps;
      def.relaxation.damping = 0;
    }
    World<float> world(def);
    test::settle(world, 12, 3);
    return fitted(world, length, strip.fabric.areal_density);
  }

 private:
  /// Of a least-squares fit of the displacements by an offset and that law.
  static double fitted(const World<float>& world, double length, double density) {
    double n = 0, sq = 0, sqq = 0, sd = 0, sqd = 0;
    for (std::size_t i = 0; i < world.state().x.size(); ++i) {
      const double s = -static_cast<double>(world.model().rest_positions[i][1]);
      if (s < length / 2) continue;
      const double q = density * (length * s - s * s / 2);
      const double d = -static_cast<double>(world.state().x[i][1]) - s;
      n += 1, sq += q, sqq += q * q, sd += d, sqd += q * d;
    }
    return (n * sqd - sq * sd) / (n * sqq - sq * sq);
  }
};

}  // namespace

TEST_CASE("a hung strip is as long as its fabric says at any grain, to 3 % at 20 mm, 1 % at 10") {
  const Cut cut = GENERATE(Cut::one_diagonal, Cut::irregular);
  const double edge = GENERATE(0.02, 0.01);
  for (const FabricDef& f : kFabrics) {
    for (const double grain : kGrains) {
      INFO(test::name_of(cut) << ", warp " << f.stretch_warp << ", grain " << grain / kDegree
                              << ", h " << edge);
      ClothDef strip = test::triangle_sheet(cut, 0.2, 0.6, edge, grain);
      strip.fabric = f;
      strip.fabric.damping_ratio = 0.2;
      const double wanted = Compliance(f, grain + 90 * kDegree).along;
      CHECK(Hung{}.compliance(strip, 0.6) == Approx(wanted).epsilon(edge > 0.015 ? 0.03 : 0.01));
    }
  }
}

TEST_CASE("implicit and XPBD hang a strip as verlet does") {
  ClothDef strip = test::triangle_sheet(Cut::irregular, 0.1, 0.3, 0.02, 30 * kDegree);
  strip.fabric = kFabrics[0];
  strip.fabric.damping_ratio = 0.2;
  const double wanted = Hung{}.compliance(strip, 0.3);
  CHECK(Hung{SolverKind::implicit}.compliance(strip, 0.3) == Approx(wanted).epsilon(0.005));
  CHECK(Hung{SolverKind::relaxation, 60, 8}.compliance(strip, 0.3) ==
        Approx(wanted).epsilon(0.005));
}
