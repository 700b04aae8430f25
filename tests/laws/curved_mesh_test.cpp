#include <cmath>
#include <functional>
#include <random>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "core/forces/rest_curve.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// The bending of meshes that are curved at rest: one fabric, whatever the triangles.

using namespace weft;
using test::Cut;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWarpRigidity = 3e-5, kWeftRigidity = 1e-5;  // rigidities [N m]
constexpr double kWidth = 1, kHeight = 0.8, kRadius = 0.5;    // [m]

/// A sheet rolled onto a cylinder without strain.
struct Roll {
  double angle = 0;      ///< of the curved direction from the sheet's x [rad]
  double curvature = 0;  ///< [1/m], of either sign

  Vec3d place(const Vec3d& p) const {
    if (curvature == 0) return p;
    const double c = std::cos(angle), s = std::sin(angle);
    const double along = (c * p[0] + s * p[1]) * curvature, across = -s * p[0] + c * p[1];
    const double out = std::sin(along) / curvature, up = (1 - std::cos(along)) / curvature;
    return {c * out - s * across, s * out + c * across, up};
  }

  /// Curvatures along u, along v and between them. The weft runs down, and the warp is turned by
  /// the grain towards it.
  Eigen::Vector3d along_threads(double grain) const {
    const double u = std::cos(angle - grain), v = std::sin(angle - grain);
    return curvature * Eigen::Vector3d(u * u, v * v, -u * v);
  }
};

ClothDef sheet(Cut cut, double h, double grain) {
  ClothDef def = test::triangle_sheet(cut, kWidth, kHeight, h, grain);
  def.fabric.bending_warp = kWarpRigidity;
  def.fabric.bending_weft = kWeftRigidity;
  return def;
}

template <class Place>
ClothModel<double> curved(ClothDef def, const Place& place) {
  for (Vec3d& p : def.mesh->mesh.positions) p = place(p);
  return build_cloth<double>(def);
}

/// Energy of a sheet that is rolled one way at rest and now another way, over the continuum's.
double rerolled_energy(Cut cut, double h, double grain, const Roll& rest, const Roll& now) {
  const ClothDef def = sheet(cut, h, grain);
  const ClothModel<double> flat = build_cloth<double>(def);
  const ClothModel<double> model = curved(def, [&](const Vec3d& p) { return rest.place(p); });
  CHECK(model.hinges.empty());
  Vec3Array<double> x = flat.rest_positions;
  for (Vec3d& p : x) p = now.place(p);
  const Eigen::Vector3d change = now.along_threads(grain) - rest.along_threads(grain);
  const Eigen::Vector3d rigidity(kWarpRigidity, kWeftRigidity, kWarpRigidity + kWeftRigidity);
  return elastic_energy(model, x).bending /
         (0.5 * rigidity.dot(change.cwiseProduct(change)) * kWidth * kHeight);
}

double worst_rerolled_error(Cut cut, double h) {
  double worst = 0;
  for (int k = 0; k < 8; ++k) {
    const double grain = k % 2 == 0 ? 0 : 0.5;
    const Roll rest{k * kPi / 8, 1 / kRadius};
    for (const Roll& now : {Roll{0, 0}, Roll{rest.angle, -1 / kRadius},
                            Roll{rest.angle, 0.5 / kRadius}, Roll{1, 1 / kRadius}})
      worst = std::max(worst, std::abs(rerolled_energy(cut, h, grain, rest, now) - 1));
  }
  return worst;
}

/// A place on a sphere around (0.5, -0.4, kRadius), straight over p.
Vec3d on_sphere(const Vec3d& p) {
  const double x = p[0] - 0.5 * kWidth, y = p[1] + 0.5 * kHeight;
  return {0.5 * x, 0.5 * y, kRadius - std::sqrt(kRadius * kRadius - 0.25 * (x * x + y * y))};
}

Vec3Array<double> shaken(Vec3Array<double> x, double size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-size, size);
  for (Vec3d& p : x) p += Vec3d(shift(random), shift(random), shift(random));
  return x;
}

/// A quarter of a narrow tube, clamped level at one end and hanging down freely from there, under
/// so little weight that it bends in proportion.
struct QuarterTube {
  Cut cut;
  int segments;
  SolverKind solver = SolverKind::verlet;

  static constexpr double kLength = 0.15, kDensity = 0.2, kRigidity = 1e-3, kGamma = 0.02;
  static constexpr double kGravity = kGamma * kRigidity / (kDensity * kLength * kLength * kLength);
  static constexpr double kArc = kLength / (kPi / 2);

  /// How far the free end sinks and moves on, over what theory tells of both.
  Eigen::Vector2d moved() const {
    // Three lines of particles are pinned, which clamp half a cell behind the last.
    const double length = kLength / (1 - 1.5 / rows()), line = length / rows();
    const double cell = length / (segments + 2);
    ClothDef strip = test::triangle_sheet(cut, 4 * cell, length, cell);
    test::straighten(cut, cell, *strip.mesh);
    for (Vec3d& p : strip.mesh->mesh.positions) {
      const double turn = (-p[1] - 1.5 * line) / kArc;
      p = Vec3d(p[0], -kArc * std::sin(turn), kArc * (1 - std::cos(turn)));
    }
    FabricDef& f = strip.fabric;
    f.areal_density = kDensity;
    f.bending_warp = f.bending_weft = kRigidity;
    f.stretch_warp = f.stretch_weft = 200 * kRigidity / (cell * cell);
    f.shear = 0.3 * f.stretch_warp;
    f.poisson = 0;
    const ClothModel<double> model = build_cloth<double>(strip);
    WorldDef def = test::empty_world(strip);
    def.environment.gravity = Vec3d(0, 0, -kGravity);
    double farthest = 0;
    for (std::size_t i = 0; i < model.rest_positions.size(); ++i) {
      if (arc_of(model, i) < 2 * line + 1e-6) def.pins.push_back({static_cast<Index>(i), 0, {}});
      farthest = std::max(farthest, arc_of(model, i));
    }
    def.solver.kind = solver;
    if (solver == SolverKind::relaxation) {
      def.relaxation.compliance = 1;
      def.relaxation.substeps = 100;
      def.relaxation.sweeps = 1;
      def.relaxation.damping = 0;
    }
    World<double> world(def);
    const double frequency = 3.5 * std::sqrt(kRigidity / kDensity) / (kLength * kLength);
    test::settle(world, 1.5 * frequency, 25 / frequency);
    Vec3d sum = Vec3d::Zero();
    double count = 0;
    for (std::size_t i = 0; i < model.rest_positions.size(); ++i) {
      if (arc_of(model, i) < farthest - 1e-6) continue;
      sum += world.state().x[i] - model.rest_positions[i], ++count;
    }
    const Eigen::Vector2d theory = deflection(kDensity * kGravity / kRigidity);
    return {-sum[2] / count / theory[0], -sum[1] / count / theory[1]};
  }

 private:
  double rows() const { return test::rows_of(cut, segments + 2); }

  double arc_of(const ClothModel<double>& model, std::size_t i) const {
    return static_cast<double>(model.material[i][1]);
  }

  /// Of an arc's end downwards and onwards, by Castigliano: the integral over the arc of the moment
  /// of the weight beyond each place times the end's lever there.
  /// @param load  weight an area over rigidity [1/m^3]
  static Eigen::Vector2d deflection(double load) {
    constexpr int kParts = 1000;
    const double end = kPi / 2, part = end / kParts;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = 0; k < kParts; ++k) {
      const double a = (k + 0.5) * part;
      const double moment =
          load * kArc * kArc * (std::cos(a) - std::cos(end) - (end - a) * std::sin(a));
      const Eigen::Vector2d lever(std::sin(end) - std::sin(a), std::cos(a) - std::cos(end));
      sum += moment * kArc * kArc * part * lever;
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("rolled otherwise than at rest a mesh has its fabric's bending energy, in h^2") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    const double coarse = worst_rerolled_error(cut, 0.1 * kRadius),
                 fine = worst_rerolled_error(cut, 0.05 * kRadius);
    INFO("at h = R/10 " << coarse << ", at R/20 " << fine);
    CHECK(coarse < 0.01);
    CHECK(fine < 0.5 * coarse);
  }
}

TEST_CASE("a mesh that bulges by a hundredth of an edge is curved at rest") {
  const ClothModel<double> bulged = curved(sheet(Cut::alternating, 0.1, 0), [](const Vec3d& p) {
    return Vec3d(p[0], p[1], 0.001 * std::sin(10 * p[0]));
  });
  CHECK(bulged.parts[0].curved_at_rest);
  CHECK_FALSE(build_cloth<double>(sheet(Cut::alternating, 0.1, 0)).parts[0].curved_at_rest);
}

TEST_CASE("turned inside out a cap of a sphere has the energy of twice its curvature") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const ClothModel<double> cap = curved(sheet(cut, k == 0 ? 0.1 : 0.05, 0), on_sphere);
      Vec3Array<double> x = cap.rest_positions;
      for (Vec3d& p : x) p[2] = -p[2];
      double area = 0;
      for (const double a : cap.triangle_area) area += a;
      const double density = 0.5 * (kWarpRigidity + kWeftRigidity) * 4 / (kRadius * kRadius);
      error[k] = std::abs(elastic_energy(cap, x).bending / (density * area) - 1);
    }
    INFO("errors " << error[0] << " and " << error[1]);
    CHECK(error[0] < 0.01);
    CHECK(error[1] < 0.6 * error[0]);
  }
}

TEST_CASE("a mesh is at rest as it lies: on a cylinder, a sphere and a wrinkled sheet") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    const Roll roll{0.7, 1 / kRadius};
    const auto wrinkled = [](const Vec3d& p) {
      return Vec3d(p[0], p[1], 0.03 * std::sin(20 * p[0]) * std::cos(17 * p[1]));
    };
    const std::function<Vec3d(const Vec3d&)> places[] = {
        [&](const Vec3d& p) { return roll.place(p); }, on_sphere, wrinkled};
    for (const auto& place : places) {
      const ClothModel<double> model = curved(sheet(cut, 0.06, 0.3), place);
      const Vec3Array<double>& x = model.rest_positions;
      const auto forces = [&](const Vec3Array<double>& at) {
        Vec3Array<double> force(x.size(), Vec3d::Zero());
        add_quadratic_bending_forces(model, at, force);
        add_rest_curve_forces(model.parts[0], at, force);
        double most = 0;
        for (const Vec3d& f : force) most = std::max(most, f.norm());
        return most;
      };
      const double bent = forces(shaken(x, 1e-3));
      CHECK(forces(x) < 1e-5 * bent);
      CHECK(std::abs(elastic_energy(model, x).bending) < 1e-4 * model.parts[0].rest_curves.energy);
    }
  }
}

TEST_CASE("the forces of a curved mesh are those of its energy, crumpled too, and it never gains") {
  for (const double size : {1e-3, 0.02, 0.1}) {
    INFO("shaken by " << size);
    const Roll roll{0.7, 3};
    const ClothModel<double> model =
        curved(sheet(Cut::irregular, 0.15, 0.3), [&](const Vec3d& p) { return roll.place(p); });
    Vec3Array<double> x = shaken(model.rest_positions, size), force(x.size(), Vec3d::Zero());
    add_quadratic_bending_forces(model, x, force);
    add_rest_curve_forces(model.parts[0], x, force);
    CHECK(elastic_energy(model, x).bending > 0);
    double most = 0;
    for (const Vec3d& f : force) most = std::max(most, f.norm());
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        constexpr double kStep = 1e-6;
        double energy[2];
        for (int k = 0; k < 2; ++k) {
          x[i][c] += k == 0 ? kStep : -2 * kStep;
          energy[k] = elastic_energy(model, x).bending;
        }
        x[i][c] += kStep;
        CHECK(std::abs(force[i][c] + (energy[0] - energy[1]) / (2 * kStep)) < 1e-5 * most);
      }
    }
  }
}

TEST_CASE("a quarter of a tube of any triangles bends under its weight as Castigliano tells") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    const Eigen::Vector2d moved = QuarterTube{cut, 20}.moved();
    CHECK(moved[0] == Approx(1).epsilon(0.01));
    CHECK(moved[1] == Approx(1).epsilon(0.01));
  }
}

TEST_CASE("implicit and XPBD bend a curved mesh as verlet does") {
  const Eigen::Vector2d verlet = QuarterTube{Cut::irregular, 15}.moved();
  for (const SolverKind solver : {SolverKind::implicit, SolverKind::relaxation}) {
    INFO(static_cast<int>(solver));
    const Eigen::Vector2d moved = QuarterTube{Cut::irregular, 15, solver}.moved();
    CHECK(moved[0] == Approx(verlet[0]).epsilon(0.01));
    CHECK(moved[1] == Approx(verlet[1]).epsilon(0.01));
  }
}

TEST_CASE("the stable substep of a curved mesh bounds its stiffness, at rest, flat and crumpled") {
  ClothDef def = sheet(Cut::irregular, 0.15, 0.3);
  for (Vec3d& p : def.mesh->mesh.positions) p = Roll{0.7, 6}.place(p);
  const ClothModel<double> model = build_cloth<double>(def);
  const Vec3Array<double> flat =
      build_cloth<double>(sheet(Cut::irregular, 0.15, 0.3)).rest_positions;
  for (const Vec3Array<double>& at :
       {model.rest_positions, flat, shaken(model.rest_positions, 0.05)}) {
    const auto n = static_cast<Eigen::Index>(3 * at.size());
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index column = 0; column < n; ++column) {
      constexpr double kStep = 1e-6;
      Vec3Array<double> x = at;
      for (const double step : {kStep, -2 * kStep}) {
        x[static_cast<std::size_t>(column / 3)][column % 3] += step;
        Vec3Array<double> force(x.size(), Vec3d::Zero());
        add_quadratic_bending_forces(model, x, force);
        add_rest_curve_forces(model.parts[0], x, force);
        for (Eigen::Index row = 0; row < n; ++row) {
          const double f = force[static_cast<std::size_t>(row / 3)][row % 3];
          matrix(row, column) = step > 0 ? -f : (matrix(row, column) + f) / (2 * kStep);
        }
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const double root = std::sqrt(model.mass[static_cast<std::size_t>(i / 3)]);
      matrix.row(i) /= root;
      matrix.col(i) /= root;
    }
    const double highest = (0.5 * (matrix + matrix.transpose()))
                               .selfadjointView<Eigen::Lower>()
                               .eigenvalues()
                               .maxCoeff();
    INFO(highest << " of " << model.parts[0].bounds.bending_omega2);
    CHECK(highest < model.parts[0].bounds.bending_omega2);
    CHECK(highest > 0.02 * model.parts[0].bounds.bending_omega2);
  }
}

TEST_CASE("a sharply pleated mesh hangs and comes to rest alike by every solver") {
  // Folded by a right angle at every second line of its particles.
  constexpr double kCell = 0.05;
  const auto pleated = [](const Vec3d& p) {
    const double fold = std::abs(p[0] / (4 * kCell) - std::round(p[0] / (4 * kCell))) * 4 * kCell;
    return Vec3d(p[0] * std::sqrt(0.5), p[1], fold * std::sqrt(0.5));
  };
  const auto lowest = [&](SolverKind solver) {
    ClothDef def = sheet(Cut::alternating, kCell, 0);
    for (Vec3d& p : def.mesh->mesh.positions) p = pleated(p);
    def.fabric.bending_warp = def.fabric.bending_weft = 3e-3;
    WorldDef world_def = test::empty_world(def);
    world_def.environment.gravity = Vec3d(0, 0, -9.81);
    world_def.solver.kind = solver;
    world_def.pins.push_back({0, 0.11, {}});
    World<double> world(world_def);
    CHECK(test::settle(world, 4, 12) < 1e-3);
    double z = 0;
    for (const Vec3d& p : world.state().x) z = std::min(z, p[2]);
    return z;
  };
  const double verlet = lowest(SolverKind::verlet);
  CHECK(lowest(SolverKind::implicit) == Approx(verlet).epsilon(1e-4));
  // XPBD's sweeps leave its threads softer.
  CHECK(lowest(SolverKind::relaxation) == Approx(verlet).epsilon(0.05));
}

TEST_CASE("a fan of 1200 triangles around one particle has no more links than a strip of as many") {
  constexpr int kSpokes = 1200;
  ClothDef def;
  ClothMesh& fan = def.mesh.emplace();
  fan.mesh.positions.push_back(Vec3d::Zero());
  for (int k = 0; k < kSpokes; ++k) {
    const double turn = 2 * kPi * k / kSpokes;
    fan.mesh.positions.emplace_back(std::cos(turn), std::sin(turn), 0.3 * std::sin(3 * turn));
    fan.mesh.triangles.push_back({0, k + 1, (k + 1) % kSpokes + 1});
  }
  const ClothModel<double> model = build_cloth<double>(def);
  CHECK(model.parts[0].curved_at_rest);
  // Each particle is bent by those a few spokes away, and by the hub.
  CHECK(model.parts[0].bending_links.size() < 12 * kSpokes);
}
