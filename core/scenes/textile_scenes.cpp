// Builds the textile tests.

#include "core/scenes/textile_scenes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/drape.h"

namespace weft {
namespace {

// Small specimens just above the ground, so that they fill the picture.
constexpr double kHeight = 0.3;  // [m]
constexpr double kFloor = kHeight - 0.08;
const ColliderDef kGround{"ground", PlaneDef{Vec3d(0, kFloor, 0)}};

/// All of the drape test but the specimen.
void set_drape_test(WorldDef& def, double pinned_radius) {
  def.pins = {{MaterialPoint{0.5, 0.5}, pinned_radius, {}}};
  def.test = TextileTest::drape;
  def.colliders = {kGround};
  // A breath of air, a thousandth of the weight, determines where folds begin.
  def.environment.gust_speed = 0.05;
  def.environment.gust_length = 0.1;
  def.environment.damping = 4;
}

void set_grid_specimen(WorldDef& def, int side) {
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = side;
  cloth.width = cloth.height = 2 * kDrapeSpecimenRadius;
  cloth.outline = Outline::ellipse;
  cloth.origin = Vec3d(-kDrapeSpecimenRadius, kHeight, -kDrapeSpecimenRadius);
  cloth.v = Vec3d::UnitZ();
  set_drape_test(def, kDrapeSupportRadius);
}

/// Joins a ring of particles to the next one outside, each edge to the nearest particle across.
/// @param inner,outer  first particles of the rings; a ring of one is the middle
void join_rings(Index inner, int inner_count, Index outer, int outer_count, TriangleMesh& mesh) {
  int i = 0, o = 0;
  const int all = (inner_count > 1 ? inner_count : 0) + outer_count;
  for (int k = 0; k < all; ++k) {
    const Index a = inner + i % inner_count, b = outer + o % outer_count;
    const double next_inner = (i + 1.0) / inner_count, next_outer = (o + 1.0) / outer_count;
    const bool outwards =
        inner_count == 1 || i == inner_count || (o < outer_count && next_outer <= next_inner);
    const Index c = outwards ? outer + (o + 1) % outer_count : inner + (i + 1) % inner_count;
    mesh.triangles.push_back({a, c, b});
    ++(outwards ? o : i);
  }
}

/// A disc of rings around its middle, facing up, each ring as fine as it is far from the next.
ClothMesh ringed_disc(const std::vector<double>& radii) {
  assert(radii.size() > 1 && radii.front() > 0);
  constexpr double kTurn = 2 * 3.14159265358979323846;
  ClothMesh disc;
  const auto add = [&disc](double x, double z) {
    disc.mesh.positions.emplace_back(x, kHeight, z);
    disc.uv.push_back({x, z});
  };
  add(0, 0);
  Index inner = 0;
  int inner_count = 1;
  for (std::size_t r = 0; r < radii.size(); ++r) {
    const double gap = r == 0 ? radii[0] : radii[r] - radii[r - 1];
    const int count = std::max(6, static_cast<int>(std::lround(kTurn * radii[r] / gap)));
    const Index outer = static_cast<Index>(disc.mesh.positions.size());
    for (int k = 0; k < count; ++k)
      add(radii[r] * std::cos(kTurn * k / count), radii[r] * std::sin(kTurn * k / count));
    join_rings(inner, inner_count, outer, count, disc.mesh);
    inner = outer;
    inner_count = count;
  }
  return disc;
}

}  // namespace

void build_drape_test(WorldDef& def, const std::string&) {
  constexpr int kSide = 41;
  set_grid_specimen(def, kSide);
  def.cloths[0].fabric = make_fabric("cotton");
}

WorldDef drape_test_on_grid(const FabricDef& fabric, int side) {
  assert(side >= 11 && side <= 401);
  WorldDef def;
  set_grid_specimen(def, side);
  def.cloths[0].fabric = fabric;
  return def;
}

WorldDef drape_test_on_rings(const FabricDef& fabric, int rings) {
  assert(rings >= 2 && rings <= 100);
  // Fabric that is held at a ring is clamped half a gap behind it.
  const double gap = (kDrapeSpecimenRadius - kDrapeSupportRadius) / (rings + 0.5);
  const double held = kDrapeSupportRadius + gap / 2;
  const int inside = static_cast<int>(std::lround(held / gap));
  std::vector<double> radii;
  for (int k = 1; k <= inside; ++k) radii.push_back(held * k / inside);
  for (int k = 1; k <= rings; ++k) radii.push_back(held + gap * k);
  WorldDef def;
  def.cloths[0].mesh = ringed_disc(radii);
  def.cloths[0].fabric = fabric;
  set_drape_test(def, held + gap / 4);
  return def;
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

void build_decay_test(WorldDef& def, const std::string&) {
  constexpr double kCell = 0.0025;
  constexpr int kClamped = 4, kFree = 16;  // cells
  ClothDef& cloth = def.cloths[0];
  cloth.columns = kClamped + kFree + 1;
  cloth.rows = 17;
  cloth.width = kCell * (kClamped + kFree);
  cloth.height = kCell * (cloth.rows - 1);
  // At height 0, where floats resolve the least displacement of a limp strip in a substep.
  cloth.origin = Vec3d(-kCell * kClamped, 0, -cloth.height / 2);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("cotton");
  def.pins = {{EdgeStrip{Side::left, kCell * kClamped}, 0, {}}};
  def.test = TextileTest::decay;
  // Neither weight nor air takes part: what is lost is lost in the fabric.
  def.environment.gravity = Vec3d::Zero();
  HandDef hand;
  hand.u = 1;
  hand.radius = 0.02;
  constexpr double kLift = 0.005, kLifted = 0.3, kLetGo = 0.6;  // [m], [s]
  hand.path = {{0, Vec3d::Zero()}, {kLifted, Vec3d(0, kLift, 0)}, {kLetGo, Vec3d(0, kLift, 0)}};
  def.hands = {hand};
}

}  // namespace weft
