#include <cassert>
// The second list of hard cases: ratios, ticks, forces and winds far beyond normal use.

#include <cmath>
#include <numbers>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/hard_cases.h"

namespace weft {
namespace {

FabricDef weave(double areal_density, double warp, double weft, double shear) {
  FabricDef fabric;
  fabric.areal_density = areal_density;
  fabric.stretch_warp = warp;
  fabric.stretch_weft = weft;
  fabric.shear = shear;
  return fabric;
}

/// Square sheets above each other and above a ball, each slightly offset.
void drop_on_ball(WorldDef& def, int particles, const std::vector<FabricDef>& fabrics) {
  assert(particles >= 2 && !fabrics.empty());
  def.cloths.clear();
  for (std::size_t k = 0; k < fabrics.size(); ++k) {
    const auto layer = static_cast<double>(k);
    ClothDef sheet = lying_cloth(particles, 0.6, 0.62 + 0.03 * layer);
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin += Vec3d(0.011 * layer, 0, 0.007 * layer);
    sheet.fabric = fabrics[k];
    def.cloths.push_back(sheet);
  }
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.4, 0), 0.2}}};
  def.environment.damping = 0.5;
}

void build_mass_ratio(WorldDef& def, const std::string&) {
  const FabricDef light = weave(0.05, 400, 400, 40), heavy = weave(50, 2e4, 2e4, 2e3);
  drop_on_ball(def, 21, {light, heavy, light});
  judge(def, 1);
}

void build_stiffness_ratio(WorldDef& def, const std::string&) {
  drop_on_ball(def, 15, {weave(0.2, 1e6, 1e6, 1e5), weave(0.1, 1, 1, 0.1)});
  judge(def, 10);
}

void build_warp_and_weft(WorldDef& def, const std::string&) {
  drop_on_ball(def, 15, {weave(0.1, 1e6, 1, 0.5), weave(0.1, 1, 1e6, 0.5)});
  judge(def, 10);
}

/// Two sheets on a ball, one lifted and dropped by a hand, in ticks of any length.
void drop_in_ticks(WorldDef& def, double ticks_a_second) {
  assert(ticks_a_second > 0);
  drop_on_ball(def, 21, {make_fabric("cotton"), make_fabric("silk")});
  HandDef hand;
  hand.cloth = "sheet0";  // the lower one
  hand.u = 0.1;
  hand.v = 0.2;
  hand.path = {{4, Vec3d::Zero()}, {6, Vec3d(0.3, 0.6, 0)}, {8, Vec3d(-0.4, 0.5, 0.3)}};
  def.hands = {hand};
  def.tick_rate = ticks_a_second;
  judge(def, 1);
}

void build_ticks_of_a_30th(WorldDef& def, const std::string&) {
  drop_in_ticks(def, 30);
}
void build_ticks_of_a_10th(WorldDef& def, const std::string&) {
  drop_in_ticks(def, 10);
}
void build_ticks_of_a_second(WorldDef& def, const std::string&) {
  drop_in_ticks(def, 1);
}

/// The cloth passes through itself, because it cannot leave a point otherwise; when it hangs again,
/// no crossing is left. Its rigidity leaves a single rest shape: without it, tucks would remain.
void build_point(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(33, 33, 1.0, 1.0, 1.6, 0);
  def.cloths[0].fabric.bending_warp = def.cloths[0].fabric.bending_weft = 4e-3;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.colliders = {ground()};
  def.environment.damping = 5;
  DisturbanceDef gather;
  gather.time = 2;
  gather.gather = 5e-4;
  def.disturbances = {gather};
  judge(def, 1000);  // the pinned row lies that far from the point
  def.verdict.clear_after = 7;
  def.verdict.rest_at = 2;
  def.verdict.back_by = 7;
}

void build_far_teleport(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(33, 33, 1.0, 1.0, 1.6, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};  // which leaves a single rest shape
  def.colliders = {ground()};
  def.environment.damping = 5;
  DisturbanceDef away, back;
  away.time = 2.5;
  away.pinned = Vec3d(0, 0, 10);
  back.time = 4;
  back.pinned = -away.pinned;
  away.pin_speed = back.pin_speed = 20;
  def.disturbances = {away, back};
  judge(def, 2);
  def.verdict.rest_at = 2.5;
  def.verdict.back_by = 9.5;
}

void build_meganewton(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(25, 25, 0.8, 0.8, 1.5, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 1.0, 0.25), 0.2}}};
  HandDef hand;
  hand.v = 0.6;
  hand.radius = 0.1;
  hand.stiffness = 1e5;
  hand.max_force = 1e6;
  hand.path = {{1, Vec3d::Zero()}, {2, Vec3d(0, 0, 1)}, {4, Vec3d(0, 0, -1)}, {5, Vec3d::Zero()}};
  def.hands = {hand};
  def.environment.damping = 1;
  judge(def, 20);  // less than a metre of cloth is led two metres through the ball
}

void build_pinch(WorldDef& def, const std::string&) {
  constexpr double kHalfRoot = 0.70710678118654752, kOpen = 0.06;
  def.cloths[0] = hanging_cloth(33, 33, 0.8, 0.8, 1.5, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.colliders = {ground()};
  GripperDef fingers;
  fingers.name = "fingers";
  fingers.centre = Vec3d(0.05, 1.0, 0);
  fingers.orientation = Eigen::Quaterniond(kHalfRoot, 0, kHalfRoot, 0);  // they close along z
  fingers.half_extents = Vec3d(0.008, 0.02, 0.008);
  fingers.opening = kOpen;
  fingers.force = 20;
  fingers.speed = 1;
  fingers.closing_speed = 0.3;
  const Vec3d out(0.2, 0.1, 0.4), across(-0.3, 0.2, -0.3);
  fingers.steps = {
      {0.5, Vec3d::Zero(), 0}, {1, out, 0},      {2, out, kOpen}, {3, Vec3d::Zero(), kOpen},
      {4, Vec3d::Zero(), 0},   {4.5, across, 0}, {5.5, out, 0},   {6.5, out, kOpen}};
  def.grippers = {fingers};
  def.environment.damping = 0.5;
  judge(def, 2);  // their friction is 16 N, over 2 cm of 400 N/m
}

void build_storm(WorldDef& def, const std::string&) {
  constexpr int kFlips = 120;
  def.cloths[0] = hanging_cloth(21, 31, 0.9, 0.6, 1.8, 0);
  def.cloths[0].origin = Vec3d(0.03, 1.8, 0);
  def.cloths[0].fabric = make_fabric("nylon");
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}};
  def.colliders = {ground(), {"pole", CapsuleDef{Vec3d(0, 0, 0), Vec3d(0, 1.95, 0), 0.02}}};
  const Vec3d storm(58, 0, 15);  // 60 m/s
  def.winds = {{1, storm}, {2.5, Vec3d::Zero()}, {3, storm}};
  for (int k = 0; k < kFlips; ++k)
    def.winds.push_back({4 + k / def.tick_rate, k % 2 == 0 ? Vec3d(-storm) : storm});
  def.winds.push_back({6, Vec3d(0, 0, -60)});
  def.winds.push_back({7, storm});
  def.winds.push_back({8, Vec3d::Zero()});
  judge(def, 3);
}

void build_ring(WorldDef& def, const std::string&) {
  constexpr int kRods = 16;
  constexpr double kWidth = 0.8, kThick = 0.01, kHeight = 0.8;
  constexpr double kCircle = kWidth / 4 + kThick;  // the hole is half as wide as the cloth
  def.cloths[0] = lying_cloth(33, kWidth, kHeight + 0.03);
  def.cloths[0].fabric = make_fabric("silk");
  def.colliders = {ground()};
  const auto at = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / kRods;
    return Vec3d(kCircle * std::cos(angle), kHeight, kCircle * std::sin(angle));
  };
  for (int k = 0; k < kRods; ++k)
    def.colliders.push_back({"ring" + std::to_string(k), CapsuleDef{at(k), at(k + 1), kThick}});
  HandDef hand;
  hand.path = {{1, Vec3d::Zero()}, {5, Vec3d(0, -0.75, 0)}, {6, Vec3d(0.2, -0.6, 0)}};
  hand.radius = 0.06;
  def.hands = {hand};
  def.environment.damping = 0.5;
  judge(def, 1);
}

}  // namespace

std::vector<SceneEntry> more_hard_cases() {
  return {
      {{"hard-mass-ratio",
        "A sheet of 50 kg/m² falls on one of 0.05 and another one on it: the light ones are "
        "neither crossed nor torn."},
       build_mass_ratio},
      {{"hard-stiffness-ratio",
        "A sheet of 1 N/m falls over one of a million: each keeps its own strain."},
       build_stiffness_ratio},
      {{"hard-warp-and-weft",
        "Two sheets that are a million times stiffer one way than the other lie crosswise: they "
        "flow down the ball and stay apart."},
       build_warp_and_weft},
      {{"hard-step-30th",
        "Two sheets on a ball in ticks of 1/30 s, one lifted by a hand: as in smaller ones."},
       build_ticks_of_a_30th},
      {{"hard-step-10th",
        "Two sheets on a ball in ticks of 1/10 s, one lifted by a hand: as in smaller ones."},
       build_ticks_of_a_10th},
      {{"hard-step-second",
        "Two sheets on a ball in ticks of a whole second, one lifted by a hand: nothing is missed "
        "between them."},
       build_ticks_of_a_second},
      {{"hard-point",
        "All of a cloth that hangs is put into a ball of one millimetre: it unfolds to where it "
        "was."},
       build_point},
      {{"hard-far-teleport",
        "The edge that holds a cloth moves 10 m away at 20 m/s and back: it follows in one piece."},
       build_far_teleport},
      {{"hard-meganewton",
        "A hand of up to a million newtons tears at a cloth through a ball: it stretches, and "
        "stays on its side."},
       build_meganewton},
      {{"hard-pinch",
        "Two fingers pinch a cloth, pull it about and let it go, twice: it comes off whole."},
       build_pinch},
      {{"hard-storm",
        "Wind of 60 m/s starts at once on a flag, stops, and changes its sign at each tick: it "
        "holds."},
       build_storm},
      {{"hard-ring",
        "A hand pulls a silk sheet through a ring half as wide: it gathers into folds and "
        "slips through."},
       build_ring}};
}

}  // namespace weft
