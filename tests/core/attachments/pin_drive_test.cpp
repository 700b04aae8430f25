#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/error.h"
#include "tests/support/sheets.h"
#include "tests/support/worlds.h"

// Pins that are told to go somewhere: targets that lag when blocked, with bounded force.

using namespace weft;
using namespace weft::test;

namespace {

/// A cloth that hangs by two discs at its upper corners.
WorldDef hung_cloth() {
  WorldDef def;
  def.cloths[0] = hanging_cloth(21, 21, 0.6, 0.6, 1.5, 0);
  def.pins = {{Corner::top_left, 0.05, {}}, {Corner::top_right, 0.05, {}}};
  def.environment.damping = 2;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

template <class Real>
Vec3d centre_of(const World<Real>& world, std::size_t pin) {
  const Index i = world.pins().list[pin].centre;
  return world.state().x[static_cast<std::size_t>(i)].template cast<double>();
}

template <class Real>
void send_all(World<Real>& world, const Vec3d& offset, double speed = 2, double max_force = 50) {
  for (std::size_t k = 0; k < world.pins().list.size(); ++k)
    REQUIRE(
        world.move_pin(world.pins().list[k].id, {centre_of(world, k) + offset, speed, max_force}));
}

}  // namespace

TEST_CASE("a pin pulled 3 m away arrives with its cloth, is fixed again, and nothing crosses") {
  World<float> world(hung_cloth());
  for (int k = 0; k < 30; ++k) world.step();
  const Vec3d left = centre_of(world, 0), right = centre_of(world, 1), offset(0, 0, 3);
  send_all(world, offset);
  double largest_strain = 0;
  std::size_t crossed = 0;
  for (int k = 0; k < 180; ++k) {
    REQUIRE_FALSE(world.step().divergence);
    largest_strain = std::max(largest_strain, world.report().largest_strain);
    crossed += crossings(world);
  }
  CHECK(crossed == 0);
  CHECK(largest_strain < 0.5);
  CHECK((centre_of(world, 0) - left - offset).norm() < 1e-5);
  CHECK((centre_of(world, 1) - right - offset).norm() < 1e-5);
  CHECK_FALSE(world.pins().any_moving());
  for (const Pin& pin : world.pins().list) {
    for (const Index i : pin.particles)
      CHECK(world.state().inverse_mass[static_cast<std::size_t>(i)] == 0);
  }
}

TEST_CASE("a pin that is led at 0.1 m/s is at its target after each tick, to 1e-9 m") {
  WorldDef def = hung_cloth();
  World<double> world(def);
  const Vec3d left = centre_of(world, 0), right = centre_of(world, 1);
  const Vec3d step = Vec3d(0.06, 0, 0.08) / def.tick_rate;
  for (int k = 1; k <= 60; ++k) {
    world.move_pin(world.pins().list[0].id, {left + step * k});
    world.move_pin(world.pins().list[1].id, {right + step * k});
    world.step();
    CHECK((centre_of(world, 0) - left - step * k).norm() < 1e-9);
    CHECK((centre_of(world, 1) - right - step * k).norm() < 1e-9);
  }
}

TEST_CASE("pins keep the shape of what they hold while they carry it, to 1e-6 m") {
  World<double> world(hung_cloth());
  const Pin pin = world.pins().list[0];
  const Vec3Array<double> before = world.state().x;
  send_all(world, Vec3d(0, 0.5, 1));
  for (int k = 0; k < 20; ++k) world.step();
  REQUIRE(world.pins().any_moving());
  const auto centre = static_cast<std::size_t>(pin.centre);
  for (const Index n : pin.particles) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3d was = before[i] - before[centre];
    CHECK((world.state().x[i] - world.state().x[centre] - was).norm() < 1e-6);
  }
}

TEST_CASE("the force of a pin on its way never exceeds its bound, and the cloth comes after") {
  WorldDef def = hung_cloth();
  World<float> world(def);
  const double weight = 0.36 * def.cloths[0].fabric.areal_density * 9.81;
  const double bound = weight;  // each of two: enough to hold, not to follow at once
  for (int k = 0; k < 60; ++k) world.step();
  world.measure_forces(true);
  send_all(world, Vec3d(0, 1, 2), 4, bound);
  double largest = 0;
  for (int k = 0; k < 300; ++k) {
    world.step();
    if (!world.pins().any_moving()) break;
    REQUIRE(world.reactions());
    for (std::size_t p = 0; p < 2; ++p) {
      if (world.pins().list[p].path)
        largest = std::max(largest, world.reactions()->pins[p].force.norm());
    }
  }
  CHECK(largest <= bound * (1 + 1e-6));
  CHECK(largest > bound * 0.8);
  CHECK_FALSE(world.pins().any_moving());
}

TEST_CASE("pins pulled through a plate stop at it and press with no more than their force") {
  WorldDef def = hung_cloth();
  // Behind the cloth, wider than it is.
  def.colliders = {{"plate", BoxDef{Vec3d(0, 1.2, 0.3), Vec3d(0.8, 0.8, 0.01)}}};
  World<float> world(def);
  for (int k = 0; k < 30; ++k) world.step();
  world.measure_forces(true);
  send_all(world, Vec3d(0, 0, 3));
  const ColliderDef& plate = def.colliders[0];
  const TriangleMesh mesh = world_mesh(std::get<BoxDef>(plate.shape));
  std::size_t crossed = 0;
  double largest = 0;
  for (int k = 0; k < 240; ++k) {
    REQUIRE_FALSE(world.step().divergence);
    const Crossings c =
        count_crossings(world.state().x, world.model().edges, world.model().triangles, mesh);
    crossed += c.proper + c.touching + crossings(world);
    for (const PinReaction& pin : world.reactions()->pins)
      largest = std::max(largest, pin.force.norm());
  }
  CHECK(crossed == 0);
  CHECK(world.deepest_penetration() == 0);
  CHECK(largest <= 50 * (1 + 1e-6));
  CHECK(world.pins().any_moving());
  for (std::size_t p = 0; p < 2; ++p) {
    CHECK(centre_of(world, p)[2] < 0.29);
    CHECK(centre_of(world, p)[2] > 0.27);
  }
  // Told to come back, they come.
  send_all(world, Vec3d(0, 0, -0.2));
  for (int k = 0; k < 60; ++k) world.step();
  CHECK_FALSE(world.pins().any_moving());
}

TEST_CASE("a particle that another pin holds too stays where it is") {
  World<double> world(hung_cloth());
  const PinId second = world.pin({Corner::top_left, 0, {}});
  const Index corner = world.pins().list.back().centre;
  const Vec3d before = world.state().x[static_cast<std::size_t>(corner)];
  world.move_pin(world.pins().list[0].id, {before + Vec3d(0, 0, 0.1)});
  for (int k = 0; k < 10; ++k) world.step();
  CHECK(world.state().x[static_cast<std::size_t>(corner)] == before);
  world.unpin(second);
  for (int k = 0; k < 120; ++k) world.step();
  CHECK((centre_of(world, 0) - before - Vec3d(0, 0, 0.1)).norm() < 1e-5);
  CHECK_FALSE(world.pins().any_moving());
}

TEST_CASE("a pin that is given a time is fixed at its target within it, and not in half of it") {
  for (const double distance : {0.002, 0.1, 0.6}) {
    for (const double more : {1.0, 1.5, 10.0}) {
      World<float> world(hung_cloth());
      for (int k = 0; k < 30; ++k) world.step();
      const Pin& pin = world.pins().list[0];
      const Vec3d step = Vec3d(0, 0.3, 1).normalized() * distance,
                  target = centre_of(world, 0) + step;
      const double tick = world.tick_seconds(), seconds = more * least_seconds(distance, tick);
      const double left = remaining_distance(pin, world.state(), target);
      send_all(world, step, speed_within(left, seconds, tick));
      int ticks = 0;
      for (; pin.path && ticks < 1000; ++ticks) world.step();
      INFO(distance << " m in " << seconds << " s, " << ticks << " ticks");
      CHECK(ticks * tick <= seconds + 1e-9);
      if (more > 1) CHECK(ticks * tick > seconds / 2);
      CHECK((centre_of(world, 0) - target).norm() < 1e-5);
    }
  }
}

TEST_CASE("a pin arrives in its time, however wide it is and though its cloth folds up at it") {
  struct Case {
    const char* fabric;
    double rate, radius, distance;
  };
  for (const Case& c :
       {Case{"denim", 60, 0.03, 1}, Case{"silk", 60, 0.03, 1}, Case{"wool", 120, 0.03, 0.6},
        Case{"cotton", 120, 0.05, 1}, Case{"leather", 120, 0.03, 1}}) {
    WorldDef def;
    def.cloths[0] = hanging_cloth(15, 15, 0.3, 0.3, 1, 0);
    def.cloths[0].fabric = make_fabric(c.fabric);
    def.pins = {{Corner::top_left, c.radius, {}}, {Corner::top_right, c.radius, {}}};
    def.contact.seed.self = SelfContact::guard;
    def.tick_rate = c.rate;
    World<float> world(def);
    for (int k = 0; k < c.rate; ++k) world.step();
    world.measure_forces(true);
    const double tick = world.tick_seconds(), seconds = 1.2 * least_seconds(c.distance, tick);
    send_all(world, Vec3d(0, 0, c.distance), speed_within(c.distance, seconds, tick), 1000);
    double mass = 0;
    for (const float m : world.model().mass) mass += static_cast<double>(m);
    const Vec3d before = test::momentum(world);
    Vec3d given = Vec3d::Zero();
    int ticks = 0;
    for (; world.pins().any_moving() && ticks < 1000; ++ticks) {
      world.step();
      given += def.environment.gravity * (mass * tick);
      for (const PinReaction& pin : world.reactions()->pins) given += pin.force * tick;
    }
    INFO(c.fabric << ", a radius of " << c.radius << " m: " << ticks << " ticks for " << seconds
                  << " s");
    CHECK(ticks * tick <= seconds + 1e-9);
    // What the pins are told to give is what the cloth has got, its folds among each other aside.
    CHECK((test::momentum(world) - before - given).norm() < 1e-3 * mass);
  }
}

TEST_CASE("a pin speeds up and brakes by no more than 40 m/s^2, at any tick rate and speed") {
  const double rate = GENERATE(43, 60, 200, 400), speed = GENERATE(0.3, 1.3, 10.0),
               distance = GENERATE(0.013, 0.2, 1.0);
  CAPTURE(rate, speed, distance);
  WorldDef def;
  def.cloths[0] = hanging_cloth(4, 4, 0.3, 0.3, 1.5, 0);
  def.pins = {{EdgeStrip{}, 0, {}}};
  def.contact.seed.self = SelfContact::none;
  def.tick_rate = rate;
  World<double> world(def);
  send_all(world, Vec3d(distance, 0, 0), speed, 1e4);
  double x = centre_of(world, 0)[0], v = 0, most = 0, fastest = 0;
  while (world.pins().any_moving()) {
    REQUIRE(world.report().time < 10);
    world.step();
    const double moved = (centre_of(world, 0)[0] - x) * rate;
    most = std::max(most, std::abs(moved - v) * rate);
    fastest = std::max(fastest, moved);
    x += moved / rate;
    v = moved;
  }
  CHECK(most <= 40 * (1 + 1e-6));
  CHECK(v == Approx(0).margin(1e-6));
  // It is as fast as these allow.
  const double possible = std::min(speed, std::sqrt(40 * distance));
  CHECK(fastest <= possible * (1 + 1e-6));
  CHECK(fastest >= possible - 40 / rate);
}

TEST_CASE("a pin that is stopped on its way is fixed where it is") {
  World<double> world(hung_cloth());
  const PinId id = world.pins().list[0].id;
  CHECK_FALSE(world.stop_pin(id + 100));
  send_all(world, Vec3d(0, 0, 1));
  for (int k = 0; k < 20; ++k) world.step();
  const Pin& pin = world.pins().list[0];
  const Vec3Array<double> before = world.state().x;
  REQUIRE(world.stop_pin(id));
  CHECK(world.report().energies.kinetic > 0);
  CHECK_FALSE(pin.path);
  for (int k = 0; k < 20; ++k) REQUIRE_FALSE(world.step().divergence);
  for (const Index n : pin.particles)
    CHECK(world.state().x[static_cast<std::size_t>(n)] == before[static_cast<std::size_t>(n)]);
  CHECK(centre_of(world, 1)[2] > before[static_cast<std::size_t>(pin.centre)][2]);
}

TEST_CASE("a pin that cannot follow says that it is behind, and one that can does not") {
  WorldDef def = hung_cloth();
  def.colliders = {{"plate", BoxDef{Vec3d(0, 1.2, 0.3), Vec3d(0.8, 0.8, 0.01)}}};
  World<float> world(def);
  send_all(world, Vec3d(0, 0, 1), 1);
  for (int k = 0; k < 10; ++k) world.step();
  CHECK_FALSE(world.pins().list[0].path->behind);
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(world.pins().list[0].path->behind);
}

TEST_CASE("a pin whose pull cancels a thousand weights of its particle fails no tick") {
  // Drawn out between two corners the cloth pulls its corner back by 2000 m/s in a substep, all of
  // which the pin takes.
  WorldDef def;
  def.cloths[0].rows = def.cloths[0].columns = 20;
  def.cloths[0].origin = Vec3d(0, 1.5, 0);
  def.pins = {{Corner::top_left, 0, {}}, {Corner::top_right, 0, {}}};
  def.solver.kind = GENERATE(SolverKind::verlet, SolverKind::implicit, SolverKind::relaxation);
  def.relaxation.sweeps = 10;
  def.relaxation.substeps = 8;
  const double max_force = GENERATE(1000.0, 1e6);
  CAPTURE(def.solver.kind, max_force);
  World<float> world(def);
  const Pin& pin = world.pins().list[0];
  REQUIRE(world.move_pin(pin.id, {centre_of(world, 0) + Vec3d(0, 0, 1000), 20, max_force}));
  double largest = 0;
  for (int k = 0; k < 60; ++k) {
    const TickReport& report = world.step();
    INFO((report.divergence ? describe(*report.divergence) : ""));
    REQUIRE_FALSE(report.divergence);
    largest = std::max(largest, pin.drive.norm());
  }
  CHECK(largest <= max_force * (1 + 1e-6));
  CHECK(largest > 100);
}

TEST_CASE("what is wrong in a move is refused by name, and nothing changes") {
  World<double> world(hung_cloth());
  const PinId id = world.pins().list[0].id;
  const std::uint64_t before = world.hash();
  CHECK_FALSE(world.move_pin(id + 100, {}));
  CHECK_THROWS_AS(world.move_pin(id, {Vec3d(0, 2e4, 0)}), DefinitionError);
  CHECK_THROWS_AS(world.move_pin(id, {Vec3d::Zero(), 0}), DefinitionError);
  CHECK_THROWS_AS(world.move_pin(id, {Vec3d::Zero(), 2, -1}), DefinitionError);
  CHECK(world.hash() == before);
}

TEST_CASE("a pin that is sent to where it is has a speed, with the least time and with more") {
  const double tick = GENERATE(1.0 / 60, 1.0 / 1000), more = GENERATE(1.0, 2.0);
  const double speed = speed_within(0, more * least_seconds(0, tick), tick);
  PinMove move;
  move.speed = speed;
  CHECK_NOTHROW(validate(move));
}
