#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "tests/support/cloths.h"

using namespace weft;

namespace {

/// Effective bending rigidity of a sheet rolled onto a cylinder of curvature kappa whose curved
/// direction is at angle phi from the warp: twice the energy per area and kappa^2, from a patch so
/// large that its border does not matter.
double rolled_rigidity(ClothDef def, double phi) {
  def.fabric.shear = 0;
  const ClothModel<double> model = build_cloth<double>(def);
  constexpr double kCurvature = 0.02;  // small against one over the cell
  const auto rolled = [&](int columns, int rows) {
    ClothDef part = def;
    part.rows = rows;
    part.columns = columns;
    part.width = def.width * (columns - 1) / (def.columns - 1);
    part.height = def.height * (rows - 1) / (def.rows - 1);
    const ClothModel<double> m = build_cloth<double>(part);
    Vec3Array<double> x(m.mass.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double u = m.material[i][0], v = m.material[i][1];
      const double along = u * std::cos(phi) + v * std::sin(phi);
      const double across = -u * std::sin(phi) + v * std::cos(phi);
      x[i] = Vec3d(std::sin(kCurvature * along) / kCurvature,
                   (1 - std::cos(kCurvature * along)) / kCurvature, across);
    }
    return elastic_energy(m, x).bending;
  };
  // Energy of one more period of the pattern in both directions, by differences: no border effects.
  const int c = def.columns, r = def.rows;
  const double energy = rolled(c + 2, r + 2) - rolled(c, r + 2) - rolled(c + 2, r) + rolled(c, r);
  const double area = 4 * static_cast<double>(model.parts[0].cell_u * model.parts[0].cell_v);
  return 2 * energy / (area * kCurvature * kCurvature);
}

}  // namespace

TEST_CASE(
    "a sheet rolled in any direction has bending rigidity B, to 1 %, for square and 1:2 cells") {
  ClothDef def = test::flat_cloth(9, 9);
  const double height = GENERATE(1.0, 2.0, 0.5);
  def.height = height;
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  def.fabric.bending_warp = def.fabric.bending_weft = 1e-3;
  for (int degrees = 0; degrees < 180; degrees += 15)
    CHECK(rolled_rigidity(def, degrees * 3.14159265358979 / 180) == Approx(1e-3).epsilon(0.01));
}

TEST_CASE("warp and weft rigidities differ where the fabric says so") {
  ClothDef def = test::flat_cloth(9, 9);
  def.bending_model = GENERATE(BendingModel::hinges, BendingModel::quadratic);
  def.fabric.bending_warp = 3e-3;
  def.fabric.bending_weft = 1e-3;
  CHECK(rolled_rigidity(def, 0) == Approx(3e-3).epsilon(0.01));
  CHECK(rolled_rigidity(def, 1.5707963267949) == Approx(1e-3).epsilon(0.01));
}
