#include <cmath>

#include <catch2/catch.hpp>

#include "core/contact/colliders/collider_plan.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/diagnostics/crossings.h"
#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"
#include "tests/support/worlds.h"

// Objects that move: they carry, lift and wipe cloth, and never pass through it.

using namespace weft;
using test::Particles;

namespace {

constexpr double kPi = 3.14159265358979323846, kGravity = 9.81, kThickness = 0.004;

Pose pose(const Vec3d& position, double angle = 0, const Vec3d& axis = Vec3d::UnitY()) {
  return {position, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis))};
}

/// A straight way at constant velocity.
MotionDef straight(const Vec3d& velocity, double seconds) {
  MotionDef motion;
  motion.keyframes = {{}, {seconds, velocity * seconds}};
  return motion;
}

/// Turns about the y axis at a constant rate [rad/s].
MotionDef turning(double rate) {
  MotionDef motion;
  motion.loop = true;
  const double quarter = kPi / 2 / rate;
  for (int k = 0; k <= 4; ++k)
    motion.keyframes.push_back(
        {k * quarter, Vec3d::Zero(), pose(Vec3d::Zero(), k * kPi / 2).rotation});
  return motion;
}

/// Particles beside moving colliders.
template <class Real>
struct Mill {
  Particles<Real> particles;
  std::vector<ColliderDef> defs;
  Contact<Real> contact;
  ColliderStates states;
  ClothGuard<Real> others;     ///< has no rows
  std::vector<Index> stopped;  ///< whom these keep where they are
  int tick = 0, halts = 0;

  Mill(const Particles<Real>& p, const std::vector<ColliderDef>& d, const ContactDef& def)
      : particles(p), defs(d), contact(p.meet(def, d)), states(initial_states(d)) {}

  void run(double seconds) {
    const double tick_seconds = particles.tick_seconds;
    for (const int end = tick + static_cast<int>(std::lround(seconds / tick_seconds)); tick < end;
         ++tick) {
      plan_motion(defs, tick * tick_seconds, tick_seconds, states);
      contact.begin_tick(tick_seconds, &states);
      for (int s = 0; s < particles.substeps; ++s) {
        particles.kick();
        ClothState<Real>& state = particles.state;
        const auto dt = static_cast<Real>(particles.dt());
        const Vec3Array<Real> before = state.x;
        contact.resolve(state, dt, particles.profile, stopped.empty() ? nullptr : &others);
        for (const Index i : stopped) {
          state.x[static_cast<std::size_t>(i)] = before[static_cast<std::size_t>(i)];
          state.v[static_cast<std::size_t>(i)].setZero();
        }
        halts += contact.move_objects(state, dt, !stopped.empty()) ? 0 : 1;
        particles.drift();
      }
      finish_motion(defs, tick_seconds, states);
    }
  }
};

/// A disc as plate of a mesh: its upper face at y = 0.
const ShapeDef kTable = MeshDef{test::plate(2, 0.1)};

std::size_t crossings_with(const World<float>& world, std::size_t collider) {
  const ColliderDef& def = world.def().colliders[collider];
  TriangleMesh mesh = std::holds_alternative<BoxDef>(def.shape)
                          ? world_mesh(std::get<BoxDef>(def.shape))
                          : std::get<MeshDef>(def.shape).mesh;
  const Pose& at = world.colliders()[collider].pose;
  for (Vec3d& p : mesh.positions) p = at.position + at.rotation * (p - pivot_of(def.shape));
  return count_crossings(world.state().x, world.model().edges, world.model().triangles, mesh)
      .proper;
}

}  // namespace

TEST_CASE("friction carries a particle: it speeds up with mu g, then goes with the plate, 1 %") {
  for (const double friction : {0.2, 0.5}) {
    for (const double speed : {0.3, 1.0}) {
      Particles<double> one;
      one.add(Vec3d(0, kThickness, 0));
      const ColliderDef plate{"plate", kTable, straight(Vec3d(speed, 0, 0), 3)};
      Mill<double> mill(one, {plate}, {kThickness, friction, 0});
      const double catch_up = speed / (friction * kGravity);
      mill.run(0.5 * catch_up);
      const double passed = mill.tick * one.tick_seconds;
      INFO("friction " << friction << ", plate at " << speed << " m/s");
      CHECK(mill.particles.velocity(0)[0] == Approx(friction * kGravity * passed).epsilon(0.01));
      mill.run(1);
      CHECK(mill.particles.velocity(0)[0] == Approx(speed).epsilon(1e-6));
      const double lag = mill.states[0].pose.position[0] - mill.particles.position(0)[0];
      CHECK(lag == Approx(speed * catch_up / 2).epsilon(0.02));
      const Vec3d before = mill.particles.position(0) - mill.states[0].pose.position;
      mill.run(0.5);
      // Carried without creep.
      CHECK((mill.particles.position(0) - mill.states[0].pose.position - before).norm() < 1e-9);
    }
  }
}

TEST_CASE("on a turning table a particle sticks below w^2 r = mu g and slides out above") {
  const double friction = 0.4, rate = 3;
  const double limit = friction * kGravity / (rate * rate);
  for (const double part : {0.5, 0.9, 1.1}) {
    const double radius = part * limit;
    Particles<double> one;
    one.substeps = 60;
    one.add(Vec3d(radius, kThickness, 0), Vec3d(0, 0, -rate * radius));
    const ColliderDef table{"table", kTable, turning(rate)};
    Mill<double> mill(one, {table}, {kThickness, friction, 0});
    const double seconds = part < 1 ? 2 : 0.8;
    mill.run(seconds);
    const Vec3d p = mill.particles.position(0);
    const double angle = std::atan2(-p[2], p[0]), wanted = seconds * rate;
    INFO("at " << part << " of the limit");
    if (part < 1) {
      CHECK(std::hypot(p[0], p[2]) == Approx(radius).epsilon(1e-4));
      CHECK(std::remainder(angle - wanted, 2 * kPi) == Approx(0).margin(1e-3));
      CHECK(mill.particles.velocity(0).norm() == Approx(rate * radius).epsilon(1e-3));
    } else {
      CHECK(std::hypot(p[0], p[2]) > 1.2 * radius);
    }
    CHECK(p[1] == Approx(kThickness).margin(5e-5));
  }
}

TEST_CASE("cloth on a slope slides as it does when both move at constant velocity: Galilei") {
  const Vec3d velocity(0.7, 0.2, -0.4);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-0.5, Vec3d::UnitZ()));
  std::vector<Vec3Array<double>> ends;
  for (const double moving : {0.0, 1.0}) {
    WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
    def.cloths[0].u = turn * Vec3d::UnitX();
    def.cloths[0].origin = turn * Vec3d(-0.2, kThickness, -0.2);
    def.cloths[0].fabric.friction = 0.3;
    def.environment.damping = 0;
    def.environment.gravity = Vec3d(0, -9.81, 0);
    const BoxDef slope{turn * Vec3d(0, -0.1, 0), Vec3d(2, 0.1, 2), turn};
    def.colliders = {{"slope", slope}};
    def.colliders[0].motion = straight(velocity * moving, 4);
    World<double> world(def);
    for (Vec3<double>& v : world.state().v) v += velocity * moving;
    world.accept_state();
    test::advance(world, 0.2);
    CHECK(world.deepest_penetration() == 0);
    ends.push_back(world.state().x);
    for (Vec3<double>& p : ends.back()) p -= velocity * (moving * world.report().time);
  }
  const double slid = 9.81 * (std::sin(0.5) - 0.3 * std::cos(0.5)) * 0.02;
  double apart = 0;
  for (std::size_t i = 0; i < ends[0].size(); ++i)
    apart = std::max(apart, (ends[0][i] - ends[1][i]).norm());
  const Vec3d start = turn * Vec3d(-0.2, kThickness, -0.2);
  CHECK((ends[0][0] - start).norm() == Approx(slid).epsilon(0.005));
  CHECK(apart < 1e-4);
}

TEST_CASE("a sphere that lifts at 1 m/s does not pass through the cloth that lies over it") {
  WorldDef def = test::empty_world(test::flat_cloth(25, 25));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.cloths[0].origin = Vec3d(-0.5, 0.4, -0.5);
  def.colliders = {{"ground", PlaneDef{}}, {"ball", SphereDef{Vec3d(0, 0.2, 0), 0.15}}};
  def.colliders[1].motion = straight(Vec3d(0, 1, 0), 1.5);
  World<float> world(def);
  for (int tick = 0; tick < 120; ++tick) {
    CHECK_FALSE(world.step().divergence);
    REQUIRE(world.deepest_penetration() == 0);
  }
  const Vec3d centre = world.colliders()[1].pose.position;
  CHECK(centre[1] == Approx(1.7));
  // It hangs over the ball, its middle on top.
  const Vec3d middle = world.state().x[12 * 25 + 12].cast<double>();
  CHECK(middle[1] == Approx(centre[1] + 0.15).margin(0.02));
}

TEST_CASE("a turning bar wipes the cloth along and crosses it nowhere") {
  WorldDef def = test::empty_world(test::flat_cloth(21, 21, 0.6, 0.6));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 0.5;
  def.cloths[0].origin = Vec3d(0.15, 0.006, -0.3);
  const BoxDef bar{Vec3d(0, 0.041, 0.45), Vec3d(0.8, 0.04, 0.02), Eigen::Quaterniond::Identity()};
  def.colliders = {{"ground", PlaneDef{}}, {"bar", bar}};
  MotionDef& motion = def.colliders[1].motion;
  motion.keyframes = {{}, {1.5, Vec3d::Zero(), pose(Vec3d::Zero(), 1.5).rotation}};
  World<float> world(def);
  const Vec3d start = test::centre_of_mass(world);
  for (int tick = 0; tick < 120; ++tick) {
    CHECK_FALSE(world.step().divergence);
    REQUIRE(crossings_with(world, 1) == 0);
    REQUIRE(world.deepest_penetration() == 0);
  }
  CHECK((test::centre_of_mass(world) - start).norm() > 0.1);
}

TEST_CASE("an object that meets cloth which cannot give way lags, and does not pass through") {
  WorldDef def = test::empty_world(test::flat_cloth(17, 17));
  def.environment.damping = 2;
  for (const Index corner : {0, 16, 17 * 16, 17 * 17 - 1}) def.pins.push_back({corner, 0.05});
  const BoxDef block{Vec3d(0.5, -0.2, 0.5), Vec3d(0.1, 0.1, 0.1), Eigen::Quaterniond::Identity()};
  def.colliders = {{"block", block}};
  def.colliders[0].motion = straight(Vec3d(0, 1, 0), 3);
  def.colliders[0].max_force = 30;
  World<float> world(def);
  double strongest = 0;
  for (int tick = 0; tick < 180; ++tick) {
    CHECK_FALSE(world.step().divergence);
    REQUIRE(crossings_with(world, 0) == 0);
    if (tick > 120) strongest = std::max(strongest, world.colliders()[0].force.norm());
  }
  CHECK(world.colliders()[0].pose.position[1] < 1.5);  // 2.8 were asked for
  CHECK(strongest > 15);
  CHECK(strongest < 60);
}

TEST_CASE("cloth between two plates that close stops them, and is free when they open") {
  for (const int particles : {9, 17}) {
    WorldDef def = test::empty_world(test::flat_cloth(particles, particles, 0.4, 0.4));
    def.cloths[0].origin = Vec3d(-0.2, 0, -0.2);
    const auto plate = [&](const char* name, double side) {
      const Vec3d centre(0, side * 0.1, 0);
      const BoxDef box{centre, Vec3d(0.1, 0.02, 0.1), Eigen::Quaterniond::Identity()};
      ColliderDef collider{name, box};
      MotionDef& motion = collider.motion;
      const Vec3d closed(0, -side * 0.085, 0);
      motion.keyframes = {{}, {0.5, closed}, {1, closed}, {1.5}};
      return collider;
    };
    def.colliders = {plate("upper", 1), plate("lower", -1)};
    World<float> world(def);
    double narrowest = 1;
    for (int tick = 0; tick < 120; ++tick) {
      CHECK_FALSE(world.step().divergence);
      REQUIRE(crossings_with(world, 0) + crossings_with(world, 1) == 0);
      narrowest = std::min(narrowest, world.colliders()[0].pose.position[1] -
                                          world.colliders()[1].pose.position[1] - 0.04);
    }
    CHECK(narrowest > 0);
    CHECK(narrowest < 2.5 * def.cloths[0].fabric.thickness);
    for (const ColliderState& state : world.colliders())
      CHECK(std::abs(state.pose.position[1]) == Approx(0.1));
  }
}

TEST_CASE("what follows an object that is stopped stops neither itself nor others") {
  constexpr double kThin = 4e-4;
  for (const double pull : {0.0, 10.0}) {  // on the follower, downwards [N]
    Particles<double> three;
    const Index barrier = three.add(Vec3d(0, -0.15, 0));
    const Index follower = three.add(Vec3d(0, kThin, 0));
    const Index falling = three.add(Vec3d(10, 0, 0));
    three.forces[static_cast<std::size_t>(follower)] = Vec3d(0, -pull, 0);
    ColliderDef plate{"plate", kTable, straight(Vec3d(0, -1, 0), 2)};
    plate.max_force = 1e4;
    Mill<double> mill(three, {plate}, {kThin, 0.4, 0});
    mill.stopped = {barrier};
    mill.run(1);
    INFO("pulled with " << pull << " N");
    CHECK(mill.halts <= 1);  // the first stop is not foreseen
    const double upper = mill.states[0].pose.position[1] - pivot_of(kTable)[1];
    CHECK(upper > -0.05);
    CHECK(upper < -0.049);
    CHECK(mill.particles.position(follower)[1] > upper);
    CHECK(mill.particles.position(follower)[1] < upper + 1.1 * kThin);
    CHECK(mill.particles.position(falling)[1] < -0.9 * kGravity / 2);
  }
}

TEST_CASE("an object stops at pinned cloth") {
  WorldDef def = test::empty_world(test::flat_cloth(5, 5, 0.4, 0.4));
  for (Index i = 0; i < 25; ++i) def.pins.push_back({i, 0});
  def.colliders = {{"ball", SphereDef{Vec3d(0.2, -0.3, 0.2), 0.1}}};
  def.colliders[0].motion = straight(Vec3d(0, 0.5, 0), 2);
  World<float> world(def);
  test::advance(world, 2);
  CHECK(world.deepest_penetration() == 0);
  CHECK(world.colliders()[0].pose.position[1] < -0.1);
  CHECK(world.colliders()[0].pose.position[1] > -0.11);
  CHECK(world.colliders()[0].blocked);
}

TEST_CASE("an object that is told to move regardless goes through, and says so") {
  WorldDef def = test::empty_world(test::flat_cloth(5, 5, 0.4, 0.4));
  for (Index i = 0; i < 25; ++i) def.pins.push_back({i, 0});
  def.colliders = {{"ball", SphereDef{Vec3d(0.2, -0.3, 0.2), 0.1}}};
  World<float> world(def);
  MoveDef up{pose(Vec3d(0.2, 0.3, 0.2)), 0.5, 1, true};
  world.move_collider(0, up);
  test::advance(world, 0.3);
  CHECK_FALSE(world.colliders()[0].voided);
  test::advance(world, 1.2);
  CHECK(world.colliders()[0].pose.position == up.target.position);
  CHECK(world.colliders()[0].voided);
  world.reset();
  CHECK_FALSE(world.colliders()[0].voided);
}

TEST_CASE("a command moves a collider at its speed; what is out of bounds is refused") {
  WorldDef def = test::empty_world(test::flat_cloth(5, 5, 0.2, 0.2));
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -1, 0), Vec3d::UnitY()}},
                   {"ball", SphereDef{Vec3d(0, 0.5, 0), 0.1}}};
  World<float> world(def);
  const std::uint64_t hash = world.hash();
  CHECK_THROWS_AS(world.move_collider(1, {pose({0, 2000, 0}), 1, 1}), DefinitionError);
  CHECK_THROWS_AS(world.move_collider(1, {pose({0, 1, 0}), 1000, 1}), DefinitionError);
  CHECK_THROWS_AS(world.move_collider(0, {pose({0, -1, 0}, 0.5), 1, 1}), DefinitionError);
  CHECK_FALSE(world.move_collider(2, {pose({0, 1, 0}), 1, 1}));
  CHECK(world.hash() == hash);
  CHECK(world.move_collider(1, {pose({0, 1, 0}), 0.5, 1}));
  CHECK(world.hash() != hash);
  test::advance(world, 0.5);
  CHECK(world.colliders()[1].pose.position[1] == Approx(0.75));
  test::advance(world, 0.6);
  CHECK(world.colliders()[1].pose.position[1] == 1);
  world.reset();
  CHECK(world.hash() == hash);
  CHECK(world.colliders()[1].pose.position[1] == 0.5);
}

TEST_CASE("a tick that was taken back takes the objects back as well") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.colliders = {{"ball", SphereDef{Vec3d(0, 0.5, 0), 0.1}}};
  def.colliders[0].motion = straight(Vec3d(0.5, 0, 0), 4);
  World<float> world(def);
  for (int tick = 0; tick < 10; ++tick) world.step();
  world.state().v[3] = Vec3f(NAN, 0, 0);
  REQUIRE(world.step().divergence);
  world.step();
  const Pose wanted = keyframed_pose(def.colliders[0], world.report().time);
  CHECK((world.colliders()[0].pose.position - wanted.position).norm() < 1e-12);
}

TEST_CASE("nothing is allocated while objects move through what they have met") {
  Particles<float> cloth;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 10; ++c) cloth.add(Vec3d(0.02 * c, kThickness, 0.02 * r));
  }
  const ColliderDef table{"table", kTable, turning(2)};
  Mill<float> mill(cloth, {table, {"ball", SphereDef{Vec3d(0, 0.2, 0), 0.1}}}, {});
  mill.run(4);
  const std::size_t before = test::count_allocations();
  plan_motion(mill.defs, 4, cloth.tick_seconds, mill.states);
  mill.contact.begin_tick(cloth.tick_seconds, &mill.states);
  for (int s = 0; s < cloth.substeps; ++s) {
    mill.contact.resolve(mill.particles.state, static_cast<float>(cloth.dt()), cloth.profile);
    mill.contact.move_objects(mill.particles.state, static_cast<float>(cloth.dt()), false);
    mill.particles.drift();
  }
  finish_motion(mill.defs, cloth.tick_seconds, mill.states);
  CHECK(test::count_allocations() == before);
}
