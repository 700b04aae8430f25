// Builds the textile tests.

#include "core/scenes/textile_scenes.h"

#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/drape.h"

namespace weft {
namespace {

// Small specimens just above the ground, so that they fill the picture.
constexpr double kHeight = 0.3;  // [m]
constexpr double kFloor = kHeight - 0.08;
const ColliderDef kGround{"ground", PlaneDef{Vec3d(0, kFloor, 0)}};

}  // namespace

void build_drape_test(WorldDef& def, const std::string&) {
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = 41;
  cloth.width = cloth.height = 2 * kDrapeSpecimenRadius;
  cloth.outline = Outline::ellipse;
  cloth.origin = Vec3d(-kDrapeSpecimenRadius, kHeight, -kDrapeSpecimenRadius);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("cotton");
  // The outermost particles of a pinned disc lie on average half a cell inside its radius, and the
  // fabric is clamped half a cell behind them: only strips clamp at their border.
  const double cell = cloth.width / (cloth.columns - 1);
  def.pins = {{MaterialPoint{0.5, 0.5}, kDrapeSupportRadius + cell, {}}};
  def.test = TextileTest::drape;
  def.colliders = {kGround};
  // A breath of air, a thousandth of the weight, determines where folds begin.
  def.environment.gust_speed = 0.05;
  def.environment.gust_length = 0.1;
  def.environment.damping = 4;
}

void build_cantilever_test(WorldDef& def, const std::string&) {
  constexpr double kCell = 0.0025;
  constexpr int kClamped = 10, kHanging = 24;  // columns, the last clamped one at x = 0
  ClothDef& cloth = def.cloths[0];
  cloth.columns = kClamped + kHanging;
  cloth.rows = 11;
  cloth.width = kCell * (cloth.columns - 1);
  cloth.height = kCell * (cloth.rows - 1);
  cloth.origin = Vec3d(-kCell * (kClamped - 1), kHeight, -cloth.height / 2);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("cotton");
  def.pins = {{EdgeStrip{Side::left, kCell * (kClamped - 1)}, 0, {}}};
  def.test = TextileTest::cantilever;
  // The platform ends short of the overhang, so that they never touch.
  constexpr double kEdge = -0.003, kTop = kHeight - 0.003;
  const Vec3d half(0.02, 0.5 * (kTop - kFloor), 0.02);
  const BoxDef platform{Vec3d(kEdge - half[0], kTop - half[1], 0), half,
                        Eigen::Quaterniond::Identity()};
  def.colliders = {kGround, {"platform", platform}};
  def.environment.damping = 10;
}

}  // namespace weft
