#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/scene_parts.h"
#include "core/scenes/scenes.h"
#include "core/world/verdict.h"
#include "tests/support/random.h"

// Nothing passes through, and that is not by freezing: what is pressed comes back, what is folded
// unfolds, what is twisted turns, and what falls falls in the same time as without contact.

using namespace weft;
using namespace weft::test;

namespace {

/// The same sheet as a mesh of random triangles.
void make_mesh(ClothDef& cloth, unsigned seed) {
  Random random(seed);
  ClothMesh given;
  const double cell_u = cloth.width / (cloth.columns - 1), cell_v = cloth.height / (cloth.rows - 1);
  for (Index r = 0; r < cloth.rows; ++r) {
    for (Index c = 0; c < cloth.columns; ++c) {
      const bool inside = r > 0 && c > 0 && r < cloth.rows - 1 && c < cloth.columns - 1;
      const double u = cell_u * (c + (inside ? random.uniform(-0.2, 0.2) : 0));
      const double v = cell_v * (r + (inside ? random.uniform(-0.2, 0.2) : 0));
      given.mesh.positions.emplace_back(cloth.origin + cloth.u * u + cloth.v * v);
      given.uv.push_back({u, v});
      if (r == 0 || c == 0) continue;
      const Index here = r * cloth.columns + c, left = here - 1, above = here - cloth.columns;
      given.mesh.triangles.push_back({above - 1, left, above});
      given.mesh.triangles.push_back({above, left, here});
    }
  }
  cloth.mesh = given;
}

void set_fabric(ClothDef& cloth, const char* fabric, double thickness) {
  cloth.fabric = make_fabric(fabric);
  cloth.fabric.thickness = thickness;
}

/// Runs a world for so long, looking at each tick.
template <class Look>
void run(World<float>& world, double seconds, Look&& look) {
  while (world.report().time < seconds) {
    world.step();
    look();
  }
}

/// All that a scene did not keep to, at any tick.
std::string failures_of(const World<float>& world, const Verdict<float>& verdict) {
  std::string all;
  for (const std::string& failure : verdict.failures(world.def().verdict)) all += failure + "; ";
  return all;
}

struct Stack {
  const char* fabric = "cotton";
  int sheets = 10, particles = 13;
  double thickness = 0.004, left = 0.5;  // of its height, under the ball
  double force = 100;                    // most of the ball's [N]
  bool mesh = false;
};

/// Sheets on the ground, which a ball presses and leaves; 5 s later each must be as high as before,
/// to two thicknesses.
WorldDef pressed_stack(const Stack& stack) {
  constexpr double kSide = 0.4, kRadius = 0.1, kOver = 0.1, kSeconds = 0.6;
  WorldDef def;
  def.cloths.clear();
  for (int k = 0; k < stack.sheets; ++k) {
    ClothDef sheet = lying_cloth(stack.particles, kSide, stack.thickness * (1.2 * k + 1.1));
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin += Vec3d(0.004 * (k % 3), 0, 0.005 * (k % 2));
    set_fabric(sheet, stack.fabric, stack.thickness);
    if (stack.mesh) make_mesh(sheet, static_cast<unsigned>(k));
    def.cloths.push_back(sheet);
  }
  const double height = stack.thickness * stack.sheets;
  ColliderDef ball{"ball", SphereDef{Vec3d(0, height * 1.2 + kOver + kRadius, 0), kRadius}};
  const Vec3d pressed(0, -kOver - height * (1.2 - stack.left), 0);
  ball.motion.keyframes = {
      {kSeconds}, {2 * kSeconds, pressed}, {4 * kSeconds, pressed}, {5 * kSeconds, Vec3d::Zero()}};
  ball.motion.interpolation = Interpolation::smooth;
  ball.max_force = stack.force;
  def.colliders = {ground(), ball};
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  def.verdict.strain = 0.5;
  def.verdict.lost_motion = 1;
  def.verdict.rest_at = kSeconds;
  def.verdict.back_by = 5 * kSeconds + 5;
  def.verdict.heights = 2 * stack.thickness;
  return def;
}

void check_stack(const Stack& stack) {
  INFO(stack.sheets << " sheets of " << stack.fabric << (stack.mesh ? ", meshes" : "") << ", "
                    << stack.thickness << " m thick, pressed to " << stack.left << " of it");
  World<float> world(pressed_stack(stack));
  Verdict<float> verdict;
  run(world, world.def().verdict.back_by + 0.1, [&] { verdict.look(world); });
  CHECK(failures_of(world, verdict) == "");
}

/// Area of a cloth as seen from above, less what lies on its face [m^2].
double footprint(const World<float>& world) {
  double sum = 0;
  for (const Triangle& t : world.model().triangles) {
    const auto at = [&](std::size_t k) {
      return world.state().x[static_cast<std::size_t>(t[k])].cast<double>().eval();
    };
    sum += (at(1) - at(0)).cross(at(2) - at(0))[1] / 2;
  }
  return sum;
}

/// The built-in towel of other stuff. Half of its face would be seen folded once. A wrinkle may
/// stay where it was folded, and the one hand in the middle of the edge may leave a corner under
/// it, which no contact holds there.
void check_towel(const char* fabric, double thickness, int particles, bool mesh = false) {
  WorldDef def = make_scene("hard-towel", {});
  ClothDef& towel = def.cloths[0];
  towel.rows = towel.columns = particles;
  towel.origin[1] = thickness + 1e-4;
  set_fabric(towel, fabric, thickness);
  if (mesh) make_mesh(towel, 7);
  def.verdict.heights = 1;
  World<float> world(def);
  Verdict<float> verdict;
  const double flat = footprint(world);
  double least = 1;
  run(world, def.verdict.back_by + 0.1, [&] {
    verdict.look(world);
    least = std::min(least, footprint(world) / flat);
  });
  INFO(fabric << (mesh ? ", a mesh, " : ", ") << thickness << " m thick");
  CHECK(least < 0.1);  // it was folded
  CHECK(footprint(world) / flat > 0.6);
  CHECK(failures_of(world, verdict) == "");
}

/// The built-in twist of other stuff, until its hands have made two turns and a half.
void check_twist(const char* fabric, double thickness, int rows, bool mesh = false) {
  WorldDef def = make_scene("hard-twist", {});
  ClothDef& strip = def.cloths[0];
  strip.rows = rows;
  strip.columns = (rows - 1) * 8 / 3 + 1;
  set_fabric(strip, fabric, thickness);
  if (mesh) make_mesh(strip, 9);
  def.verdict.hands_lag =
      0.1;  // stiff cloth stretches their springs; at 0.15 m they would slip round
  World<float> world(def);
  Verdict<float> verdict;
  double turned = 0, before = 0;
  run(world, 7.6, [&] {
    verdict.look(world);
    const std::vector<Grab<float>>& hands = world.grabs().list;
    if (hands.size() < 2) return;
    const Vec3f across =
        held_point(hands.back(), world.state().x) - held_point(hands.front(), world.state().x);
    const double angle = std::atan2(static_cast<double>(across[1]), static_cast<double>(across[2]));
    turned += std::remainder(angle - before, 2 * std::numbers::pi);
    before = angle;
  });
  INFO(fabric << (mesh ? ", a mesh, " : ", ") << thickness << " m thick");
  CHECK(turned > 2 * 2 * std::numbers::pi);
  CHECK(failures_of(world, verdict) == "");
}

/// When the particles' mean has moved so far along `along` [s].
double time_of(const WorldDef& def, SelfContact self, const Vec3d& along, double distance) {
  WorldDef chosen = def;
  chosen.contact.seed.self = self;
  World<float> world(chosen);
  const auto place = [&] {
    Vec3d sum = Vec3d::Zero();
    for (const Vec3f& x : world.state().x) sum += x.cast<double>();
    return along.dot(sum) / static_cast<double>(world.state().x.size());
  };
  const double start = place();
  for (double before = 0; world.report().time < 5;) {
    world.step();
    const double moved = place() - start;
    if (moved >= distance)
      return world.report().time - world.tick_seconds() * (moved - distance) / (moved - before);
    before = moved;
  }
  FAIL("it gets nowhere");
  return 0;
}

void check_times(const char* what, const WorldDef& def, const Vec3d& along, double distance) {
  const double with = time_of(def, SelfContact::guard, along, distance);
  const double without = time_of(def, SelfContact::none, along, distance);
  INFO(what << ": " << with << " s, without contact with itself " << without << " s");
  CHECK(with == Approx(without).epsilon(0.02));
}

}  // namespace

TEST_CASE("ten sheets pressed by a ball are as high as before 5 s later, to 2 thicknesses") {
  check_stack({});
}

TEST_CASE("a towel that is folded twice is unfolded by a hand") {
  check_towel("cotton", 0.004, 17);
}

TEST_CASE("a strip makes two whole turns before it stops the hands that twist it") {
  check_twist("wool", 0.005, 10);
}

TEST_CASE("free fall, slide and drape take the same time as without self-contact, to 2 %") {
  WorldDef fall;
  fall.cloths.clear();
  for (int k = 0; k < 3; ++k) {
    fall.cloths.push_back(lying_cloth(13, 0.5, 3 + 0.0042 * k));
    fall.cloths.back().name = "sheet" + std::to_string(k);
    set_fabric(fall.cloths.back(), k % 2 == 0 ? "silk" : "leather", 0.004);
  }
  check_times("free fall", fall, -Vec3d::UnitY(), 2);
  fall.environment.damping = 1;
  check_times("fall with damping", fall, -Vec3d::UnitY(), 2);

  const double slope = 0.6;
  const Vec3d down(std::cos(slope), -std::sin(slope), 0), up(std::sin(slope), std::cos(slope), 0);
  WorldDef slide;
  slide.cloths[0] = lying_cloth(17, 0.5, 0);
  slide.cloths[0].u = down;
  slide.cloths[0].origin = -0.25 * (down + Vec3d::UnitZ()) + 0.0041 * up;
  slide.cloths[0].fabric.friction = 0.3;
  slide.colliders = {{"slope", PlaneDef{Vec3d::Zero(), up}}};
  check_times("slide", slide, down, 1);

  for (const char* fabric : {"silk", "leather"}) {
    WorldDef drape;
    drape.cloths[0] = lying_cloth(33, 0.9, 0.62);
    set_fabric(drape.cloths[0], fabric, 0.004);
    drape.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.4, 0), 0.2}}};
    drape.environment.damping = 0.5;
    check_times(fabric, drape, -Vec3d::UnitY(), 0.1);
    check_times(fabric, drape, -Vec3d::UnitY(), 0.18);
  }
}

TEST_CASE("stacks of any sheets, pressed by any ball, are as high as before 5 s later", "[.long]") {
  check_stack({.left = 0.7});
  check_stack({.fabric = "silk"});
  check_stack({.fabric = "leather", .force = 400});
  check_stack({.sheets = 5, .thickness = 0.006});
  check_stack({.particles = 25});
  check_stack({.mesh = true});
}

TEST_CASE("towels of any fabric, thin or thick, are unfolded by a hand", "[.long]") {
  for (const char* fabric : {"silk", "wool", "denim", "leather"}) check_towel(fabric, 0.004, 25);
  check_towel("cotton", 0.002, 33);
  check_towel("cotton", 0.007, 25);
  check_towel("cotton", 0.004, 33, true);
}

TEST_CASE("strips of any fabric make two whole turns before they stop the hands", "[.long]") {
  for (const char* fabric : {"cotton", "silk", "denim"}) check_twist(fabric, 0.004, 17);
  check_twist("cotton", 0.001, 17);
  check_twist("cotton", 0.007, 17);
  check_twist("cotton", 0.004, 17, true);
}
