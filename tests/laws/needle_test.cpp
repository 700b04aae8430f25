#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "tests/laws/bending_matrix.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// The bending of flat meshes with needles: triangles much lower than what lies around them.

using namespace weft;
using test::Cut;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRigidity = 1e-5;           // [N m]
constexpr double kWidth = 1, kHeight = 0.8;  // [m]
constexpr double kEdge = 0.05;               // about, of what is not a needle [m]

/// Cuts every 7th triangle in three by a particle beside the middle of one of its edges, of the
/// sheet's border too.
/// @param height  of the needle there, over the triangle's [1]
ClothDef with_particles_beside_edges(ClothDef def, double height) {
  TriangleMesh& mesh = def.mesh->mesh;
  const std::vector<Triangle> whole = mesh.triangles;
  mesh.triangles.clear();
  for (std::size_t t = 0; t < whole.size(); ++t) {
    const auto [a, b, c] = whole[t];
    if (t % 7 != 3) {
      mesh.triangles.push_back(whole[t]);
      continue;
    }
    const auto at = [&](Index i) { return mesh.positions[static_cast<std::size_t>(i)]; };
    const auto uv = [&](Index i) { return def.mesh->uv[static_cast<std::size_t>(i)]; };
    const auto near = static_cast<Index>(mesh.positions.size());
    const double ends = 0.5 * (1 - height);
    mesh.positions.push_back(ends * (at(a) + at(b)) + height * at(c));
    def.mesh->uv.push_back({ends * (uv(a)[0] + uv(b)[0]) + height * uv(c)[0],
                            ends * (uv(a)[1] + uv(b)[1]) + height * uv(c)[1]});
    for (const Triangle& part : {Triangle{a, b, near}, Triangle{b, c, near}, Triangle{c, a, near}})
      mesh.triangles.push_back(part);
  }
  return def;
}

/// Moves one row of particles close to the row above, so that a strip of needles lies between.
/// @param height  of the strip, over that of a row [1]
ClothDef with_low_row(ClothDef def, double height) {
  const double upper = std::round(0.5 * kHeight / kEdge) * kEdge;
  for (std::size_t i = 0; i < def.mesh->uv.size(); ++i) {
    double& y = def.mesh->mesh.positions[i][1];
    if (std::abs(-y - upper - kEdge) < 0.3 * kEdge) y += (1 - height) * kEdge;
    def.mesh->uv[i][1] = -y;
  }
  return def;
}

ClothDef sheet(Cut cut) {
  ClothDef def = test::triangle_sheet(cut, kWidth, kHeight, kEdge);
  def.fabric.bending_warp = def.fabric.bending_weft = kRigidity;
  return def;
}

std::vector<ClothDef> sheets_with_particles_beside_edges(double height) {
  std::vector<ClothDef> sheets;
  for (const Cut cut : test::kCuts)
    sheets.push_back(with_particles_beside_edges(sheet(cut), height));
  return sheets;
}

std::vector<ClothDef> sheets_with_low_rows(double height) {
  return {with_low_row(sheet(Cut::one_diagonal), height),
          with_low_row(sheet(Cut::alternating), height)};
}

std::vector<ClothDef> sheets_with_needles(double height) {
  std::vector<ClothDef> sheets = sheets_with_particles_beside_edges(height);
  for (const ClothDef& sheet : sheets_with_low_rows(height)) sheets.push_back(sheet);
  return sheets;
}

double largest_link(const ClothModel<double>& model) {
  double largest = 0;
  for (const BendingLink& link : model.parts[0].bending_links)
    largest = std::max(largest, std::abs(link.weight));
  return largest;
}

double largest_regular_link() {
  double largest = 0;
  for (const Cut cut : test::kCuts)
    largest = std::max(largest, largest_link(build_cloth<double>(sheet(cut))));
  return largest;
}

/// Largest error of the energy of a sheet that is rolled in any direction, over the continuum's.
double rolled_error(const ClothModel<double>& model) {
  constexpr double kRadius = 0.5;
  double worst = 0;
  for (int k = 0; k < 8; ++k) {
    const double c = std::cos(k * kPi / 8), s = std::sin(k * kPi / 8);
    Vec3Array<double> x = model.rest_positions;
    for (Vec3d& p : x) {
      const double turn = (c * p[0] + s * p[1]) / kRadius, across = -s * p[0] + c * p[1];
      p = Vec3d(kRadius * std::sin(turn), across, kRadius * (1 - std::cos(turn)));
    }
    const double whole = 0.5 * kRigidity / (kRadius * kRadius) * kWidth * kHeight;
    worst = std::max(worst, std::abs(elastic_energy(model, x).bending / whole - 1));
  }
  return worst;
}

}  // namespace

TEST_CASE("a needle bends as what lies around it, however low it is") {
  const double regular = largest_regular_link();
  for (const double height : {1e-2, 1e-4, 1e-6}) {
    for (const ClothDef& def : sheets_with_particles_beside_edges(height)) {
      const ClothModel<double> model = build_cloth<double>(def);
      INFO("height " << height << ": link " << largest_link(model) / regular << ", rolled "
                     << rolled_error(model));
      CHECK(model.hinges.empty());
      CHECK(largest_link(model) < 4 * regular);
      CHECK(rolled_error(model) < 0.004);
    }
  }
}

TEST_CASE("so does a needle that the rounding of a file has turned over") {
  const double regular = largest_regular_link();
  for (const ClothDef& def : sheets_with_particles_beside_edges(-1e-6)) {
    const ClothModel<double> model = build_cloth<double>(def);
    INFO("link " << largest_link(model) / regular << ", rolled " << rolled_error(model));
    CHECK_FALSE(model.parts[0].curved_at_rest);
    CHECK(largest_link(model) < 4 * regular);
    CHECK(rolled_error(model) < 0.004);
    const Eigen::VectorXd modes =
        test::bending_matrix(model).selfadjointView<Eigen::Lower>().eigenvalues();
    CHECK(std::abs(modes[2]) < 1e-6 * modes[3]);
  }
}

TEST_CASE("a pillow that lies flat is at rest there, folded along its border, and stays") {
  // Two layers sewn along the border. Inside, their particles are 3 mm apart.
  constexpr Index kSide = 9;
  ClothMesh pillow;
  std::array<std::vector<Index>, 2> layer;
  for (Index i = 0; i < kSide * kSide; ++i) {
    const Index r = i / kSide, c = i % kSide;
    const bool border = std::min(r, c) == 0 || std::max(r, c) == kSide - 1;
    for (std::size_t k = 0; k < 2; ++k) {
      if (k == 1 && border) {
        layer[1].push_back(layer[0].back());
        continue;
      }
      layer[k].push_back(static_cast<Index>(pillow.mesh.positions.size()));
      const double aside = k == 1 ? 0.003 : 0;
      pillow.mesh.positions.emplace_back(0.02 * c + aside, 0.02 * r + aside, 0);
    }
  }
  for (Index i = 0; i + kSide < kSide * kSide; ++i) {
    if (i % kSide == kSide - 1) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = [&](Index n) { return layer[k][static_cast<std::size_t>(n)]; };
      // The corners' cells are cut such that no triangle is in both layers.
      const bool rising = (i / kSide < kSide / 2) == (i % kSide < kSide / 2);
      const Index a = at(i), b = at(i + 1), d = at(i + kSide), e = at(i + kSide + 1);
      std::array<Triangle, 2> cell = {Triangle{a, b, e}, Triangle{a, e, d}};
      if (!rising) cell = {Triangle{a, b, d}, Triangle{b, e, d}};
      for (Triangle& t : cell) {
        if (k == 1) std::swap(t[1], t[2]);
        pillow.mesh.triangles.push_back(t);
      }
    }
  }
  ClothDef def = sheet(Cut::one_diagonal);
  def.mesh = pillow;
  const ClothModel<double> model = build_cloth<double>(def);
  CHECK(model.hinges.empty());
  CHECK(model.parts[0].curved_at_rest);
  CHECK(largest_link(model) < 20 * largest_regular_link());
  CHECK(std::abs(elastic_energy(model, model.rest_positions).bending) < 1e-12);
  World<float> world(test::empty_world(def));
  const Vec3Array<float> start = world.state().x;
  for (int k = 0; k < 60; ++k) world.step();
  for (std::size_t i = 0; i < start.size(); ++i)
    REQUIRE((world.state().x[i] - start[i]).norm() < 1e-4F);
}

TEST_CASE("the links of a low row of triangles grow as 1 / height, no faster") {
  // Its particles differ by slope times height, and its area is as its height.
  const double regular = largest_regular_link();
  for (const double height : {1e-1, 1e-2, 1e-3}) {
    for (const ClothDef& def : sheets_with_low_rows(height)) {
      const ClothModel<double> model = build_cloth<double>(def);
      INFO("height " << height << ": link " << largest_link(model) / regular << ", rolled "
                     << rolled_error(model));
      CHECK(largest_link(model) < 0.5 * regular / height);
      CHECK(rolled_error(model) < 0.004);
    }
  }
}

TEST_CASE("only what is flat has no energy where needles are") {
  for (const ClothDef& def : sheets_with_needles(1e-4)) {
    const Eigen::MatrixXd matrix = test::bending_matrix(build_cloth<double>(def));
    const Eigen::VectorXd modes = matrix.selfadjointView<Eigen::Lower>().eigenvalues();
    INFO(modes.head(5).transpose());
    CHECK(std::abs(modes[2]) < 1e-6 * modes[3]);
  }
}

TEST_CASE("a flat mesh with needles stays where it is in single precision, far away too") {
  for (const double away : {0.0, 100.0}) {
    for (ClothDef def : sheets_with_needles(1e-3)) {
      def.fabric.bending_warp = def.fabric.bending_weft = 1e-3;
      for (Vec3d& p : def.mesh->mesh.positions) p[0] += away;
      World<float> world(test::empty_world(def));
      const Vec3Array<float> start = world.state().x;
      for (int k = 0; k < 60; ++k) world.step();
      float moved = 0;
      for (std::size_t i = 0; i < start.size(); ++i)
        moved = std::max(moved, (world.state().x[i] - start[i]).norm());
      INFO(away << " m away: moved by " << moved << " m");
      CHECK(moved < (away > 0 ? 1e-3F : 1e-4F));
    }
  }
}
