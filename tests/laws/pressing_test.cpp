#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// The force of an object that presses cloth on another object, and what it holds by that.

using namespace weft;

namespace {

/// Sheets of 20 cm on the ground, on top of each other, under a plate of 10 cm.
/// @param max_force  of the plate [N]
WorldDef plate_on_layers(int layers, double thickness, double max_force) {
  WorldDef def = test::empty_world(test::flat_cloth(13, 13, 0.2, 0.2));
  ClothDef sheet = def.cloths[0];
  sheet.fabric.thickness = thickness;
  sheet.fabric.areal_density = 0.2;
  def.cloths.clear();
  for (int k = 0; k < layers; ++k) {
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin = Vec3d(-0.1, (k + 1) * (thickness + 1e-5), -0.1);
    sheet.v = Vec3d::UnitZ();
    def.cloths.push_back(sheet);
  }
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.contact.seed.self = SelfContact::guard;
  ColliderDef ground, plate;
  ground.name = "ground";
  ground.shape = PlaneDef{Vec3d::Zero(), Vec3d::UnitY()};
  plate.name = "plate";
  plate.shape = BoxDef{Vec3d(0, 0.07, 0), Vec3d(0.05, 0.02, 0.05), Eigen::Quaterniond::Identity()};
  plate.max_force = max_force;
  def.colliders = {ground, plate};
  return def;
}

struct Pressed {
  int particles = 13;                  ///< a side
  double thickness = 1e-3;             ///< [m]
  double max_force = 5;                ///< of the object [N]
  bool finger = false;                 ///< a ball of 1 cm in place of a plate of 10 cm
  bool on_table = false;               ///< a box in place of the ground
  double friction = 0.4;               ///< with the ground
  double factor = 1;                   ///< of the object, times that
  Vec3d gravity = Vec3d(0, -9.81, 0);  ///< [m/s^2]
};

/// A sheet of 20 cm and 8 g on the ground, and an object 4 cm above it.
WorldDef pressed_sheet(const Pressed& c) {
  WorldDef def = test::empty_world(test::flat_cloth(c.particles, c.particles, 0.2, 0.2));
  ClothDef& sheet = def.cloths[0];
  sheet.fabric.thickness = c.thickness;
  sheet.fabric.friction = c.friction;
  sheet.fabric.areal_density = 0.2;
  sheet.origin = Vec3d(-0.1, c.thickness + 1e-5, -0.1);
  sheet.v = Vec3d::UnitZ();
  def.environment.gravity = c.gravity;
  def.environment.damping = 1;
  ColliderDef ground, object;
  ground.name = "ground";
  ground.shape = PlaneDef{Vec3d::Zero(), Vec3d::UnitY()};
  if (c.on_table) ground.shape = BoxDef{Vec3d(0, -0.1, 0), Vec3d(0.3, 0.1, 0.3)};
  object.name = "object";
  const double half = c.finger ? 0.01 : 0.02;
  const Vec3d start(0.003, half + 0.04, 0.002);  // in the middle of no cell
  object.shape = BoxDef{start, Vec3d(0.05, half, 0.05)};
  if (c.finger) object.shape = SphereDef{start, half};
  object.max_force = c.max_force;
  object.friction_factor = c.factor;
  def.colliders = {ground, object};
  return def;
}

/// Sends the object down through the ground, which takes less than a second.
void press(World<float>& world, double speed = 0.1, std::size_t object = 1) {
  world.measure_forces(true);
  MoveDef down;
  down.target.position = Vec3d(0.003, 0, 0.002);
  down.speed = speed;
  REQUIRE(world.move_collider(object, down));
  test::advance(world, 1);
}

/// Mean forces on the ground and the object in some ticks [N].
std::array<Vec3d, 2> mean_forces(World<float>& world, int ticks) {
  std::array<Vec3d, 2> mean = {Vec3d::Zero(), Vec3d::Zero()};
  for (int t = 0; t < ticks; ++t) {
    world.step();
    for (std::size_t k = 0; k < 2; ++k) mean[k] += world.reactions()->colliders[k] / ticks;
  }
  return mean;
}

/// Normal force on the cloth and friction of all contacts with an object, mean over some ticks [N].
struct Rubbed {
  double pressed = 0;
  double friction = 0;  ///< sum of the sizes
};

/// Adds the contacts of the last tick to those of the ground and the object.
void add_contacts(const World<float>& world, int ticks, std::array<Rubbed, 2>& mean) {
  for (const ContactPoint& contact : world.reactions()->contacts) {
    Rubbed& of = mean[static_cast<std::size_t>(contact.collider)];
    of.pressed += contact.normal_force / ticks;
    of.friction += contact.friction.norm() / ticks;
  }
}

/// Takes the sheet's border at x = 0.1 with hands in a row.
void hold_border(World<float>& world) {
  const ClothModel<float>& model = world.model();
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    Vec3d middle = Vec3d::Zero();
    for (const Index i : model.triangles[t])
      middle += world.state().x[static_cast<std::size_t>(i)].cast<double>() / 3;
    if (middle[0] < 0.085) continue;
    GrabDef hand;
    hand.triangle = static_cast<Index>(t);
    hand.radius = 0.02;
    hand.stiffness = 50;
    hand.target = middle;
    world.grab(hand);
  }
  REQUIRE(world.grabs().list.size() >= 4);
}

}  // namespace

TEST_CASE("a finger that comes fast presses with its force, and shoves the cloth nowhere") {
  for (const int particles : {16, 21, 31}) {
    for (const auto& [force, speed] : {std::pair(20.0, 0.3), std::pair(5.0, 0.5)}) {
      World<float> world(pressed_sheet({particles, 1e-3, force, true}));
      const Vec3Array<float> start = world.state().x;
      press(world, speed);
      INFO(particles << " particles a side, " << speed << " m/s, " << force << " N");
      for (int tick = 0; tick < 30; ++tick) {
        world.step();
        float farthest = 0;
        for (std::size_t i = 0; i < start.size(); ++i)
          farthest = std::max(farthest, (world.state().x[i] - start[i]).norm());
        REQUIRE(farthest < 3e-3f);  // once it slips off a particle
      }
      CHECK(mean_forces(world, 10)[1][1] == Approx(force).epsilon(0.02));
    }
  }
}

TEST_CASE("an object presses a single layer on another with its force, and does not thin it") {
  for (const Pressed& c : {Pressed{}, Pressed{33, 5e-4, 50}, Pressed{13, 2e-3, 1, true},
                           Pressed{33, 1e-3, 5, true, true}, Pressed{20, 1e-3, 20, false, true}}) {
    World<float> world(pressed_sheet(c));
    press(world);
    const double weight = 0.008 * 9.81;
    const auto [ground, object] = mean_forces(world, 10);
    INFO(c.particles << " particles a side, " << c.max_force << " N");
    CHECK(object[1] == Approx(c.max_force).epsilon(0.02));
    CHECK(ground[1] == Approx(-c.max_force - weight).epsilon(0.02));
    for (const ContactPoint& contact : world.reactions()->contacts)
      CHECK(contact.gap > 0.95 * c.thickness);
    MoveDef up;
    up.target.position = Vec3d(0, 0.2, 0);
    REQUIRE(world.move_collider(1, up));
    test::advance(world, 0.2);
    CHECK(world.reactions()->colliders[1].norm() == 0);
    CHECK_FALSE(world.colliders()[0].bracing);  // it costs no more than before
    CHECK(world.reactions()->colliders[0][1] == Approx(-weight).epsilon(0.02));
  }
}

TEST_CASE("an object presses a layer with its force by every solver, in as few substeps") {
  for (const SolverKind kind : {SolverKind::verlet, SolverKind::implicit, SolverKind::relaxation}) {
    for (const int substeps : {1, 2, 8}) {
      WorldDef def = pressed_sheet({});
      def.solver.kind = kind;
      def.implicit.substeps = substeps;
      def.relaxation.compliance = 1;
      def.relaxation.substeps = substeps;
      World<float> world(def);
      press(world);
      INFO("solver " << static_cast<int>(kind) << ", " << substeps << " substeps");
      CHECK(mean_forces(world, 10)[1][1] == Approx(5).epsilon(0.02));
    }
  }
}

TEST_CASE("of two objects that press a layer between them the weaker one gives way") {
  for (const auto& [below, above] :
       {std::pair(4.0, 2.0), std::pair(2.0, 4.0), std::pair(3.0, 3.0)}) {
    Pressed c;
    c.on_table = true;
    c.max_force = above;
    WorldDef def = pressed_sheet(c);
    def.colliders[0].max_force = below;
    World<float> world(def);
    MoveDef up;
    up.target.position = Vec3d(0, 0.2, 0);
    up.speed = 0.1;
    REQUIRE(world.move_collider(0, up));
    press(world);
    const double start = world.colliders()[1].pose.position[1];
    Vec3d momentum = test::momentum(world);
    constexpr int kTicks = 60;
    const auto [table, object] = mean_forces(world, kTicks);
    momentum = test::momentum(world) - momentum;
    const double rise = world.colliders()[1].pose.position[1] - start;
    INFO("from below " << below << " N, from above " << above << " N");
    const double weight = 0.008 * 9.81, least = std::min(below - weight, above);
    const double pushed = -(table + object)[1] - weight;  // on the cloth
    CHECK(pushed == Approx(momentum[1] * 60 / kTicks).margin(0.01 * least));
    CHECK(object[1] == Approx(least).epsilon(0.02));
    if (below == above)
      CHECK(std::abs(rise) < 1e-4);
    else
      CHECK(rise * (below - above) > 4e-3);  // the same way as the stronger one
  }
}

TEST_CASE("an object between open jaws presses a layer on one of them with its force") {
  WorldDef def = pressed_sheet({});
  def.colliders.erase(def.colliders.begin());  // the lower jaw takes the place of the ground
  GripperDef gripper;
  gripper.orientation = Eigen::AngleAxisd(1.5707963267948966, Vec3d::UnitZ());
  gripper.half_extents = Vec3d(0.02, 0.15, 0.15);
  gripper.opening = 0.3;
  gripper.centre = Vec3d(0, 0.15, 0);
  def.grippers = {gripper};
  World<float> world(def);
  press(world, 0.1, 0);
  const auto [object, jaw] = mean_forces(world, 10);
  CHECK(object[1] == Approx(5).epsilon(0.02));
  CHECK(jaw[1] == Approx(-5 - 0.008 * 9.81).epsilon(0.02));
}

TEST_CASE("a layer that is pressed is held at 0.9 of what friction on both sides allows") {
  for (const bool finger : {false, true}) {
    for (const double load : {0.9, 1.1}) {
      Pressed c;
      c.finger = finger;
      c.max_force = 2;
      c.friction = 0.1;
      World<float> world(pressed_sheet(c));
      press(world);
      const double allowed = c.friction * (2 * c.max_force + 0.008 * 9.81);
      const auto middle = static_cast<std::size_t>(c.particles * c.particles / 2);
      const auto before = static_cast<double>(world.state().x[middle][0]);
      EnvironmentDef pulled = world.environment();
      pulled.damping = 5;
      constexpr int kTicks = 60;
      for (int t = 1; t <= kTicks; ++t) {  // slowly, so that nothing swings
        pulled.gravity[0] = load * allowed / 0.008 * t / kTicks;
        world.set_environment(pulled);
        world.step();
      }
      test::advance(world, 0.5);
      const double moved = static_cast<double>(world.state().x[middle][0]) - before;
      INFO((finger ? "finger, " : "plate, ") << load);
      if (load < 1)
        CHECK(std::abs(moved) < 3e-3);  // which it is stretched by
      else
        CHECK(moved > 0.02);
    }
  }
}

TEST_CASE("each side of a pressed layer rubs with no more than mu times its own normal force") {
  for (const double slope : {1.7, 2.7}) {  // hands that lift the layer press it on the object
    for (const double force : {3.0, 5.0}) {
      Pressed c;
      c.particles = 15;
      c.max_force = force;
      WorldDef def = pressed_sheet(c);
      def.colliders[1].shape = SphereDef{Vec3d(0.003, 0.1, 0.002), 0.05};
      World<float> world(def);
      press(world);
      hold_border(world);
      constexpr int kTicks = 60;
      const Vec3d step = Vec3d(1, slope, 0).normalized() * (0.03 / kTicks);
      for (int second = 0; second < 4; ++second) {
        std::array<Rubbed, 2> mean;
        for (int t = 0; t < kTicks; ++t) {
          for (const Grab<float>& grab : world.grabs().list)
            world.move_grab(grab.id, grab.target.cast<double>() + step);
          world.step();
          add_contacts(world, kTicks, mean);
        }
        INFO(slope << " upwards, " << force << " N, second " << second);
        const auto& [ground, object] = mean;
        if (second == 3) CHECK(ground.pressed < 0.9 * object.pressed);
        for (const Rubbed& side : mean) CHECK(side.friction < 1.03 * c.friction * side.pressed);
      }
    }
  }
}

TEST_CASE("a layer goes along with that of two surfaces that rubs it more") {
  for (const bool finger : {false, true}) {
    for (const auto& [factor, speed] :
         {std::pair(0.5, 0.1), std::pair(2.0, 0.1), std::pair(2.0, 0.01)}) {
      Pressed c;
      c.finger = finger;
      c.factor = factor;
      World<float> world(pressed_sheet(c));
      press(world);
      const double before = test::centre_of_mass(world)[0];
      MoveDef along;
      along.target.position = Vec3d(0.003 + 0.5 * speed, 0, 0.002);
      along.speed = speed;
      REQUIRE(world.move_collider(1, along));
      test::advance(world, 0.25);
      const double rub = mean_forces(world, 10)[1][0];
      test::advance(world, 0.5);
      const double moved = (test::centre_of_mass(world)[0] - before) / (0.5 * speed);
      INFO((finger ? "finger, " : "plate, ") << factor << " times, " << speed << " m/s");
      if (factor < 1) {
        CHECK(std::abs(moved) < 0.1);
        CHECK(rub == Approx(-factor * c.friction * c.max_force).epsilon(0.05));
      } else {
        CHECK(moved == Approx(1).margin(0.15));
        CHECK(-rub > 0.65 * c.friction * c.max_force);  // the ground's, which slows the layer
        CHECK(-rub < 1.15 * c.friction * c.max_force);
      }
    }
  }
}

TEST_CASE("an object that layers resist presses them with its force, to 15 % after 4 s") {
  struct Case {
    int layers;
    double thickness, max_force;  // [m], [N]
  };
  for (const auto& [layers, thickness, max_force] :
       {Case{2, 2e-3, 50}, Case{3, 2e-3, 5}, Case{4, 5e-4, 5}}) {
    World<float> world(plate_on_layers(layers, thickness, max_force));
    world.measure_forces(true);
    MoveDef down;
    down.target.position = Vec3d::Zero();
    down.speed = 0.1;
    REQUIRE(world.move_collider(1, down));
    test::advance(world, 4);
    constexpr int kTicks = 60;
    double pressed = 0;
    for (int t = 0; t < kTicks; ++t) {
      world.step();
      pressed -= world.reactions()->colliders[1][1] / kTicks;
    }
    INFO(layers << " layers of " << thickness << " m");
    CHECK(std::abs(pressed) == Approx(max_force).epsilon(0.15));
  }
}

TEST_CASE(
    "an object that goes along layers presses them with its force at most, wherever it goes") {
  for (const double depth : {1e-4, 1e-3, 2e-2}) {
    for (const double max_force : {2.0, 5.0}) {
      World<float> world(plate_on_layers(2, 1e-3, max_force));
      world.measure_forces(true);
      MoveDef move;
      move.target.position = Vec3d(0, 0.022 - depth, 0);
      move.speed = 0.1;
      REQUIRE(world.move_collider(1, move));
      test::advance(world, 2);
      move.target.position[0] = 0.04;
      REQUIRE(world.move_collider(1, move));
      for (int second = 0; second < 3; ++second) {
        constexpr int kTicks = 60;
        double pressed = 0;
        for (int t = 0; t < kTicks; ++t) {
          world.step();
          pressed -= world.reactions()->colliders[1][1] / kTicks;
        }
        INFO(depth << " m deep, " << max_force << " N, second " << second);
        CHECK(std::abs(pressed) < 1.2 * max_force);
      }
      CHECK(world.colliders()[1].pose.position[0] == Approx(0.04).margin(1e-3));
    }
  }
}
