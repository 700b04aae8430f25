#include "core/cloth/stability_bound.h"

#include <catch2/catch.hpp>

#include "core/attachments/clamp_line.h"
#include "core/forces/force_pass.h"
#include "tests/support/cloths.h"

using namespace weft;
using test::Random;

namespace {

/// Highest squared frequency of the linearised forces at rest, by power iteration on M^-1 K.
template <class AddForces>
double highest_omega2(const ClothModel<double>& model, AddForces&& add_forces) {
  Random random(11);
  Vec3Array<double> direction = test::random_velocities(model, 1, random);
  double omega2 = 0;
  constexpr double kSize = 1e-7;
  for (int iteration = 0; iteration < 400; ++iteration) {
    double norm = 0;
    for (const Vec3d& p : direction) norm += p.squaredNorm();
    Vec3Array<double> x = model.rest_positions, f(x.size(), Vec3d::Zero()), g = f;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += direction[i] * (kSize / std::sqrt(norm));
    add_forces(x, f);
    add_forces(model.rest_positions, g);
    double next = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      direction[i] = (g[i] - f[i]) / (kSize * model.mass[i]);
      next += direction[i].squaredNorm();
    }
    omega2 = std::sqrt(next);
  }
  return omega2;
}

}  // namespace

TEST_CASE("the largest stable substep is (sqrt(1 + zeta^2) - zeta) 2/omega") {
  for (const double zeta : {0.0, 0.05, 0.7, 3.0}) {
    const double omega = 321;
    const StabilityBound bound{omega * omega, 2 * zeta * omega};
    CHECK(largest_stable_substep(bound) ==
          Approx((std::sqrt(1 + zeta * zeta) - zeta) * 2 / omega).epsilon(1e-12));
  }
  CHECK(std::isinf(largest_stable_substep({0, 0})));
  CHECK(substeps_for({0, 0}, 1.0 / 60, 3) == 3);
  CHECK(substeps_for({1e30, 0}, 1.0 / 60, 1) > kMostSubsteps);
}

TEST_CASE("leapfrog with lagged damping is stable up to the rule and unstable beyond it") {
  const double omega = 40, zeta = 0.05;
  const double limit = largest_stable_substep({omega * omega, 2 * zeta * omega});
  const auto size_after = [&](double dt) {
    double x = 1, v = 0;
    for (int n = 0; n < 4000; ++n) {
      v += dt * (-omega * omega * x - 2 * zeta * omega * v);
      x += dt * v;
    }
    return std::abs(x);
  };
  CHECK(size_after(0.999 * limit) < 1);
  CHECK(size_after(1.001 * limit) > 10);
}

TEST_CASE("the bending bound counts the stiff hinges at clamps, and not more than three times") {
  ClothDef def = test::flat_cloth(9, 12);
  def.fabric.bending_warp = def.fabric.bending_weft = 1e-3;
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  ClothModel<double> model = build_cloth<double>(def);
  const double membrane = model.parts[0].bounds.membrane_omega2;
  REQUIRE_FALSE(set_clamps({{{0, Side::top, 3, 8}, {0, Side::right, 9, 4}}, {}}, model).empty());
  stiffen_hinges(0, model);
  renew_bending_bounds(0, model);
  const Vec3Array<double> still(model.mass.size(), Vec3d::Zero());
  const double bending = highest_omega2(model, [&](const auto& x, auto& f) {
    add_hinge_forces(model, x, still, f);
    add_quadratic_bending_forces(model, x, f);
  });
  CHECK(model.parts[0].bounds.bending_omega2 >= bending);
  CHECK(model.parts[0].bounds.bending_omega2 <= 3 * bending);
  CHECK(model.parts[0].bounds.membrane_omega2 == membrane);
}

TEST_CASE(
    "the model's bounds are above the highest frequencies, the membrane's with a margin, and not "
    "more than twice that") {
  const auto [rows, columns, height] =
      GENERATE(table<int, int, double>({{12, 12, 1.0}, {9, 17, 1.0}, {10, 10, 0.5}}));
  ClothDef def = test::flat_cloth(rows, columns, 1, height);
  def.fabric.bending_warp = def.fabric.bending_weft = 1e-3;
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  const ClothModel<double> model = build_cloth<double>(def);
  const Vec3Array<double> still(model.mass.size(), Vec3d::Zero());
  const double stretch =
      highest_omega2(model, [&](const auto& x, auto& f) { add_spring_forces(model, x, still, f); });
  const double bending = highest_omega2(model, [&](const auto& x, auto& f) {
    add_hinge_forces(model, x, still, f);
    add_quadratic_bending_forces(model, x, f);
  });
  constexpr double kMargin = 1.15;  // for what was crushed; see laws/shaking_test.cpp
  CHECK(model.parts[0].bounds.membrane_omega2 >= kMargin * stretch);
  CHECK(model.parts[0].bounds.membrane_omega2 <= kMargin * 2 * stretch);
  CHECK(model.parts[0].bounds.bending_omega2 >= bending);
  CHECK(model.parts[0].bounds.bending_omega2 <= 2 * bending);
}
