// The first list of hard cases: motion, shapes and starts that provoke crossings.

#include "core/scenes/hard_cases.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "core/cloth/fabric_presets.h"

namespace weft {
namespace {

using std::numbers::pi;

Eigen::Quaterniond turn(double angle, const Vec3d& axis) {
  assert(std::abs(axis.squaredNorm() - 1) < 1e-12);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

HandDef hand_at(double u, double v, std::vector<HandKey> path) {
  assert(u >= 0 && u <= 1 && v >= 0 && v <= 1);
  HandDef hand;
  hand.u = u;
  hand.v = v;
  hand.path = std::move(path);
  return hand;
}

/// The cloth hangs by two corners, and its flat shape is unstable: a breath at the start bends it.
void hang(WorldDef& def) {
  def.cloths[0] = hanging_cloth(33, 33, 1.0, 1.0, 1.6, 0);
  def.pins = {{Corner::top_left, 0.05, {}}, {Corner::top_right, 0.05, {}}};
  def.colliders = {ground()};
  def.environment.damping = 5;
}

void build_noise(WorldDef& def, const std::string&) {
  hang(def);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};  // which leaves a single rest shape
  def.disturbances = {{3, 20}, {4, 20}};
  judge(def, 3);
  def.verdict.rest_at = 3;
  def.verdict.back_by = 9;
}

void build_teleport(WorldDef& def, const std::string&) {
  hang(def);
  def.disturbances = {{0, 0.2}, {2.5, 0, Vec3d(0, 0, 3)}, {4.5, 0, Vec3d(0, 0, -3)}};
  judge(def, 1);
  def.verdict.rest_at = 2.5;
  def.verdict.back_by = 10;
}

void build_squeeze(WorldDef& def, const std::string&) {
  constexpr double kRadius = 0.15, kFar = 0.3, kNear = 0.1505;
  def.cloths[0] = hanging_cloth(33, 33, 0.8, 0.8, 1.5, 0);
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.colliders = {ground()};
  for (const double side : {-1.0, 1.0}) {
    const Vec3d closed(0, 0, side * (kNear - kFar));
    ColliderDef ball{side < 0 ? "back" : "front", SphereDef{Vec3d(0, 1.1, side * kFar), kRadius}};
    ball.motion.keyframes = {{0.5}, {1.5, closed}, {3, closed}, {4, Vec3d::Zero()}};
    ball.motion.interpolation = Interpolation::smooth;
    def.colliders.push_back(ball);
  }
  def.environment.damping = 1;
  judge(def, 0.5, 1);
}

void build_stack(WorldDef& def, const std::string&) {
  constexpr int kSheets = 10;
  def.cloths.clear();
  for (int k = 0; k < kSheets; ++k) {
    ClothDef sheet = lying_cloth(17, 0.5, 0.01 + 0.007 * k);
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin += Vec3d(0.004 * (k % 3), 0, 0.005 * (k % 2));
    sheet.fabric = make_fabric("cotton");
    def.cloths.push_back(sheet);
  }
  ColliderDef ball{"ball", SphereDef{Vec3d(0, 0.3, 0), 0.12}};
  const Vec3d pressed(0, -0.16, 0);
  ball.motion.keyframes = {{1}, {2, pressed}, {3.5, pressed}, {4.5, Vec3d::Zero()}};
  ball.motion.interpolation = Interpolation::smooth;
  def.colliders = {ground(), ball};
  def.environment.damping = 1;
  judge(def, 0.5, 1);
  def.verdict.rest_at = 1;
  def.verdict.back_by = 9.5;  // 5 s after the ball is lifted
  def.verdict.heights = 2 * def.cloths[0].fabric.thickness;
}

void build_needles(WorldDef& def, const std::string&) {
  constexpr double kHeight = 0.3, kSpacing = 0.12, kRadius = 0.004;
  def.cloths[0] = lying_cloth(33, 0.9, kHeight + 0.05);
  def.colliders = {ground()};
  for (int row = -3; row <= 3; ++row) {
    for (int column = -3; column <= 3; ++column) {
      const Vec3d foot(column * kSpacing, 0, row * kSpacing);
      def.colliders.push_back({"needle" + std::to_string(def.colliders.size()),
                               CapsuleDef{foot, foot + Vec3d(0, kHeight, 0), kRadius}});
    }
  }
  def.environment.damping = 0.5;
  judge(def, 0.5);
}

void build_knives(WorldDef& def, const std::string&) {
  def.cloths[0] = lying_cloth(33, 0.9, 0.4);
  def.colliders = {ground()};
  for (int k = -2; k <= 2; ++k)
    def.colliders.push_back({"knife" + std::to_string(k + 3),
                             BoxDef{Vec3d(0.17 * k, 0.15, 0), Vec3d(0.001, 0.15, 0.3)}});
  def.environment.damping = 0.5;
  judge(def, 0.5);
}

/// Bridson, Fedkiw, Anderson 2002: a rotating ball under a cloth drags it around on the floor.
void build_rotating_sphere(WorldDef& def, const std::string&) {
  constexpr double kPeriod = 4;
  def.cloths[0] = lying_cloth(41, 1.2, 0.68);
  def.cloths[0].fabric.friction = 0.6;
  ColliderDef ball{"ball", SphereDef{Vec3d(0, 0.33, 0), 0.3}};
  ball.motion.loop = true;
  for (int k = 0; k <= 4; ++k)
    ball.motion.keyframes.push_back(
        {1 + kPeriod / 4 * k, Vec3d::Zero(), turn(k * pi / 2, Vec3d::UnitY())});
  def.colliders = {ground(), ball};
  def.environment.damping = 0.3;
  judge(def, 0.5);
}

/// Hands turn one end of a strip by two and a half turns while the other end is held.
void build_twist(WorldDef& def, const std::string&) {
  constexpr double kLength = 0.8, kWidth = 0.3, kTurns = 2.5, kSeconds = 7;
  constexpr int kKeys = 40;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = 17;
  cloth.columns = 45;
  cloth.width = kLength;
  cloth.height = kWidth;
  cloth.origin = Vec3d(-kLength / 2, 1, -kWidth / 2);
  cloth.v = Vec3d::UnitZ();
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}};
  for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double z = (v - 0.5) * kWidth;
    HandDef hand = hand_at(1, v, {{0, Vec3d::Zero()}});
    for (int k = 0; k <= kKeys; ++k) {
      const double angle = 2 * pi * kTurns * k / kKeys;
      hand.path.push_back(
          {0.5 + kSeconds * k / kKeys, Vec3d(0, z * std::sin(angle), z * (std::cos(angle) - 1))});
    }
    hand.path.push_back({9.5, hand.path.back().offset});
    hand.radius = 0.04;
    hand.stiffness = 300;
    def.hands.push_back(hand);
  }
  def.colliders = {ground()};
  def.environment.damping = 1;
  judge(def, 1);
  def.verdict.hands_lag = kWidth / 10;  // no hand is stopped: the end turns with them
}

void build_funnel(WorldDef& def, const std::string&) {
  constexpr int kPlates = 10;
  constexpr double kSlope = 0.9, kHole = 0.08, kHalfLength = 0.3;
  def.cloths[0] = lying_cloth(41, 0.9, 1.15);
  def.cloths[0].fabric = make_fabric("silk");
  def.colliders = {ground()};
  const double middle = kHole + kHalfLength * std::cos(kSlope);
  for (int k = 0; k < kPlates; ++k) {
    const Eigen::Quaterniond around = turn(2 * pi * k / kPlates, Vec3d::UnitY());
    BoxDef plate;
    plate.centre = around * Vec3d(middle, 0.6 + kHalfLength * std::sin(kSlope), 0);
    plate.half_extents = Vec3d(kHalfLength, 0.005, 0.14);
    plate.orientation = around * turn(kSlope, Vec3d::UnitZ());
    def.colliders.push_back({"plate" + std::to_string(k), plate});
  }
  def.environment.damping = 0.3;
  judge(def, 0.5);
}

void build_tablecloth(WorldDef& def, const std::string&) {
  constexpr double kTop = 0.7;
  def.cloths[0] = lying_cloth(41, 1.2, kTop + 0.02);
  def.cloths[0].fabric = make_fabric("cotton");
  def.colliders = {ground(), {"top", BoxDef{Vec3d(0, kTop - 0.02, 0), Vec3d(0.4, 0.02, 0.4)}}};
  // Pulled away at 1, back at 2, away again at 8 m/s.
  const std::vector<HandKey> path = {{2, Vec3d::Zero()},
                                     {2.5, Vec3d(0.5, 0, 0)},
                                     {2.75, Vec3d::Zero()},
                                     {3, Vec3d(2, 0.2, 0)},
                                     {3.5, Vec3d(2, 0.2, 0)}};
  for (const double v : {0.2, 0.5, 0.8}) {
    def.hands.push_back(hand_at(1, v, path));
    def.hands.back().radius = 0.05;
  }
  def.environment.damping = 0.5;
  judge(def, 1);
}

void build_ten_hands(WorldDef& def, const std::string&) {
  constexpr int kHands = 10;
  constexpr double kPalm = 0.06;  // 50 N on one particle would be a singularity
  def.cloths[0] = lying_cloth(33, 0.8, 0.62);
  def.cloths[0].fabric = make_fabric("cotton");
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.4, 0), 0.2}}};
  for (int k = 0; k < kHands; ++k) {
    const double angle = 2 * pi * k / kHands;
    const Vec3d out(std::cos(angle), 0.4 * std::sin(3 * angle), std::sin(angle));
    HandDef hand = hand_at(0.5 + 0.4 * std::cos(angle), 0.5 + 0.4 * std::sin(angle), {});
    hand.path = {{1.5, Vec3d::Zero()}, {1.7, out},  {2.2, out},
                 {2.6, -out},          {3.2, -out}, {3.4, Vec3d::Zero()}};
    hand.radius = kPalm;
    def.hands.push_back(hand);
  }
  def.environment.damping = 0.5;
  judge(def, 2);
}

void build_start_inside(WorldDef& def, const std::string&) {
  def.cloths[0] = lying_cloth(33, 0.9, 0.3);
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.3, 0), 0.2}}};
  def.environment.damping = 1;
  judge(def, 1, 0.2, 4);
}

}  // namespace

void judge(WorldDef& def, double strain, double lost_motion, double clear_after) {
  assert(strain > 0 && strain <= 1000);
  assert(lost_motion >= 0 && lost_motion <= 1);
  assert(clear_after >= 0 && clear_after <= 3600);
  def.contact.seed.self = SelfContact::guard;
  def.verdict = {strain, lost_motion, clear_after, 0, 0};
}

std::vector<SceneEntry> hard_cases() {
  return {
      {{"hard-noise",
        "All particles of a hanging cloth get random velocities of up to 20 m/s, twice: it must "
        "come "
        "to rest again without crossing itself."},
       build_noise},
      {{"hard-teleport",
        "The corners that hold a cloth jump 3 m away and, two seconds later, back: it follows "
        "whole."},
       build_teleport},
      {{"hard-squeeze",
        "Two balls squeeze a hanging cloth to less than its thickness and let it go: they must "
        "lag."},
       build_squeeze},
      {{"hard-stack",
        "A ball presses ten sheets that lie on each other, and is lifted: none goes through the "
        "next, and each comes back to its height."},
       build_stack},
      {{"hard-needles",
        "A sheet falls on a bed of needles: it hangs between them, and none comes through."},
       build_needles},
      {{"hard-knives",
        "A sheet falls on five blades of two millimetres: it hangs over their edges."},
       build_knives},
      {{"hard-rotating-sphere",
        "A ball turns under a cloth: friction drags it round, and it winds itself on the floor."},
       build_rotating_sphere},
      {{"hard-twist",
        "Five hands turn the end of a strip by two turns and a half: it winds up, passes nothing "
        "and does not stop them."},
       build_twist},
      {{"hard-funnel",
        "A silk sheet falls into a funnel of ten plates: it crumples in the throat."},
       build_funnel},
      {{"hard-tablecloth",
        "Three hands pull a tablecloth at 1, 2 and 8 m/s: it slides off and through nothing."},
       build_tablecloth},
      {{"hard-ten-hands",
        "Ten hands pull a cloth over a ball in ten directions at 5 m/s, and back: it stays out."},
       build_ten_hands},
      {{"hard-start-inside",
        "A sheet starts halfway through a ball: it must come out within four seconds and stay "
        "out."},
       build_start_inside}};
}

}  // namespace weft
