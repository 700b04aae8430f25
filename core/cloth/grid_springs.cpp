// Springs of a grid from the fabric's stiffness tensor.

#include "core/cloth/grid_springs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"

namespace weft {
namespace {

/// Relative error of a limit that is told with nine digits.
constexpr double kLimitRounding = 1e-8;

/// A spring from each particle to (row + dr, column + dc), where that exists.
struct Pattern {
  SpringKind kind;
  int dr, dc;
  double stiffness, damping;
  bool half_on_border;
};

bool on_border(const ClothDef& def, int row, int column, const Pattern& p) {
  if (!p.half_on_border) return false;
  return p.dr == 0 ? (row == 0 || row == def.rows - 1) : (column == 0 || column == def.columns - 1);
}

std::vector<Pattern> patterns(const ClothDef& def) {
  const double cell_u = def.width / (def.columns - 1);
  const double cell_v = def.height / (def.rows - 1);
  using enum SpringKind;
  if (def.direct_springs) {
    const DirectSprings& d = *def.direct_springs;
    return {
        {warp, 0, 1, d.structural, d.dashpot, false}, {weft, 1, 0, d.structural, d.dashpot, false},
        {shear, 1, 1, d.shear, d.dashpot, false},     {shear, 1, -1, d.shear, d.dashpot, false},
        {skip, 0, 2, d.skip, d.dashpot, false},       {skip, 2, 0, d.skip, d.dashpot, false}};
  }
  const GridStiffness k = grid_stiffness(def.fabric, cell_u, cell_v);
  const double s = def.skip_stiffness;
  return {{warp, 0, 1, k.warp, 0, true},    {weft, 1, 0, k.weft, 0, true},
          {shear, 1, 1, k.shear, 0, false}, {shear, 1, -1, k.shear, 0, false},
          {skip, 0, 2, s, 0, true},         {skip, 2, 0, s, 0, true}};
}

}  // namespace

GridStiffness grid_stiffness(const FabricDef& fabric, double cell_u, double cell_v) {
  assert(cell_u > 0 && cell_v > 0);
  const double ratio = cell_u / cell_v;
  GridStiffness k;
  k.warp = (fabric.stretch_warp - fabric.shear * ratio * ratio) / ratio;
  k.weft = (fabric.stretch_weft - fabric.shear / (ratio * ratio)) * ratio;
  k.shear = fabric.shear * (cell_u * cell_u + cell_v * cell_v) / (2 * cell_u * cell_v);
  const double of_warp = fabric.stretch_warp / (ratio * ratio),
               of_weft = fabric.stretch_weft * ratio * ratio;
  const double most = std::min(of_warp, of_weft);
  // The told limit is rounded, and as it is told it is allowed.
  if (fabric.shear > most * (1 + kLimitRounding)) {
    const std::string told = rounded_text(most, 9);
    throw DefinitionError("fabric.shear", number_text(fabric.shear),
                          "0 to " + told + " N/m for cells of this shape",
                          "lower the shear stiffness or make the cells squarer")
        .with(Range{0, std::stod(told)}, {of_warp < of_weft ? "stretch_warp" : "stretch_weft",
                                          of_warp < of_weft ? "stretch_weft" : "stretch_warp"});
  }
  k.warp = std::max(0.0, k.warp);
  k.weft = std::max(0.0, k.weft);
  return k;
}

double misfit_stiffness(const GridStiffness& springs, double cell_u, double cell_v) {
  assert(cell_u > 0 && cell_v > 0);
  if (!(springs.warp > 0 && springs.weft > 0 && springs.shear > 0)) return 0;
  const double u2 = cell_u * cell_u, v2 = cell_v * cell_v, d2 = u2 + v2;
  // The weights of q: 1 for each diagonal, 2 a for the mean of two sides.
  const double give = 2 / (springs.shear * d2) + 4 * u2 / (springs.warp * d2 * d2) +
                      4 * v2 / (springs.weft * d2 * d2);
  return 1 / give;
}

SpringTimes grid_spring_times(const FabricDef& fabric, double cell_u, double cell_v, double least) {
  assert(cell_u > 0 && cell_v > 0 && least >= 0);
  const double ratio2 = cell_u * cell_u / (cell_v * cell_v);
  const double stretch = std::max(fabric.stretch_damping, least),
               shear = std::max(fabric.shear_damping, least);
  // C11 of the dashpots is tau Y_w, of which the diagonals have their share.
  const auto left = [&](double stiffness, double share) {
    const double springs = stiffness - share;
    if (stretch == shear || !(springs > 0)) return stretch;
    return std::max((stretch * stiffness - shear * share) / springs, least);
  };
  return {left(fabric.stretch_warp, fabric.shear * ratio2),
          left(fabric.stretch_weft, fabric.shear / ratio2), shear};
}

template <class Real>
std::vector<Spring<Real>> grid_springs(const ClothDef& def, std::vector<SpringKind>& kinds) {
  const double cell_u = def.width / (def.columns - 1);
  const double cell_v = def.height / (def.rows - 1);
  const std::vector<Pattern> all = patterns(def);
  std::vector<Spring<Real>> springs;
  kinds.clear();
  for (int row = 0; row < def.rows; ++row) {
    for (int column = 0; column < def.columns; ++column) {
      for (const Pattern& p : all) {
        const int r = row + p.dr, c = column + p.dc;
        if (r >= def.rows || c < 0 || c >= def.columns) continue;
        const double share = on_border(def, row, column, p) ? 0.5 : 1.0;
        if (p.stiffness == 0 && p.damping == 0) continue;
        Spring<Real> spring;
        spring.i = row * def.columns + column;
        spring.j = r * def.columns + c;
        spring.rest_length = static_cast<Real>(std::hypot(p.dc * cell_u, p.dr * cell_v));
        spring.stiffness = static_cast<Real>(share * p.stiffness);
        spring.damping = static_cast<Real>(share * p.damping);
        assert(spring.rest_length > 0 && spring.stiffness >= 0 && spring.damping >= 0);
        springs.push_back(spring);
        kinds.push_back(p.kind);
      }
    }
  }
  return springs;
}

template std::vector<Spring<float>> grid_springs(const ClothDef&, std::vector<SpringKind>&);
template std::vector<Spring<double>> grid_springs(const ClothDef&, std::vector<SpringKind>&);

}  // namespace weft
