#include "core/cloth/cloth_model.h"

#include <set>

#include <catch2/catch.hpp>

#include "core/cloth/grid_springs.h"
#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/cloths.h"

using namespace weft;

namespace {

/// Energy per area of an affine deformation with small strains (u_x, v_y, shear angle) in a large
/// patch without borders, from one interior cell's share of the springs.
double energy_density(const FabricDef& fabric, double hu, double hv, double eu, double ev,
                      double g) {
  const GridStiffness k = grid_stiffness(fabric, hu, hv);
  const double d = std::hypot(hu, hv);
  const auto stretch = [&](double du, double dv, double length) {
    return (eu * du * du + ev * dv * dv + g * du * dv) / length;  // linearised elongation
  };
  const auto half = [](double stiffness, double e) { return 0.5 * stiffness * e * e; };
  return (half(k.warp, stretch(hu, 0, hu)) + half(k.weft, stretch(0, hv, hv)) +
          half(k.shear, stretch(hu, hv, d)) + half(k.shear, stretch(hu, -hv, d))) /
         (hu * hv);
}

}  // namespace

TEST_CASE(
    "the springs' continuum limit is C11 = Y_w, C22 = Y_f, C12 = C66 = G for any cell shape") {
  FabricDef fabric;
  fabric.stretch_warp = 900;
  fabric.stretch_weft = 500;
  fabric.shear = 60;
  const auto [hu, hv] = GENERATE(table<double, double>({{0.1, 0.1}, {0.1, 0.2}, {0.05, 0.04}}));
  const auto w = [&, u = hu, v = hv](double eu, double ev, double g) {
    return energy_density(fabric, u, v, eu, ev, g);
  };
  CHECK(2 * w(1, 0, 0) == Approx(900));
  CHECK(2 * w(0, 1, 0) == Approx(500));
  CHECK(2 * w(0, 0, 1) == Approx(60));
  CHECK(w(1, 1, 0) - w(1, 0, 0) - w(0, 1, 0) == Approx(60));
  CHECK(w(1, 0, 1) - w(1, 0, 0) - w(0, 0, 1) == Approx(0).margin(1e-9));
}

TEST_CASE("a shear stiffness that would need springs that push is refused by name") {
  ClothDef def = test::flat_cloth(3, 11);  // cells of 0.1 x 0.5 m
  def.fabric.shear = 100;
  try {
    build_cloth<float>(def);
    FAIL("accepted");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "fabric.shear");
    CHECK_FALSE(error.hint.empty());
  }
}

TEST_CASE("the masses add up to areal density times area; borders have half, corners a quarter") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(7, 9, 1.2, 0.8));
  double sum = 0;
  for (const double m : model.mass) sum += m;
  CHECK(sum == Approx(0.2 * 1.2 * 0.8).epsilon(1e-12));
  CHECK(model.mass[0] == Approx(model.mass[10] / 4));
  CHECK(model.mass[1] == Approx(model.mass[10] / 2));
  ClothDef equal = test::flat_cloth(7, 9);
  equal.mass_lumping = MassLumping::equal;
  for (const double m : build_cloth<double>(equal).mass) CHECK(m == Approx(0.2 / 63));
}

TEST_CASE("a grid of any size has the edges of its triangles and both ways' hinges, each once") {
  const auto [rows, columns] = GENERATE(table<int, int>({{2, 2}, {2, 7}, {5, 4}, {20, 30}}));
  ClothDef def = test::flat_cloth(rows, columns);
  def.bending_model = BendingModel::hinges;
  def.fabric.shear = 0;
  const ClothModel<float> model = build_cloth<float>(def);
  const int cells = (rows - 1) * (columns - 1);
  const int axis_edges = rows * (columns - 1) + columns * (rows - 1);
  CHECK(model.particle_count() == rows * columns);
  CHECK(model.triangles.size() == static_cast<std::size_t>(2 * cells));
  CHECK(model.edges.size() == static_cast<std::size_t>(axis_edges + cells));
  const int border = 2 * (rows - 1) + 2 * (columns - 1);
  CHECK(model.hinges.size() == 2 * static_cast<std::size_t>(axis_edges + cells - border));
  CHECK(std::set<Edge>(model.edges.begin(), model.edges.end()).size() == model.edges.size());
  Vec3f up =
      (model.rest_positions[1] - model.rest_positions[0])
          .cross(model.rest_positions[static_cast<std::size_t>(columns)] - model.rest_positions[0]);
  for (const Triangle& t : model.triangles) {
    const auto at = [&](std::size_t k) {
      return model.rest_positions[static_cast<std::size_t>(t[k])];
    };
    CHECK((at(1) - at(0)).cross(at(2) - at(0)).dot(up) > 0);
  }
}

TEST_CASE("a disc has the particles within its radius in the fabric, at least its centre") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(11, 11));  // h = 0.1
  CHECK(particles_in_disc(model, 60, 0) == std::vector<Index>{60});
  CHECK(particles_in_disc(model, 60, 0.1001) == std::vector<Index>{49, 59, 60, 61, 71});
  CHECK(particles_in_disc(model, 0, 0.15) == std::vector<Index>{0, 1, 11, 12});
}

TEST_CASE("definitions out of range are refused with field, value and limit") {
  const auto refused_field = [](auto&& change) {
    ClothDef def = test::flat_cloth(4, 4);
    change(def);
    try {
      build_cloth<float>(def);
    } catch (const DefinitionError& error) {
      CHECK_FALSE(error.limit.empty());
      return error.field;
    }
    return std::string("accepted");
  };
  const double nan = std::nan("");
  CHECK(refused_field([](ClothDef& d) { d.rows = 1; }) == "cloth.rows");
  CHECK(refused_field([](ClothDef& d) { d.columns = 5000; }) == "cloth.columns");
  CHECK(refused_field([&](ClothDef& d) { d.width = nan; }) == "cloth.width");
  CHECK(refused_field([&](ClothDef& d) { d.origin[2] = nan; }) == "cloth.origin[2]");
  CHECK(refused_field([](ClothDef& d) { d.u = Vec3d::Zero(); }) == "cloth.u");
  CHECK(refused_field([](ClothDef& d) { d.v = d.u; }) == "cloth.v");
  CHECK(refused_field([](ClothDef& d) { d.fabric.areal_density = 0; }) == "fabric.areal_density");
  CHECK(refused_field([](ClothDef& d) { d.fabric.stretch_warp = -1; }) == "fabric.stretch_warp");
  CHECK(refused_field([](ClothDef& d) {
          d.rest_angle = 0.2;
          d.bending_model = BendingModel::quadratic;
        }) == "cloth.bending_model");
}
