// The built-in scenes, and the list of all of them.

#include "core/scenes/scenes.h"

#include <cassert>

#include "core/cloth/fabric_presets.h"
#include "core/error.h"
#include "core/scenes/hard_cases.h"
#include "core/scenes/scene_parts.h"
#include "core/scenes/seed_scenes.h"
#include "core/scenes/textile_scenes.h"
#include "core/scenes/views.h"

namespace weft {
namespace {

/// Pins discs along the edge v = 0, evenly from corner to corner.
void pin_along_top(WorldDef& def, int count, double radius) {
  assert(count >= 2 && radius >= 0);
  for (int k = 0; k < count; ++k)
    def.pins.push_back({MaterialPoint{static_cast<double>(k) / (count - 1), 0}, radius, {}});
}

/// Scenes of the same fabric are told apart by colour. @param color  "#rrggbb"
void dye(ClothDef& cloth, const std::string& color) {
  cloth.look = LookDef{LookOf::automatic, color, {}};
}

/// For scenes that come to rest once the air is still: cloth that has moved by at most half a
/// millimetre in three seconds sleeps until something acts on it.
void let_sleep(WorldDef& def) {
  def.sleep = {3, 5e-4};
}

/// The seed's default scene: ground, a static model of 1,418 faces, a cloth of 600 particles pinned
/// at six, three at each upper corner, gravity and wind.
void build_default(WorldDef& def, const std::string&) {
  // Warp down, weft across: 30 particles down the columns of the picture, 20 across.
  def.cloths[0].rows = 20;
  def.cloths[0].columns = 30;
  def.cloths[0].width = 1.45;
  def.cloths[0].height = 0.95;
  // Behind the form, so that the form is visible and the cloth reaches around it.
  def.cloths[0].origin = Vec3d(-0.475, 1.85, -0.28);
  def.cloths[0].u = -Vec3d::UnitY();
  def.cloths[0].v = Vec3d::UnitX();
  def.cloths[0].fabric.stretch_warp = def.cloths[0].fabric.stretch_weft = 250;
  def.cloths[0].fabric.shear = 25;
  for (const int row : {0, 1, 2, 17, 18, 19})
    def.pins.push_back({MaterialPoint{0, row / 19.0}, 0, {}});
  def.colliders = {ground(), {"form", mesh_object("dress-form", {}, {})}};
  def.environment.wind = Vec3d(0.3, 0, 1.7);
  def.environment.gust_speed = 0.9;
  def.environment.damping = 0.1;
  let_sleep(def);
}

void build_curtain(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(41, 33, 1.6, 2.0, 2.1, 0);
  dye(def.cloths[0], "#5f7a94");
  pin_along_top(def, 9, 0.02);
  def.colliders = {ground()};
  def.environment.wind = Vec3d(0.2, 0, 0.9);
  def.environment.gust_speed = 1.0;
  def.environment.damping = 0.1;
  let_sleep(def);
}

void build_flag(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(25, 37, 1.2, 0.8, 2.3, 0);
  def.cloths[0].origin = Vec3d(0.03, 2.3, 0);
  dye(def.cloths[0], "#b3202c");
  def.cloths[0].fabric.areal_density = 0.1;
  def.pins = {{Corner::top_left, 0.05, {}},
              {MaterialPoint{0, 0.5}, 0.05, {}},
              {Corner::bottom_left, 0.05, {}}};
  def.colliders = {ground(), {"pole", CapsuleDef{Vec3d(0, 0, 0), Vec3d(0, 2.45, 0), 0.02}}};
  def.environment.wind = Vec3d(5, 0, 0.6);
  def.environment.gust_speed = 1.5;
  let_sleep(def);
}

void build_drape_sphere(WorldDef& def, const std::string&) {
  def.cloths[0].rows = def.cloths[0].columns = 49;
  def.cloths[0].width = def.cloths[0].height = 1.3;
  def.cloths[0].origin = Vec3d(-0.65, 1.15, -0.65);
  def.cloths[0].v = Vec3d::UnitZ();
  dye(def.cloths[0], "#7d5a86");
  def.colliders = {ground(), {"sphere", SphereDef{Vec3d(0, 0.7, 0), 0.32}}};
  def.environment.damping = 0.5;
  let_sleep(def);
}

void build_wall(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(25, 25, 1.0, 1.0, 1.6, 0.15);
  dye(def.cloths[0], "#6f8a4f");
  pin_along_top(def, 7, 0.02);
  def.colliders = {
      ground(),
      {"wall", BoxDef{Vec3d(0, 0.9, -0.1), Vec3d(1.2, 0.9, 0.1), Eigen::Quaterniond::Identity()}}};
  def.environment.damping = 0.3;
  let_sleep(def);
}

BoxDef upright_box(const Vec3d& centre, const Vec3d& half_extents) {
  return {centre, half_extents, Eigen::Quaterniond::Identity()};
}

void build_table(WorldDef& def, const std::string&) {
  constexpr double kTop = 0.74, kHalfTop = 0.02, kLeg = 0.03;
  const Vec3d half_top(0.5, kHalfTop, 0.35);
  def.cloths[0] = lying_cloth(49, 1.5, kTop + 0.1);
  def.cloths[0].height = 1.2;
  def.cloths[0].rows = 41;
  def.cloths[0].origin[2] = -0.6;
  def.cloths[0].fabric = make_fabric("cotton");
  def.colliders = {ground(), {"top", upright_box(Vec3d(0, kTop - kHalfTop, 0), half_top)}};
  const double half_leg = (kTop - 2 * kHalfTop) / 2;
  for (const double x : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0})
      def.colliders.push_back(
          {"leg", upright_box(Vec3d(x * (half_top[0] - kLeg), half_leg, z * (half_top[2] - kLeg)),
                              Vec3d(kLeg, half_leg, kLeg))});
  }
  def.environment.damping = 0.5;
  let_sleep(def);
}

void build_hammock(WorldDef& def, const std::string&) {
  constexpr double kLength = 2.0, kWidth = 0.8, kHeight = 1.2;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = 25;
  cloth.columns = 61;
  cloth.width = kLength;
  cloth.height = kWidth;
  cloth.origin = Vec3d(-kLength / 2, kHeight, -kWidth / 2);
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric("wool");
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  // Each end hangs a centimetre in front of a bar across its post.
  const double bar = kLength / 2 + 0.03, post = kLength / 2 + 0.06, half = kWidth / 2 + 0.04;
  def.colliders = {
      ground(),
      {"left-post", CapsuleDef{Vec3d(-post, 0, 0), Vec3d(-post, 1.4, 0), 0.04}},
      {"right-post", CapsuleDef{Vec3d(post, 0, 0), Vec3d(post, 1.4, 0), 0.04}},
      {"left-bar", CapsuleDef{Vec3d(-bar, kHeight, -half), Vec3d(-bar, kHeight, half), 0.02}},
      {"right-bar", CapsuleDef{Vec3d(bar, kHeight, -half), Vec3d(bar, kHeight, half), 0.02}}};
  def.environment.damping = 0.5;
  let_sleep(def);
}

void build_two_flags(WorldDef& def, const std::string&) {
  constexpr double kWidth = 0.9, kHeight = 0.6, kTop = 1.8, kAbove = 0.15;
  constexpr double kApart = 1.02;  // so that neither flag reaches the other's pole
  def.cloths.clear();
  def.colliders = {ground()};
  for (const auto& [name, x] : {std::pair("silk", 0.0), std::pair("denim", kApart)}) {
    ClothDef flag = hanging_cloth(21, 31, kWidth, kHeight, kTop, 0);
    flag.name = name;
    flag.origin = Vec3d(x + 0.03, kTop, 0);
    flag.fabric = make_fabric(name);
    def.cloths.push_back(flag);
    for (const Corner corner : {Corner::top_left, Corner::bottom_left})
      def.pins.push_back({corner, 0.05, name});
    const CapsuleDef pole{Vec3d(x, 0, 0), Vec3d(x, kTop + kAbove, 0), 0.02};
    def.colliders.push_back({name + std::string("-pole"), pole});
  }
  def.environment.wind = Vec3d(1.8, 0, 0.3);
  def.environment.gust_speed = 0.4;
  let_sleep(def);
}

void build_drop_on_bunny(WorldDef& def, const std::string& mesh_directory) {
  def.cloths[0] = lying_cloth(49, 1.3, 0.85);
  def.cloths[0].fabric = make_fabric("silk");
  MeshPlacement placement;
  placement.scale = 0.08;  // ten units high: 0.77 m
  def.colliders = {ground(), {"bunny", mesh_object("bunny", mesh_directory, placement)}};
  def.environment.damping = 0.5;
  let_sleep(def);
}

void build_fan(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(37, 31, 1.2, 1.5, 1.9, 0);
  def.cloths[0].fabric = make_fabric("silk");
  dye(def.cloths[0], "#8c3f63");
  pin_along_top(def, 7, 0.02);
  def.colliders = {ground()};
  FanDef fan;  // at the right, so that the view from the left shows its direction
  fan.position = Vec3d(0.95, 0.8, 0.6);
  fan.direction = Vec3d(-0.8, 0.05, -0.6);
  fan.speed = 4;
  def.environment.fans = {fan};
  let_sleep(def);
}

/// A board that turns once in five seconds, with a sheet on it.
void build_turntable(WorldDef& def, const std::string&) {
  constexpr double kTop = 0.6, kPeriod = 5;
  def.cloths[0] = lying_cloth(41, 1.1, kTop + 0.02);
  def.cloths[0].fabric = make_fabric("cotton");
  ColliderDef board{"board", upright_box(Vec3d(0, kTop - 0.02, 0), Vec3d(0.32, 0.02, 0.32))};
  board.motion.loop = true;
  constexpr double kHalfRoot = 0.70710678118654752;
  // Quarter turns; a half turn would not determine its direction.
  const Eigen::Quaterniond turns[] = {{1, 0, 0, 0},
                                      {kHalfRoot, 0, kHalfRoot, 0},
                                      {0, 0, 1, 0},
                                      {-kHalfRoot, 0, kHalfRoot, 0},
                                      {-1, 0, 0, 0}};
  for (int k = 0; k < 5; ++k)
    board.motion.keyframes.push_back({kPeriod / 4 * k, Vec3d::Zero(), turns[k]});
  // The sheet hides the board: below its hem one sees what that stands on.
  const ColliderDef post{"post", CapsuleDef{Vec3d(0, 0.05, 0), Vec3d(0, kTop - 0.08, 0), 0.03}};
  const ColliderDef foot{"foot", upright_box(Vec3d(0, 0.015, 0), Vec3d(0.17, 0.015, 0.17))};
  def.colliders = {ground(), board, post, foot};
  def.environment.damping = 0.1;
}

/// A ball under a sheet that rises at up to 1 m/s, waits, and comes down.
void build_lift_sphere(WorldDef& def, const std::string&) {
  def.cloths[0] = lying_cloth(41, 1.2, 0.43);
  def.cloths[0].fabric = make_fabric("silk");
  dye(def.cloths[0], "#b98a2f");
  ColliderDef ball{"ball", SphereDef{Vec3d(0, 0.2, 0), 0.2}};
  ball.motion.interpolation = Interpolation::smooth;
  ball.motion.loop = true;
  const Vec3d lifted(0, 0.8, 0);
  ball.motion.keyframes = {{}, {1.5}, {2.7, lifted}, {4.5, lifted}, {6, Vec3d::Zero()}};
  def.colliders = {ground(), ball};
  def.environment.damping = 0.3;
}

/// A cloth lies on a table and overhangs its edge, where jaws grasp, lift and hold it.
void build_gripper(WorldDef& def, const std::string&) {
  constexpr double kTop = 0.3, kHalf = 0.25, kOver = 0.08;
  def.cloths[0] = lying_cloth(33, 2 * kHalf, kTop + 0.01);
  def.cloths[0].origin[0] += kOver;
  def.cloths[0].fabric = make_fabric("denim");
  GripperDef gripper;
  gripper.centre = Vec3d(kHalf + 0.03, kTop + 0.002, 0);
  constexpr double kHalfRoot = 0.70710678118654752;
  gripper.orientation = Eigen::Quaterniond(kHalfRoot, 0, 0, kHalfRoot);  // closes along y
  gripper.half_extents = Vec3d(0.006, 0.02, 0.025);
  gripper.opening = 0.08;
  gripper.steps = {{0, Vec3d::Zero(), 0.08}, {1, Vec3d::Zero(), 0}, {2.5, Vec3d(0, 0.6, 0), 0}};
  def.grippers = {gripper};
  def.colliders = {ground(),
                   {"table", upright_box(Vec3d(0, kTop / 2, 0), Vec3d(kHalf, kTop / 2, kHalf))}};
  def.environment.damping = 0.5;
}

std::vector<SceneEntry> own_scenes() {
  return {
      {{"default",
        "A cloth hung by six particles is blown from behind against a dressmaker's form: watch it "
        "wrap the back and reach round the hips."},
       build_default},
      {{"curtain", "A curtain on nine rings sways in gusts: pull its hem and let it swing."},
       build_curtain},
      {{"flag", "A flag on a pole flutters in strong wind: turn the wind down and see it droop."},
       build_flag},
      {{"drape-sphere",
        "A square cloth falls on a sphere and drapes into folds: friction decides where it stays."},
       build_drape_sphere},
      {{"wall",
        "A cloth hangs before a wall: pull it through as hard as you like, it stays on its side."},
       build_wall},
      {{"table",
        "A tablecloth falls on a table and hangs over its edges: the corners fall in folds beside "
        "the legs."},
       build_table},
      {{"hammock",
        "A hammock of wool sags between two posts: push it and watch the wave run from end to "
        "end."},
       build_hammock},
      {{"two-flags",
        "Silk and denim on two poles in the same wind: the light flag streams, the heavy one "
        "hangs."},
       build_two_flags},
      {{"drop-on-bunny",
        "A silk sheet falls over a rabbit: ears and back show through as the folds settle.",
        "bunny"},
       build_drop_on_bunny},
      {{"fan",
        "A fan blows at one side of a silk curtain in calm air: drag it by its hub, aim it by its "
        "arrow, and see where the jet ends."},
       build_fan},
      {{"turntable",
        "A cotton sheet rides on a turning board: friction carries it, and its corners swing out."},
       build_turntable},
      {{"lift-sphere",
        "A ball rises under a silk sheet, holds it up and sinks: the sheet slides and never lets "
        "it through."},
       build_lift_sphere},
      {{"gripper",
        "A gripper closes on a cloth where it hangs over a table, lifts it and holds it: open it, "
        "or "
        "close it with less force, and see it slip."},
       build_gripper},
      {{"drape-test",
        "Cusick's drape test, a round cloth of 30 cm on a disc of 18 cm: read its drape "
        "coefficient and count its folds."},
       build_drape_test},
      {{"cantilever-test",
        "The bending test, a strip that hangs 6 cm over an edge: read its bending length from the "
        "droop."},
       build_cantilever_test},
      {{"decay-test",
        "A strip of 4 cm is bent by a hand and let go in empty space: read the damping of its "
        "fabric from how the swing dies."},
       build_decay_test}};
}

const std::vector<SceneEntry>& entries() {
  static const std::vector<SceneEntry> list = [] {
    std::vector<SceneEntry> all = own_scenes();
    for (const SceneEntry& entry : hard_cases()) all.push_back(entry);
    for (const SceneEntry& entry : more_hard_cases()) all.push_back(entry);
    for (const SceneEntry& entry : tangled_cases()) all.push_back(entry);
    for (const SceneEntry& entry : folding_cases()) all.push_back(entry);
    for (const SceneEntry& entry : seed_scenes()) all.push_back(entry);
    return all;
  }();
  return list;
}

}  // namespace

const std::vector<SceneInfo>& scenes() {
  static const std::vector<SceneInfo> list = [] {
    std::vector<SceneInfo> infos;
    for (const SceneEntry& entry : entries()) infos.push_back(entry.info);
    return infos;
  }();
  return list;
}

WorldDef make_scene(const std::string& name, const std::string& mesh_directory) {
  std::string names;
  for (const SceneEntry& entry : entries()) {
    names += (names.empty() ? "" : ", ") + entry.info.name;
    if (entry.info.name != name) continue;
    WorldDef def;
    def.name = entry.info.name;
    def.description = entry.info.description;
    def.view = view_of_scene(name);
    entry.build(def, mesh_directory);
    return def;
  }
  throw DefinitionError("scene", name, "one of " + names);
}

}  // namespace weft
