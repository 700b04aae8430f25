#include "core/solver/implicit/multigrid.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "core/attachments/clamp_line.h"
#include "core/forces/force_pass.h"
#include "core/solver/implicit/conjugate_gradients.h"
#include "core/solver/implicit/element_system.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

// The linear systems of the solver implicit against dense ones.

using namespace weft;
using namespace weft::test;

namespace {

/// A cloth that was shaken, and its matrix by either system.
struct Shaken {
  ClothModel<double> model;
  Vec3Array<double> x, v;
  std::vector<double> inverse_mass;
  std::vector<double> inertia;
  std::vector<SymmetricBlock<double>> air;

  Shaken(int rows, int columns, Random& random, int pinned, double noise = 0.02) {
    ClothDef cloth = flat_cloth(rows, columns, 0.1 * (columns - 1), 0.12 * (rows - 1));
    cloth.fabric.stretch_warp = 220;
    cloth.fabric.stretch_weft = 300;
    cloth.fabric.shear = 20;
    cloth.fabric.bending_warp = 2e-3;
    cloth.fabric.bending_weft = 5e-3;
    model = build_cloth<double>(cloth);
    if (std::min(rows, columns) > 4)
      set_clamps({{{0, Side::top, 1, 8}, {0, Side::right, columns - 3, 1.5}}, {}}, model);
    x = model.rest_positions;
    v.assign(x.size(), Vec3d::Zero());
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (int d = 0; d < 3; ++d) {
        x[i][d] += random.uniform(-noise, noise);
        v[i][d] = random.uniform(-1, 1);
      }
      inverse_mass.push_back(1 / model.mass[i]);
      inertia.push_back(model.mass[i] * 8000);
      const auto some = [&] { return random.uniform(0.5, 1); };
      air.push_back({2 + some(), some(), -some(), 1 + some(), some() / 2, 3 + some()});
    }
    for (int k = 0; k < pinned; ++k)
      inverse_mass[static_cast<std::size_t>(random.index(rows * columns))] = 0;
  }
  /// Becomes another cloth, at rest and in vacuum.
  void become(const ClothDef& def) {
    model = build_cloth<double>(def);
    x = model.rest_positions;
    v.assign(x.size(), Vec3d::Zero());
    inertia.clear();
    air.clear();
    inverse_mass.clear();
    for (const double mass : model.mass) {
      inertia.push_back(mass * 3600);
      inverse_mass.push_back(1 / mass);
    }
  }
  NewtonPoint<double> point() const { return {x, v, 90, inertia, air.empty() ? nullptr : &air}; }
  std::size_t numbers() const { return 3 * x.size(); }

  template <class System>
  Eigen::VectorXd unpacked(const System& system, const GridVector<double>& from) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(numbers()));
    for (Index i = 0; i < model.particle_count(); ++i) {
      for (std::size_t d = 0; d < 3; ++d)
        out[3 * i + static_cast<Index>(d)] = from[system.places(i)[d]];
    }
    return out;
  }
  template <class System>
  GridVector<double> packed(const System& system, const Eigen::VectorXd& from) const {
    GridVector<double> out(system.size(), 0.0);
    for (Index i = 0; i < model.particle_count(); ++i) {
      for (std::size_t d = 0; d < 3; ++d)
        out[system.places(i)[d]] = from[3 * i + static_cast<Index>(d)];
    }
    return out;
  }
  /// The matrix of a system, column by column.
  template <class System>
  Eigen::MatrixXd matrix(const System& system) const {
    const auto n = static_cast<Eigen::Index>(numbers());
    Eigen::MatrixXd all(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const GridVector<double> p = packed(system, Eigen::VectorXd::Unit(n, k));
      GridVector<double> y(system.size(), 0.0);
      system.apply(p.data(), y.data());
      all.col(k) = unpacked(system, y);
    }
    return all;
  }
  /// 1 for the numbers of free particles.
  Eigen::VectorXd free() const {
    Eigen::VectorXd mask(static_cast<Eigen::Index>(numbers()));
    for (std::size_t i = 0; i < x.size(); ++i)
      mask.segment<3>(static_cast<Eigen::Index>(3 * i)).setConstant(inverse_mass[i] > 0 ? 1 : 0);
    return mask;
  }
};

Eigen::VectorXd some_vector(std::size_t count, Random& random) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(count));
  for (double& number : out) number = random.uniform(-1, 1);
  return out;
}

}  // namespace

TEST_CASE("a grid's forces and matrix are those spring by spring and stencil by stencil") {
  const auto [rows, columns] = GENERATE(table<int, int>({{2, 2}, {3, 7}, {8, 5}, {6, 19}}));
  SeededRandom random(7);

  Shaken cloth(rows, columns, random, 2);
  GridSystem<double> grid(cloth.model, cloth.model.parts[0]);
  ElementSystem<double> elements(cloth.model, cloth.model.parts[0]);
  grid.set_pinned(cloth.inverse_mass);
  elements.set_pinned(cloth.inverse_mass);
  cloth.model.parts[0].grid_springs->misfit = 0;  // as in a world of this solver
  Vec3Array<double> one(cloth.x.size(), Vec3d::Zero()), other = one, plain = one;
  grid.linearise(cloth.model, cloth.point(), one);
  elements.linearise(cloth.model, cloth.point(), other);
  add_spring_forces(cloth.model, cloth.x, cloth.v, plain);
  add_quadratic_bending_forces(cloth.model, cloth.x, plain);
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK((one[i] - plain[i]).norm() < 1e-9);
    CHECK((other[i] - plain[i]).norm() < 1e-9);
  }
  const Eigen::MatrixXd free = cloth.free().asDiagonal();
  const Eigen::MatrixXd a = free * cloth.matrix(grid) * free;
  const Eigen::MatrixXd b = free * cloth.matrix(elements) * free;
  CHECK((a - b).cwiseAbs().maxCoeff() < 1e-9 * a.cwiseAbs().maxCoeff());
  CHECK((a - a.transpose()).cwiseAbs().maxCoeff() < 1e-9 * a.cwiseAbs().maxCoeff());
}

TEST_CASE("in tension the matrix is the derivative of the forces") {
  SeededRandom random(7);
  Shaken cloth(5, 6, random, 0, 0.001);
  for (Vec3d& x : cloth.x) x *= 1.1;
  for (Vec3d& v : cloth.v) v.setZero();
  ElementSystem<double> system(cloth.model, cloth.model.parts[0]);
  system.set_pinned(cloth.inverse_mass);
  cloth.inertia.assign(cloth.x.size(), 0);
  cloth.air.clear();
  for (Spring<double>& spring : cloth.model.springs) spring.damping = 0;
  cloth.model.parts[0].grid_springs->misfit = 0;  // as in a world of this solver
  Vec3Array<double> unused(cloth.x.size(), Vec3d::Zero());
  system.linearise(cloth.model, cloth.point(), unused);
  const Eigen::MatrixXd matrix = cloth.matrix(system);
  const auto forces = [&](const Vec3Array<double>& x) {
    Vec3Array<double> force(x.size(), Vec3d::Zero());
    add_spring_forces(cloth.model, x, cloth.v, force);
    add_quadratic_bending_forces(cloth.model, x, force);
    return force;
  };
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < cloth.x.size(); i += 7) {
    for (int d = 0; d < 3; ++d) {
      Vec3Array<double> ahead = cloth.x, behind = cloth.x;
      ahead[i][d] += kStep;
      behind[i][d] -= kStep;
      const Vec3Array<double> more = forces(ahead), less = forces(behind);
      for (std::size_t j = 0; j < cloth.x.size(); ++j) {
        const Vec3d slope = (less[j] - more[j]) / (2 * kStep);
        for (int e = 0; e < 3; ++e)
          CHECK(matrix(static_cast<Eigen::Index>(3 * j) + e,
                       static_cast<Eigen::Index>(3 * i) + d) == Approx(slope[e]).margin(1e-3));
      }
    }
  }
}

TEST_CASE("the V-cycle is symmetric and positive definite on any m x n with pins anywhere") {
  const auto [rows, columns] =
      GENERATE(table<int, int>({{2, 2}, {2, 40}, {6, 6}, {7, 13}, {16, 17}, {23, 9}}));
  SeededRandom random(7);

  Shaken cloth(rows, columns, random, 3);
  GridSystem<double> system(cloth.model, cloth.model.parts[0]);
  system.set_pinned(cloth.inverse_mass);
  Vec3Array<double> unused(cloth.x.size(), Vec3d::Zero());
  system.linearise(cloth.model, cloth.point(), unused);
  const Eigen::VectorXd free = cloth.free();
  for (int k = 0; k < 5; ++k) {
    const Eigen::VectorXd a = some_vector(cloth.numbers(), random).cwiseProduct(free);
    const Eigen::VectorXd b = some_vector(cloth.numbers(), random).cwiseProduct(free);
    GridVector<double> za(system.size(), 0.0), zb = za;
    system.precondition(cloth.packed(system, a).data(), za.data());
    system.precondition(cloth.packed(system, b).data(), zb.data());
    const Eigen::VectorXd ma = cloth.unpacked(system, za), mb = cloth.unpacked(system, zb);
    CHECK(a.dot(mb) == Approx(b.dot(ma)).epsilon(1e-9));
    CHECK(a.dot(ma) > 0);
    CHECK(ma.cwiseProduct(Eigen::VectorXd::Ones(free.size()) - free).norm() == 0);
  }
}

TEST_CASE("conjugate gradients find the solution of the dense matrix, with either system") {
  SeededRandom random(7);

  Shaken cloth(9, 14, random, 4);
  const auto check = [&](auto&& system) {
    system.set_pinned(cloth.inverse_mass);
    Vec3Array<double> unused(cloth.x.size(), Vec3d::Zero());
    system.linearise(cloth.model, cloth.point(), unused);
    const Eigen::VectorXd free = cloth.free();
    const Eigen::VectorXd right = some_vector(cloth.numbers(), random).cwiseProduct(free);
    Eigen::MatrixXd matrix = free.asDiagonal() * cloth.matrix(system) * free.asDiagonal();
    matrix += (Eigen::VectorXd::Ones(free.size()) - free).asDiagonal();
    const Eigen::VectorXd expected = matrix.llt().solve(right);
    GridVector<double> r = cloth.packed(system, right), x(system.size()), p = x, q = x, z = x;
    const LinearSolution found = solve_linear(
        LinearVectors<double>{r.data(), x.data(), p.data(), q.data(), z.data(), system.size()},
        1e-10, 0.0, system.effort().iterations,
        [&](const double* from, double* to) { system.apply(from, to); },
        [&](const double* from, double* to) { system.precondition(from, to); });
    CHECK(found.solved);
    CHECK((cloth.unpacked(system, x) - expected).norm() < 1e-7 * expected.norm());
  };
  check(GridSystem<double>(cloth.model, cloth.model.parts[0]));
  check(ElementSystem<double>(cloth.model, cloth.model.parts[0]));
}

TEST_CASE("the factors of a small mesh's matrix solve it at once, old ones of the tick soon") {
  // A stiff strip, crumpled a little: the diagonal blocks alone take hundreds of iterations.
  SeededRandom random(7);
  ClothDef def = triangle_sheet(Cut::irregular, 0.25, 0.03, 0.005);
  def.fabric.stretch_warp = def.fabric.stretch_weft = 3000;
  def.fabric.shear = 300;
  def.fabric.bending_warp = def.fabric.bending_weft = 8e-3;
  Shaken cloth(2, 2, random, 0);
  cloth.become(def);
  for (Vec3d& x : cloth.x) x += random.vector(1e-4);
  cloth.inverse_mass[5] = 0;
  ElementSystem<double> system(cloth.model, cloth.model.parts[0]);
  system.set_pinned(cloth.inverse_mass);
  const Eigen::VectorXd right = some_vector(cloth.numbers(), random).cwiseProduct(cloth.free());
  const auto iterations = [&] {
    Vec3Array<double> unused(cloth.x.size(), Vec3d::Zero());
    system.linearise(cloth.model, cloth.point(), unused);
    GridVector<double> r = cloth.packed(system, right), x(system.size()), p = x, q = x, z = x;
    const LinearSolution found = solve_linear(
        LinearVectors<double>{r.data(), x.data(), p.data(), q.data(), z.data(), system.size()},
        1e-6, 0.0, 2000, [&](const double* from, double* to) { system.apply(from, to); },
        [&](const double* from, double* to) { system.precondition(from, to); });
    CHECK(found.solved);
    return found.iterations;
  };
  CHECK(iterations() <= 2);
  for (Vec3d& x : cloth.x) x += random.vector(1e-5);
  CHECK(iterations() <= 20);
}

TEST_CASE("the V-cycle's iterations hardly grow with the grid, those of block Jacobi do") {
  const auto [rigidity, stiffness] =
      GENERATE(table<double, double>({{1e-6, 1000}, {0.05, 2000}}));  // the second hardly bends
  const auto iterations = [rigidity = rigidity, stiffness = stiffness](int n, bool multigrid) {
    Random random(7);
    // The same square metre at each resolution, crumpled by a fiftieth of a cell.
    ClothDef def = flat_cloth(n, n, 1, 1);
    def.fabric.stretch_warp = def.fabric.stretch_weft = stiffness;
    def.fabric.shear = 100;
    def.fabric.bending_warp = def.fabric.bending_weft = rigidity;
    Shaken cloth(2, 2, random, 0);
    cloth.become(def);
    for (Vec3d& x : cloth.x) x[1] += random.uniform(-0.02, 0.02) / n;
    const auto run = [&](auto&& system) {
      system.set_pinned(cloth.inverse_mass);
      Vec3Array<double> unused(cloth.x.size(), Vec3d::Zero());
      system.linearise(cloth.model, cloth.point(), unused);
      GridVector<double> r = cloth.packed(system, some_vector(cloth.numbers(), random));
      GridVector<double> x(system.size()), p = x, q = x, z = x;
      return solve_linear(
                 LinearVectors<double>{r.data(), x.data(), p.data(), q.data(), z.data(),
                                       system.size()},
                 1e-3, 0.0, system.effort().iterations,
                 [&](const double* from, double* to) { system.apply(from, to); },
                 [&](const double* from, double* to) { system.precondition(from, to); })
          .iterations;
    };
    return multigrid ? run(GridSystem<double>(cloth.model, cloth.model.parts[0]))
                     : run(ElementSystem<double>(cloth.model, cloth.model.parts[0]));
  };
  const int coarse = iterations(17, true), fine = iterations(65, true);
  CHECK(fine <= 2 * coarse);
  CHECK(fine <= 30);
  CHECK(iterations(65, false) > 3 * fine);
  CHECK(iterations(64, true) <= 2 * fine);  // a last short cell on the second level
}
