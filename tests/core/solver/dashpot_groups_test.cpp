#include "core/solver/dashpot_groups.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/diagnostics/energies.h"
#include "core/solver/dashpot_kernels.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

using namespace weft;
using test::SeededRandom;

namespace {

constexpr double kTime = 0.3;  // of relaxation [s]

/// Grids, one with an outline in steps, and meshes.
std::vector<ClothDef> sheets() {
  std::vector<ClothDef> all = {test::flat_cloth(9, 8, 1, 0.8), test::flat_cloth(7, 9, 0.9, 1)};
  all.back().outline = Outline::ellipse;
  for (const test::Cut cut : test::kCuts) all.push_back(test::triangle_sheet(cut, 1, 0.8, 0.13));
  for (ClothDef& sheet : all) {
    sheet.fabric.bending_warp = 1e-2;
    sheet.fabric.bending_weft = 3e-2;
    sheet.fabric.bending_damping = kTime;
  }
  return all;
}

struct Group {
  const DashpotFamily<double>& family;
  std::size_t batch, lane;

  std::size_t particle(std::size_t slot) const {
    return family.particle(family.places[(batch * family.slots + slot) * family.kLanes + lane]);
  }
  double weight(std::size_t k, std::size_t slot) const {
    const std::size_t row = k * family.slots + slot;
    if (!family.of_triangles) return family.weights[row];
    return family.weights[(batch * family.curvatures * family.slots + row) * family.kLanes + lane];
  }
  double viscosity(std::size_t k) const {
    return family.viscosity[(batch * family.curvatures + k) * family.kLanes + lane];
  }
  Vec3d value(std::size_t k, const Vec3Array<double>& x) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t n = 0; n < family.slots; ++n) sum += weight(k, n) * x[particle(n)];
    return sum;
  }
  /// Along the normal.
  double curvature(std::size_t k, const Vec3Array<double>& x) const {
    const bool triangle = family.of_triangles;
    const Vec3d e = x[particle(1)] - x[particle(0)],
                f = x[particle(triangle ? 2 : 3)] - x[particle(triangle ? 0 : 2)];
    return e.cross(f).normalized().dot(value(k, x));
  }
};

void for_each_group(const std::vector<DashpotFamily<double>>& families, auto&& visit) {
  for (const DashpotFamily<double>& family : families) {
    for (std::size_t batch = 0; batch < family.batches; ++batch) {
      for (std::size_t lane = 0; lane < family.kLanes; ++lane) visit(Group{family, batch, lane});
    }
  }
}

/// Where component k of a particle's vector is in four numbers each, as families read it.
std::size_t at(bool of_triangles, std::size_t particles, std::size_t i, std::size_t k) {
  return of_triangles ? 4 * i + k : k * particles + i;
}

/// K v.
Vec3Array<double> product(std::vector<DashpotFamily<double>>& families, const Vec3Array<double>& x,
                          const Vec3Array<double>& v) {
  const bool of_triangles = families.front().of_triangles;
  const auto laid_out = [&](const Vec3Array<double>& vectors) {
    std::vector<double> numbers(4 * vectors.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        numbers[at(of_triangles, vectors.size(), i, k)] = vectors[i][static_cast<Eigen::Index>(k)];
    }
    return numbers;
  };
  const std::vector<double> places = laid_out(x), speeds = laid_out(v);
  std::vector<double> sum(places.size());
  for (DashpotFamily<double>& family : families) {
    const DashpotRun all{0, family.batches, true};
    aim_dashpots(all, places.data(), family);
    multiply_dashpots(all, speeds.data(), 0, x.size(), family, sum.data());
  }
  Vec3Array<double> vectors(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      vectors[i][static_cast<Eigen::Index>(k)] = sum[at(of_triangles, x.size(), i, k)];
  }
  return vectors;
}

/// Gently bent, so that nothing counts as crumpled.
Vec3Array<double> bent(const ClothModel<double>& model, SeededRandom& random) {
  Vec3Array<double> x = test::shaken(model, 1e-4, random);
  for (Vec3d& p : x) p[1] += 0.03 * std::sin(3 * p[0]) * std::cos(2 * p[2]);
  return x;
}

}  // namespace

TEST_CASE("damped stencils are those of the bending energy, each in one group") {
  SeededRandom random(3);
  for (const ClothDef& sheet : sheets()) {
    const ClothModel<double> model = build_cloth<double>(sheet);
    const auto families = dashpot_families(model, model.parts[0]);
    const Vec3Array<double> x = test::shaken(model, 0.05, random);
    double sum = 0;
    for_each_group(families, [&](const Group& group) {
      for (std::size_t k = 0; k < group.family.curvatures; ++k)
        sum += group.viscosity(k) * group.value(k, x).squaredNorm();
    });
    CHECK(sum == Approx(2 * kTime * elastic_energy(model, x).bending).epsilon(1e-9));
  }
}

TEST_CASE("groups take tau k (db/dt)^2 of each curvature b, by finite differences, to 1e-6") {
  SeededRandom random(4);
  for (const ClothDef& sheet : sheets()) {
    const ClothModel<double> model = build_cloth<double>(sheet);
    auto families = dashpot_families(model, model.parts[0]);
    const Vec3Array<double> x = bent(model, random);
    const Vec3Array<double> v = test::random_velocities(model, 1, random);
    constexpr double kStep = 1e-6;
    Vec3Array<double> ahead = x, back = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      ahead[i] += kStep * v[i];
      back[i] -= kStep * v[i];
    }
    double expected = 0;
    for_each_group(families, [&](const Group& group) {
      for (std::size_t k = 0; k < group.family.curvatures; ++k) {
        const double rate = (group.curvature(k, ahead) - group.curvature(k, back)) / (2 * kStep);
        expected += group.viscosity(k) * rate * rate;
      }
    });
    const Vec3Array<double> forces = product(families, x, v);
    double taken = 0;
    for (std::size_t i = 0; i < x.size(); ++i) taken += v[i].dot(forces[i]);
    CHECK(taken == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("forces of dashpots are symmetric: u K v = v K u, to 1e-12") {
  SeededRandom random(5);
  for (const ClothDef& sheet : sheets()) {
    const ClothModel<double> model = build_cloth<double>(sheet);
    auto families = dashpot_families(model, model.parts[0]);
    const Vec3Array<double> x = test::shaken(model, 0.01, random);
    const Vec3Array<double> u = test::random_velocities(model, 1, random),
                            v = test::random_velocities(model, 1, random);
    const Vec3Array<double> by_v = product(families, x, v), by_u = product(families, x, u);
    double uv = 0, vu = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      uv += u[i].dot(by_v[i]);
      vu += v[i].dot(by_u[i]);
      size += by_v[i].norm();
    }
    CHECK(size > 0);
    CHECK(std::abs(uv - vu) < 1e-12 * size);
  }
}

TEST_CASE("nearly all stencils of a grid lie in batches of neighbours in a row") {
  ClothDef sheet = test::flat_cloth(64, 64);
  sheet.fabric.bending_damping = kTime;
  const ClothModel<float> model = build_cloth<float>(sheet);
  const auto families = dashpot_families(model, model.parts[0]);
  REQUIRE(families.size() == 2);
  for (const DashpotFamily<float>& family : families) {
    std::size_t in_rows = 0;
    for (std::size_t batch = 0; batch < family.batches; ++batch) {
      if (family.in_rows[batch] == 0) continue;
      ++in_rows;
      for (std::size_t n = 0; n < family.slots * family.kLanes; ++n) {
        const std::uint32_t* const place = &family.places[batch * family.slots * family.kLanes + n];
        if (n % family.kLanes > 0) REQUIRE(*place == place[-1] + 1);
        REQUIRE(*place < model.mass.size());
      }
    }
    CHECK(10 * in_rows >= 9 * family.batches);
  }
}
