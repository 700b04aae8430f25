#include "core/scenes/textile_scenes.h"

#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/drape.h"

namespace weft {

void build_drape_test(WorldDef& def, const std::string&) {
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 41;
  cloth.width = cloth.height = 2 * kDrapeSpecimenRadius;
  cloth.outline = Outline::ellipse;
  cloth.origin = Vec3d(-kDrapeSpecimenRadius, 0.3, -kDrapeSpecimenRadius);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("cotton");
  // The outermost pinned particles lie half a cell inside the pin's radius in the mean, and the
  // fabric is clamped half a cell behind them.
  const double cell = cloth.width / (cloth.columns - 1);
  def.pins = {{MaterialPoint{0.5, 0.5}, kDrapeSupportRadius + cell, {}}};
  def.test = TextileTest::drape;
  def.colliders = {{"ground", PlaneDef{}}};
  // A breath of air, a thousandth of the weight, decides where the folds begin.
  def.environment.gust_speed = 0.05;
  def.environment.gust_length = 0.1;
  def.environment.drag = 4;
}

void build_cantilever_test(WorldDef& def, const std::string&) {
  constexpr double kCell = 0.0025, kOverhang = 0.06;
  ClothDef& cloth = def.cloths[0];
  cloth.columns = 26;
  cloth.rows = 11;
  cloth.width = kCell * (cloth.columns - 1);
  cloth.height = kCell * (cloth.rows - 1);
  cloth.origin = Vec3d(kOverhang - cloth.width, 0.3, -cloth.height / 2);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("cotton");
  def.pins = {{EdgeStrip{Side::left, 1.5 * kCell}, 0, {}}};
  def.test = TextileTest::cantilever;
  def.colliders = {{"ground", PlaneDef{}}};
  def.environment.drag = 10;
}

}  // namespace weft
