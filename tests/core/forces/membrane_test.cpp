#include "core/forces/membrane.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "core/cloth/membrane.h"
#include "core/error.h"
#include "core/forces/force_pass.h"
#include "core/solver/implicit/membrane_term.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

using namespace weft;
using test::Cut;
using test::SeededRandom;

namespace {

ClothDef canvas() {
  ClothDef def = test::triangle_sheet(Cut::irregular, 0.5, 0.4, 0.1, 0.6);
  def.fabric.stretch_warp = 600;
  def.fabric.stretch_weft = 150;
  def.fabric.shear = 20;
  def.fabric.poisson = 0.3;
  return def;
}

std::string refused(const ClothDef& def) {
  try {
    build_cloth<double>(def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "nothing";
}

using Corners = std::array<Vec3d, 3>;
using Block9 = Eigen::Matrix<double, 9, 9>;

Corners corners_of(const ClothModel<double>& model, std::size_t n, const Vec3Array<double>& x) {
  const Triangle& t = model.membrane[n].x;
  return {x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
          x[static_cast<std::size_t>(t[2])]};
}

Block9 matrix_of(const MembraneTerm<double>& term, const MembraneTriangle<double>& t) {
  Block9 matrix;
  for (int column = 0; column < 9; ++column) {
    Corners p{Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
    p[static_cast<std::size_t>(column / 3)][column % 3] = 1;
    const Corners y = term.times(t, p);
    for (int row = 0; row < 9; ++row)
      matrix(row, column) = y[static_cast<std::size_t>(row / 3)][row % 3];
  }
  return matrix;
}

Block9 difference_of_forces(const MembraneTensor<double>& c, const MembraneTriangle<double>& t,
                            const Corners& x) {
  const Corners still{Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  constexpr double kStep = 1e-7;
  Block9 matrix;
  for (int column = 0; column < 9; ++column) {
    Corners high = x, low = x;
    high[static_cast<std::size_t>(column / 3)][column % 3] += kStep;
    low[static_cast<std::size_t>(column / 3)][column % 3] -= kStep;
    const Corners up = MembraneTerm<double>(c, t, high, still, 1).forces(),
                  down = MembraneTerm<double>(c, t, low, still, 1).forces();
    for (int row = 0; row < 9; ++row)
      matrix(row, column) = -(up[static_cast<std::size_t>(row / 3)][row % 3] -
                              down[static_cast<std::size_t>(row / 3)][row % 3]) /
                            (2 * kStep);
  }
  return matrix;
}

}  // namespace

TEST_CASE("the membrane's dashpots take energy and resist no rigid motion") {
  const ClothModel<double> model = build_cloth<double>(canvas());
  REQUIRE(model.parts[0].membrane_tensor.stretch_time > 0);
  SeededRandom random(4);
  const Vec3Array<double> x = test::shaken(model, 0.03, random), still(x.size(), Vec3d::Zero());
  const auto force = [&](const Vec3Array<double>& v) {
    Vec3Array<double> f = still;
    add_membrane_forces(model, x, v, f);
    return f;
  };
  const Vec3Array<double> elastic = force(still);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3Array<double> v = test::random_velocities(model, 2, random), f = force(v);
    double power = 0;
    for (std::size_t i = 0; i < x.size(); ++i) power += (f[i] - elastic[i]).dot(v[i]);
    CHECK(power < 0);
  }
  Vec3Array<double> turning;
  double largest = 0;
  for (const Vec3d& p : x) turning.push_back(Vec3d(1, 2, 3) + Vec3d(4, -1, 2).cross(p));
  for (const Vec3d& f : elastic) largest = std::max(largest, f.norm());
  const Vec3Array<double> f = force(turning);
  for (std::size_t i = 0; i < x.size(); ++i) CHECK((f[i] - elastic[i]).norm() < 1e-10 * largest);
}

TEST_CASE("the membrane's forces add up to no force and no moment, damped or not, to 1e-12") {
  const ClothModel<double> model = build_cloth<double>(canvas());
  SeededRandom random(5);
  const Vec3Array<double> x = test::shaken(model, 0.05, random);
  const Vec3Array<double> v = test::random_velocities(model, 3, random);
  Vec3Array<double> f(x.size(), Vec3d::Zero());
  add_membrane_forces(model, x, v, f);
  Vec3d sum = Vec3d::Zero(), moment = Vec3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += f[i];
    moment += x[i].cross(f[i]);
    size += f[i].norm();
  }
  CHECK(sum.norm() < 1e-12 * size);
  CHECK(moment.norm() < 1e-12 * size);
}

TEST_CASE("a triangle laid flat keeps its shape, and its threads follow uv of any scale") {
  SeededRandom random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Corners x{random.vector(1), random.vector(1), random.vector(1)};
    const RestCorners flat = laid_flat(x, {{{0, 0}, {3, 1}, {1, 2}}});
    const auto side = [&](std::size_t a, std::size_t b) {
      return std::hypot(flat[a][0] - flat[b][0], flat[a][1] - flat[b][1]);
    };
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(side(k, (k + 1) % 3) == Approx((x[k] - x[(k + 1) % 3]).norm()));
    // With uv of the triangle's own shape, turned, mirrored or scaled, the rest shape is that.
    const double angle = random.uniform(-3, 3), scale = random.uniform(0.1, 10);
    const double mirror = trial % 2 == 0 ? 1 : -1;
    RestCorners uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [s, t] = flat[k];
      uv[k] = {scale * (std::cos(angle) * s - std::sin(angle) * t),
               mirror * scale * (std::sin(angle) * s + std::cos(angle) * t)};
    }
    const RestCorners again = laid_flat(x, uv);
    for (std::size_t k = 1; k < 3; ++k) {
      CHECK(again[k][0] - again[0][0] == Approx((uv[k][0] - uv[0][0]) / scale).margin(1e-9));
      CHECK(again[k][1] - again[0][1] == Approx((uv[k][1] - uv[0][1]) / scale).margin(1e-9));
    }
  }
}

TEST_CASE("a stiffness tensor that is not positive definite is refused by name, as on a grid") {
  ClothDef def = canvas();  // 600 and 150 N/m: C12 below 300, Poisson's ratio below 2
  CHECK(refused(def) == "nothing");
  def.fabric.poisson = 1.99;
  CHECK(refused(def) == "nothing");
  def.fabric.poisson = 2.01;
  CHECK(refused(def) == "fabric.poisson");
  def.fabric.poisson = kPoissonOfGrid;
  def.fabric.shear = 301;
  CHECK(refused(def) == "fabric.shear");
  def.fabric.poisson = 0;
  CHECK(refused(def) == "nothing");
  def.membrane_model = MembraneModel::springs;
  CHECK(refused(def) == "fabric.poisson");
  ClothDef grid = test::flat_cloth(4, 4);
  grid.membrane_model = MembraneModel::triangles;
  CHECK(refused(grid) == "cloth.membrane_model");
  grid.membrane_model = MembraneModel::springs;
  CHECK(refused(grid) == "nothing");
  grid.fabric.poisson = 0.3;
  CHECK(refused(grid) == "fabric.poisson");
}

TEST_CASE("the largest strain told is the principal one") {
  const ClothModel<double> model = build_cloth<double>(canvas());
  const double grow = GENERATE(0.03, -0.02);
  Vec3Array<double> x = model.rest_positions;
  // Along a direction that is neither a thread's nor an edge's.
  const Vec3d along = Vec3d(1, 0.3, 0).normalized();
  for (Vec3d& p : x) p += along * (grow * along.dot(p));
  CHECK(elastic_energy(model, x).largest_strain == Approx(std::abs(grow)).epsilon(1e-6));
}

TEST_CASE("the implicit matrix of a triangle is symmetric, positive and exact along its threads") {
  const ClothModel<double> model = build_cloth<double>(canvas());
  MembraneTensor<double> c = model.parts[0].membrane_tensor;
  c.stretch_time = c.shear_time = 0;
  const Corners still{Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  SeededRandom random(8);
  for (std::size_t n = 0; n < model.membrane.size(); n += 5) {
    const MembraneTriangle<double>& t = model.membrane[n];
    // Pulled along both threads, and turned.
    const Eigen::Matrix3d turn = Eigen::Quaterniond(0.3, 0.1, -0.7, 0.5).normalized().matrix();
    const double det = t.u1 * t.v2 - t.u2 * t.v1;
    const double long_u = 1.02, long_v = 1.05;
    const Corners pulled{Vec3d::Zero(), turn * Vec3d(long_u * t.v2 / det, -long_v * t.u2 / det, 0),
                         turn * Vec3d(-long_u * t.v1 / det, long_v * t.u1 / det, 0)};
    const Block9 exact = difference_of_forces(c, t, pulled);
    const MembraneTerm<double> term(c, t, pulled, still, 1);
    CHECK((matrix_of(term, t) - exact).norm() < 1e-5 * exact.norm());
    // Crumpled at random.
    const Corners x = corners_of(model, n, test::shaken(model, 0.06, random));
    const MembraneTerm<double> crumpled(c, t, x, still, 1);
    const Block9 matrix = matrix_of(crumpled, t);
    CHECK((matrix - matrix.transpose()).norm() < 1e-12 * matrix.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<Block9>(matrix).eigenvalues()[0] > -1e-12 * matrix.norm());
    for (std::size_t k = 0; k < 3; ++k) {
      const SymmetricBlock<double> own = crumpled.own(t, k);
      const auto block = matrix.block<3, 3>(3 * static_cast<int>(k), 3 * static_cast<int>(k));
      CHECK(own[0] == Approx(block(0, 0)).margin(1e-9));
      CHECK(own[4] == Approx(block(1, 2)).margin(1e-9));
    }
  }
}

namespace {

/// The highest squared frequency of the membrane at these positions, by power iteration on
/// differences of its forces [1/s^2].
double highest_frequency2(const ClothModel<double>& model, const Vec3Array<double>& x) {
  SeededRandom random(9);
  Vec3Array<double> y = test::random_velocities(model, 1, random);
  const Vec3Array<double> still(x.size(), Vec3d::Zero());
  double value = 0;
  for (int round = 0; round < 400; ++round) {
    double size = 0;
    for (const Vec3d& p : y) size = std::max(size, p.norm());
    for (Vec3d& p : y) p /= size;
    constexpr double kStep = 1e-7;
    Vec3Array<double> high = x, low = x, up = still, down = still;
    for (std::size_t i = 0; i < x.size(); ++i) {
      high[i] += y[i] * kStep;
      low[i] -= y[i] * kStep;
    }
    add_membrane_forces(model, high, still, up);
    add_membrane_forces(model, low, still, down);
    double yy = 0, yky = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3d ky = (down[i] - up[i]) / (2 * kStep);
      yy += model.mass[i] * y[i].squaredNorm();
      yky += y[i].dot(ky);
      y[i] = ky / model.mass[i];
    }
    value = yky / yy;
  }
  return value;
}

}  // namespace

TEST_CASE("the bound of a membrane's frequency holds at rest, crushed and stretched") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    ClothDef def = test::triangle_sheet(cut, 0.4, 0.3, 0.05, 0.3);
    def.fabric = canvas().fabric;
    const ClothModel<double> model = build_cloth<double>(def);
    const FrequencyBounds& bounds = model.parts[0].bounds;
    const double at_rest = highest_frequency2(model, model.rest_positions);
    CHECK(at_rest <= bounds.membrane_omega2);
    CHECK(bounds.membrane_omega2 <= 2.2 * at_rest);
    SeededRandom random(10);
    for (int trial = 0; trial < 4; ++trial)
      CHECK(highest_frequency2(model, test::shaken(model, 0.01 * trial, random)) <=
            bounds.membrane_omega2 * 1.001);
    Vec3Array<double> x = model.rest_positions;
    for (Vec3d& p : x) p *= 1.6;
    CHECK(longest_thread(model, model.parts[0], x) == Approx(1.6));
    const double wide = highest_frequency2(model, x);
    CHECK(wide <= bounds.membrane_omega2 + stretched_membrane_omega2(bounds, 1.6));
  }
}

TEST_CASE("triangles need at most 1.2 times the substeps of edge springs on the same mesh") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    ClothDef def = test::triangle_sheet(cut, 0.5, 0.5, 0.02, 0.2);
    const double triangles = build_cloth<float>(def).parts[0].bounds.membrane_omega2;
    def.membrane_model = MembraneModel::springs;
    const double springs = build_cloth<float>(def).parts[0].bounds.membrane_omega2;
    CHECK(std::sqrt(triangles / springs) < 1.2);
  }
}
