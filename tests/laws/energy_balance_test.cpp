#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::SeededRandom;

namespace {

/// A cloth of half a metre that hangs by its top edge, level at first, and swings down.
WorldDef swinging(SolverKind kind = SolverKind::verlet) {
  ClothDef cloth = test::flat_cloth(11, 11, 0.5, 0.5);
  cloth.fabric.damping_ratio = 0;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-4;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  for (int column = 0; column < 11; ++column) def.pins.push_back({column, 0});
  def.solver.kind = kind;
  return def;
}

/// Energies that came in, went out and moved about: what a residual is to be measured by.
template <class Real>
double turnover(const World<Real>& world, const EnergyBalance& balance) {
  double sum = std::abs(world.report().energies.gravity - balance.start);
  visit_work(balance.flows, [&sum](const char*, double work) { sum += std::abs(work); });
  visit_losses(balance.flows, [&sum](const char*, double loss) { sum += std::abs(loss); });
  return sum;
}

double lost_in(const WorldDef& def, double seconds) {
  World<double> world(def);
  world.measure_energy(true);
  test::advance(world, seconds);
  return world.energy_balance()->lost();
}

WorldDef with_everything(SolverKind kind) {
  WorldDef def = swinging(kind);
  def.cloths[0].fabric.damping_ratio = 0.05;
  def.environment.damping = 0.5;
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(1, 0, 2);
  def.environment.gust_speed = 1;
  def.colliders = {{"ball", SphereDef{Vec3d(0.1, -0.2, 0.1), 0.12}}};
  return def;
}

}  // namespace

TEST_CASE("without damping a balance lacks only the integrator's error, second order in the step") {
  WorldDef def = swinging();
  const auto lost = [&def](int substeps) {
    def.solver.min_substeps = substeps;
    return std::abs(lost_in(def, 0.25));
  };
  const double coarse = lost(40), fine = lost(80);
  CHECK(coarse < 1e-2);
  CHECK(coarse / fine == Approx(4).epsilon(0.15));
}

TEST_CASE("no position changes by a bit when the energy is balanced") {
  const SolverKind kind =
      GENERATE(SolverKind::verlet, SolverKind::relaxation, SolverKind::implicit);
  const bool alone = GENERATE(true, false);
  WorldDef def = alone ? swinging(kind) : with_everything(kind);
  def.relaxation.compliance = 1;
  if (!alone) def.contact.seed.self = SelfContact::automatic;
  World<float> plain(def), balanced(def);
  balanced.measure_energy(true);
  test::advance(plain, 0.5);
  test::advance(balanced, 0.5);
  CHECK(balanced.hash() == plain.hash());
}

TEST_CASE("a strip that a hand lifts slowly gains the hand's work, to 1 %") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 5;
  def.pins = {{0, 0}};
  World<float> world(def);
  test::settle(world, 5, 4);
  GrabDef grab;
  grab.triangle = static_cast<Index>(world.model().triangles.size()) - 1;
  for (std::size_t k = 0; k < 3; ++k)
    grab.target +=
        grab.barycentric[k] *
        world.state().x[static_cast<std::size_t>(world.model().triangles.back()[k])].cast<double>();
  const Vec3d low = grab.target;
  const GrabId hand = world.grab(grab);
  test::advance(world, 1);
  world.measure_energy(true);
  const Energies before = world.report().energies;
  for (int tick = 1; tick <= 240; ++tick) {
    world.move_grab(hand, low + Vec3d(0, 0.1 * tick / 240, 0));
    world.step();
  }
  test::advance(world, 1);
  const EnergyBalance& balance = *world.energy_balance();
  const double gained = world.report().energies.total() - before.total();
  CHECK(gained > 1e-4);
  CHECK(balance.flows.hands - balance.flows.drag - balance.flows.damping ==
        Approx(gained).epsilon(0.01));
}

TEST_CASE("what falls on the ground and lies there has lost there all that it fell, to 2 %") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -0.2, 0), Vec3d::UnitY()}}};
  World<float> world(def);
  world.measure_energy(true);
  const double start = world.report().energies.total();
  test::advance(world, 1.5);
  const EnergyBalance& balance = *world.energy_balance();
  const double fell = start - world.report().energies.total();
  CHECK(fell > 0.01);
  CHECK(balance.flows.impacts + balance.flows.friction + balance.flows.damping ==
        Approx(fell).epsilon(0.02));
  CHECK(balance.flows.objects == 0);
}

TEST_CASE("a pin that lifts a cloth does the work of its weight, to 0.5 %") {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9, 0.4, 0.4));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.pins = {{40, 0.02}};
  World<float> world(def);
  test::settle(world, 5, 4);
  world.measure_energy(true);
  const double start = world.report().energies.total();
  PinMove move;
  move.target = world.state().x[40].cast<double>() + Vec3d(0, 0.2, 0);
  move.speed = 0.1;
  REQUIRE(world.move_pin(world.pins().list[0].id, move));
  test::advance(world, 6);
  const EnergyBalance& balance = *world.energy_balance();
  const double mass = 0.16 * world.def().cloths[0].fabric.areal_density;
  CHECK(world.report().energies.total() - start == Approx(mass * 9.81 * 0.2).epsilon(5e-3));
  CHECK(balance.flows.pins - balance.flows.drag - balance.flows.damping ==
        Approx(mass * 9.81 * 0.2).epsilon(5e-3));
}

TEST_CASE("with implicit too a moving pin's work is its force times its way, and little is lost") {
  for (const int substeps : {1, 8, 32}) {
    INFO(substeps << " substeps");
    ClothDef cloth = test::flat_cloth(13, 17, 0.4, 0.3);
    cloth.fabric.stretch_damping = 2e-3;
    WorldDef def = test::empty_world(cloth);
    def.environment.gravity = Vec3d(0, -9.81, 0);
    def.solver.kind = SolverKind::implicit;
    def.implicit.substeps = substeps;
    def.pins = {{0, 0.03}, {16, 0.03}};
    World<double> world(def);
    world.measure_energy(true);
    world.measure_forces(true);
    for (const Pin& pin : world.pins().list) {
      PinMove move;
      move.target = world.state().x[static_cast<std::size_t>(pin.centre)] + Vec3d(0.2, 0.1, 0.3);
      move.speed = 1;
      REQUIRE(world.move_pin(pin.id, move));
    }
    double work = 0;
    std::array<Vec3d, 2> at;
    const auto place = [&](std::size_t k) {
      return world.state().x[static_cast<std::size_t>(world.pins().list[k].centre)];
    };
    while (world.pins().any_moving()) {
      REQUIRE(world.tick() < 60);
      for (std::size_t k = 0; k < 2; ++k) at[k] = place(k);
      world.step();
      for (std::size_t k = 0; k < 2; ++k)
        work += world.reactions()->pins[k].force.dot(place(k) - at[k]);
    }
    const EnergyBalance& balance = *world.energy_balance();
    REQUIRE(work > 0.03);
    CHECK(balance.flows.pins == Approx(work).epsilon(0.03));
    CHECK(std::abs(balance.lost()) < 0.05 * work);
    CHECK(world.report().implicit == ImplicitStatus::driven);
    CHECK(world.step().implicit == ImplicitStatus::done);
  }
}

TEST_CASE("the air gets from a cloth at rest in a fan's jet all the work of the fan") {
  WorldDef def = test::empty_world(test::flat_cloth(7, 7));
  for (Index i = 0; i < 49; ++i) def.pins.push_back({i, 0});
  def.environment.air_density = 1.225;
  FanDef fan;
  fan.position = Vec3d(0.5, -1, 0.5);
  fan.direction = Vec3d(0, 1, 0);
  def.environment.fans = {fan};
  World<float> world(def);
  world.measure_energy(true);
  test::advance(world, 0.5);
  const EnergyFlows& flows = world.energy_balance()->flows;
  CHECK(flows.wind > 0.01);
  CHECK(flows.air == Approx(flows.wind).epsilon(1e-9));
  CHECK(std::abs(world.energy_balance()->lost()) < 1e-9);
}

TEST_CASE("air, drag, dashpots and contact together leave verlet a residual below 2 %") {
  World<float> world(with_everything(SolverKind::verlet));
  world.measure_energy(true);
  test::advance(world, 1);
  const EnergyBalance& balance = *world.energy_balance();
  CHECK(balance.flows.wind != 0);
  CHECK(balance.flows.air > 0);
  CHECK(balance.flows.drag > 0);
  CHECK(balance.flows.damping > 0);
  CHECK(balance.flows.impacts + balance.flows.friction > 0);
  CHECK(std::abs(balance.lost()) < 0.02 * turnover(world, balance));
}

TEST_CASE("what dashpots of bending take is in the balance: it lacks as little as without") {
  WorldDef def = swinging();
  def.solver.min_substeps = 80;
  const double undamped = std::abs(lost_in(def, 0.25));
  def.cloths[0].fabric.bending_damping = 1;
  World<double> world(def);
  world.measure_energy(true);
  test::advance(world, 0.25);
  CHECK(world.energy_balance()->flows.damping > 20 * undamped);
  CHECK(std::abs(world.energy_balance()->lost()) < 2 * undamped);
}

TEST_CASE("what implicit loses by its steps is what verlet has more, to 20 %") {
  WorldDef def = swinging(SolverKind::implicit);
  def.implicit.substeps = 2;
  def.environment.damping = 0.1;
  World<double> implicit(def);
  def.solver.kind = SolverKind::verlet;
  World<double> verlet(def);
  implicit.measure_energy(true);
  test::advance(implicit, 0.5);
  test::advance(verlet, 0.5);
  const double less = verlet.report().energies.total() - implicit.report().energies.total();
  CHECK(less > 0.001);
  CHECK(implicit.energy_balance()->lost() == Approx(less).epsilon(0.2));
}

TEST_CASE("a repeated, halted or reset world keeps the balance of the ticks that count") {
  World<float> world(with_everything(SolverKind::verlet));
  world.measure_energy(true);
  test::advance(world, 0.2);
  const double lost = world.energy_balance()->lost(), wind = world.energy_balance()->flows.wind;
  world.halt();
  CHECK(world.energy_balance()->lost() == lost);
  CHECK(world.energy_balance()->flows.wind == wind);
  world.reset();
  CHECK(world.energy_balance()->lost() == 0);
  CHECK(world.energy_balance()->flows.wind == 0);
  world.measure_energy(false);
  CHECK(world.energy_balance() == nullptr);
}
