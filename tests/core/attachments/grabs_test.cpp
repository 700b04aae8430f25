#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// Hands that pull at the cloth by force.

using namespace weft;

namespace {

/// A hand so wide that it pulls at all particles of a small cloth nearly alike.
GrabDef wide_hand(const Vec3d& target, double stiffness, double max_force) {
  GrabDef def;
  def.triangle = 0;
  def.radius = 50;
  def.stiffness = stiffness;
  def.max_force = max_force;
  def.target = target;
  return def;
}

double mass_of(const World<double>& world) {
  double sum = 0;
  for (const double m : world.model().mass) sum += m;
  return sum;
}

/// Largest error of the displacement of a free cloth under a wide hand, against that of a mass on a
/// damped spring that starts at rest, in fractions of its first distance.
double worst_error(int substeps) {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.solver.min_substeps = substeps;
  World<double> world(def);
  constexpr double kOmega = 20, kRatio = 0.7, kDistance = 0.1;
  const Vec3d start = test::centre_of_mass(world);
  GrabDef hand = wide_hand(Vec3d::Zero(), mass_of(world) * kOmega * kOmega, 1e6);
  const GrabId id = world.grab(hand);
  const Vec3d held = held_point(world.grabs().list[0], world.state().x);
  world.move_grab(id, held);
  world.step();  // the target is where the cloth is now, and was there before
  world.move_grab(id, held + Vec3d(0, kDistance, 0));
  // The target goes there within the tick: the answer to a ramp is the mean of those to steps.
  const double damped = kOmega * std::sqrt(1 - kRatio * kRatio);
  const auto answer = [&](double t) {
    if (t <= 0) return 0.0;
    return 1 - std::exp(-kRatio * kOmega * t) *
                   (std::cos(damped * t) + kRatio * kOmega / damped * std::sin(damped * t));
  };
  const double tick = world.tick_seconds();
  double worst = 0;
  for (int n = 1; n <= 30; ++n) {
    world.step();
    double expected = 0;
    constexpr int kParts = 200;
    for (int k = 0; k < kParts; ++k) expected += answer(n * tick - (k + 0.5) / kParts * tick);
    const double displacement = (test::centre_of_mass(world) - start)[1] / kDistance;
    worst = std::max(worst, std::abs(displacement - expected / kParts));
  }
  return worst;
}

}  // namespace

TEST_CASE("a hand moves a free cloth as a damped spring moves a mass, in first order of the step") {
  const double coarse = worst_error(50), fine = worst_error(200);
  CHECK(coarse < 0.01);
  CHECK(fine < coarse * 0.3);
}

TEST_CASE(
    "a hand of any stiffness costs at most twice the substeps, and holds its point at the target") {
  WorldDef def;
  def.cloths[0] = test::flat_cloth(21, 21);
  def.pins = {{Corner::top_left, 0, {}}, {Corner::top_right, 0, {}}};
  def.contact.seed.self = SelfContact::none;
  const double stiffness = GENERATE(150.0, 1e3, 1e5);
  World<double> world(def);
  world.step();
  const int substeps = world.report().substeps;
  const std::size_t middle = world.state().x.size() / 2;
  GrabDef hand;
  hand.triangle = static_cast<Index>(world.model().triangles.size() / 2);
  hand.radius = 0.05;
  hand.stiffness = stiffness;
  hand.max_force = 1e6;
  hand.target = world.state().x[middle] + Vec3d(0.02, 0.05, 0);
  world.grab(hand);
  world.step();
  CHECK(world.report().substeps >= substeps);
  CHECK(world.report().substeps <= std::max(2 * substeps, 40));
  CHECK(test::settle(world, 10, 6) < 1e-3);
  const Grab<double>& grab = world.grabs().list[0];
  const Vec3d lag = grab.target - held_point(grab, world.state().x);
  CHECK((lag * stiffness - grab.force).norm() < 1e-3 * grab.force.norm());
  CHECK(lag.norm() < 10 / stiffness);
}

TEST_CASE("no hand leads its cloth by more than the cloth can follow, at any force and tick rate") {
  const double tick_rate = GENERATE(30.0, 60.0, 1000.0);
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.tick_rate = tick_rate;
  def.pins = {{Corner::top_left, 0, {}}, {Corner::top_right, 0, {}}};
  World<double> world(def);
  GrabDef hand;
  hand.triangle = 60;
  hand.stiffness = 1e5;
  hand.max_force = 1e6;
  hand.target = Vec3d(0, -9000, 0);
  const GrabId id = world.grab(hand);
  const double lead = kFastestHeld * std::max(1 / tick_rate, kLeadSeconds);
  for (int n = 0; n < 40; ++n) {
    if (n % 4 == 3) world.move_grab(id, Vec3d(n % 8 == 3 ? 9000 : -9000, 0, 100));
    const Vec3d held = held_point(world.grabs().list[0], world.state().x);
    const TickReport& report = world.step();
    CHECK_FALSE(report.divergence);
    const Grab<double>& grab = world.grabs().list[0];
    CHECK((grab.path_end - held).norm() <= lead * (1 + 1e-9));
    for (const Index i : grab.particles)
      CHECK(world.state().v[static_cast<std::size_t>(i)].norm() < kFastestHeld * 1.5);
  }
}

TEST_CASE("a hand that moves within v_max is where its target is, to the bit") {
  World<float> world(test::empty_world(test::flat_cloth(9, 9)));
  GrabDef hand;
  hand.triangle = 60;
  hand.stiffness = 1000;
  const GrabId id = world.grab(hand);
  hand.target = held_point(world.grabs().list[0], world.state().x).cast<double>();
  for (int n = 0; n < 20; ++n) {
    hand.target += Vec3d(0.02, 0.01, 0);
    world.move_grab(id, hand.target);
    world.step();
    CHECK(world.grabs().list[0].path_end == hand.target.cast<float>());
  }
}

TEST_CASE("four hands at one triangle hold it still, weak ones and strong ones") {
  const double stiffness = GENERATE(100.0, 1e5);
  WorldDef def;
  def.cloths[0] = test::flat_cloth(11, 11);
  def.contact.seed.self = SelfContact::none;
  World<float> world(def);
  for (int k = 0; k < 4; ++k) {
    GrabDef hand;
    hand.triangle = 100;
    hand.radius = 0;
    hand.stiffness = stiffness;
    hand.max_force = 1e6;
    hand.target =
        world.state().x[static_cast<std::size_t>(world.model().triangles[100][0])].cast<double>();
    world.grab(hand);
  }
  CHECK(test::settle(world, 10, 30) < 2e-3);
}

TEST_CASE("the work of a hand is the energy that it gives, also while its force is bounded") {
  World<double> world(test::empty_world(test::flat_cloth(9, 9)));
  // Beyond its greatest force, and beyond the speed at which cloth is held back.
  const double max_force = GENERATE(0.05, 1e6);
  world.grab(wide_hand(Vec3d(0, 3, 0), 1e5, max_force));
  double work = 0;
  for (int tick = 0; tick < 5; ++tick) work += world.step().work;
  const double speed = world.state().v[40].norm();
  if (max_force > 1) {
    CHECK(speed > 0.8 * kFastestHeld);  // its own damping holds it back a little
    CHECK(speed < 1.001 * kFastestHeld);
  }
  CHECK(work == Approx(mass_of(world) * speed * speed / 2).epsilon(0.01));
}
