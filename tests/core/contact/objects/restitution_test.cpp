#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/scenes.h"
#include "core/world/verdict.h"
#include "tests/support/cloths.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"
#include "tests/support/random.h"
#include "tests/support/worlds.h"

// What hits an object comes back with a part of its speed, once, and with no energy that it did not
// bring; what rests does not bounce, however it is pressed.

using namespace weft;
using namespace weft::test;

namespace {

constexpr double kThickness = 0.004;

enum class Way { verlet, implicit, xpbd, rigid };
constexpr Way kWays[] = {Way::verlet, Way::implicit, Way::xpbd, Way::rigid};

std::string name_of(Way way) {
  const char* const names[] = {"verlet", "implicit", "XPBD", "the seed's relaxation"};
  return names[static_cast<int>(way)];
}

void choose(Way way, WorldDef& def) {
  def.solver.kind = way == Way::verlet     ? SolverKind::verlet
                    : way == Way::implicit ? SolverKind::implicit
                                           : SolverKind::relaxation;
  def.relaxation.damping = 0;
  if (way != Way::xpbd) return;
  def.relaxation.substeps = 16;
  def.relaxation.sweeps = 2;
  def.relaxation.compliance = 1;
}

/// A flat sheet over the origin, without gravity and air.
ClothDef sheet(int side, double size, double height, double restitution) {
  ClothDef cloth = flat_cloth(side, side, size, size);
  cloth.origin = Vec3d(-size / 2, height, -size / 2);
  cloth.fabric.thickness = kThickness;
  cloth.fabric.friction = 0.4;
  cloth.fabric.restitution = restitution;
  return cloth;
}

/// Sheets that come down at their speeds, one above the other.
struct Layer {
  double height, speed;
};
WorldDef layers(const std::vector<Layer>& list, double restitution, bool guarded) {
  WorldDef def = empty_world(sheet(9, 0.4, list[0].height, restitution));
  def.cloths.clear();
  for (const Layer& layer : list) {
    def.cloths.push_back(sheet(9, 0.4, layer.height, restitution));
    def.cloths.back().name = "layer " + std::to_string(def.cloths.size());
  }
  def.contact.seed.self = guarded ? SelfContact::guard : SelfContact::none;
  def.environment.damping = 0;
  def.colliders = {{"floor", PlaneDef{}}};
  return def;
}

template <class Real>
void throw_down(World<Real>& world, const std::vector<Layer>& list) {
  for (std::size_t p = 0; p < list.size(); ++p) {
    const IndexRange& range = world.model().parts[p].particles;
    for (Index i = range.first; i < range.end(); ++i)
      world.state().v[static_cast<std::size_t>(i)] =
          Vec3<Real>(0, -static_cast<Real>(list[p].speed), 0);
  }
  world.accept_state();
}

/// Mean vertical velocity of all particles [m/s].
template <class Real>
double rise(const World<Real>& world) {
  double sum = 0;
  for (const Vec3<Real>& v : world.state().v) sum += static_cast<double>(v[1]);
  return sum / static_cast<double>(world.state().v.size());
}

/// By how much the energy rises over what it was at its lowest beyond all work [J].
class EnergyRise {
 public:
  template <class Real>
  void look(const World<Real>& world) {
    given_ += world.report().work + world.report().brought;
    const double now = world.report().energies.total() - given_;
    lowest_ = std::min(lowest_, now);
    most_ = std::max(most_, now - lowest_);
  }
  double most() const { return most_; }

 private:
  double given_ = 0, lowest_ = 1e300, most_ = 0;
};

}  // namespace

TEST_CASE("a sheet that falls flat leaves with restitution times the speed it came with, 1 %") {
  for (const Way way : kWays) {
    for (const double restitution : {0.0, 0.3, 0.9}) {
      for (const bool guarded : {false, true}) {
        if (guarded && way == Way::rigid) continue;
        const std::vector<Layer> one = {{0.05, 2}};
        WorldDef def = layers(one, restitution, guarded);
        choose(way, def);
        World<float> world(def);
        throw_down(world, one);
        advance(world, 0.1);
        INFO(name_of(way) << ", restitution " << restitution << ", guarded " << guarded);
        CHECK(rise(world) == Approx(2 * restitution).epsilon(0.01).margin(2e-3));
      }
    }
  }
}

TEST_CASE("a sheet dropped flat bounces to the square of restitution times its height, 3 %") {
  constexpr double kFall = 0.4;
  for (const Way way : {Way::verlet, Way::xpbd}) {
    for (const double restitution : {0.5, 0.9}) {
      const std::vector<Layer> one = {{kThickness + kFall, 0}};
      WorldDef def = layers(one, restitution, true);
      choose(way, def);
      def.environment.gravity = Vec3d(0, -9.81, 0);
      World<float> world(def);
      bool hit = false;
      double top = 0;
      for (int tick = 0; tick < 60 && !(hit && rise(world) < 0); ++tick) {
        world.step();
        hit = hit || rise(world) > 0;
        if (hit) top = std::max(top, centre_of_mass(world)[1] - kThickness);
      }
      INFO(name_of(way) << ", restitution " << restitution);
      CHECK(top == Approx(restitution * restitution * kFall).epsilon(0.03));
    }
  }
}

TEST_CASE("an object that hits resting cloth gives and tells 1 + e times the momentum, whenever") {
  constexpr double kSpeed = 2, kRestitution = 0.5, kTickRate = 240;
  const double stretch = GENERATE(500.0, 2000.0);
  const int arrival = GENERATE(range(0, 24));
  CAPTURE(stretch, arrival);
  ClothDef cloth = flat_cloth(5, 5, 0.2, 0.2);
  cloth.fabric.thickness = 0.002;
  cloth.fabric.restitution = kRestitution;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = stretch;
  const double way = kSpeed * (0.05 + arrival / (24 * kTickRate));
  cloth.origin = Vec3d(0, 0.1 + cloth.fabric.thickness + way, 0);
  WorldDef def = empty_world(cloth);
  def.tick_rate = kTickRate;
  ColliderDef box;
  box.shape = BoxDef{Vec3d(0.1, 0, 0.1), Vec3d(0.5, 0.1, 0.5), Eigen::Quaterniond::Identity()};
  box.max_force = 1e6;
  box.motion.keyframes = {{0, Vec3d::Zero()}, {0.1, Vec3d(0, 0.1 * kSpeed, 0)}};
  def.colliders = {box};
  World<float> hit(def);
  double told = 0, mass = 0;
  for (const float m : hit.model().mass) mass += static_cast<double>(m);
  for (int t = 0; t < 20; ++t) {
    hit.step();
    told -= hit.colliders()[0].force[1] / kTickRate;
  }
  double momentum = 0;
  for (std::size_t i = 0; i < hit.state().v.size(); ++i)
    momentum += static_cast<double>(hit.state().v[i][1] * hit.model().mass[i]);
  CHECK(momentum == Approx((1 + kRestitution) * mass * kSpeed).epsilon(0.01));
  CHECK(told == Approx(momentum).epsilon(0.001));
}

TEST_CASE("what rests on an object does not bounce, whatever presses on it") {
  for (const Way way : kWays) {
    const std::vector<Layer> one = {{kThickness, 0}};
    WorldDef def = layers(one, 0.9, false);
    choose(way, def);
    def.environment.gravity = Vec3d(0, -900, 0);
    World<float> world(def);
    double fastest = 0;
    for (int tick = 0; tick < 60; ++tick) {
      world.step();
      fastest = std::max(fastest, std::abs(rise(world)));
    }
    INFO(name_of(way));
    CHECK(fastest < 0.05);
    CHECK(centre_of_mass(world)[1] == Approx(kThickness).epsilon(0.02));
  }
}

TEST_CASE("a particle that slides on the floor bounces off a wall all the same, 2 %") {
  Particles<double> one;
  one.add(Vec3d(0, kThickness, 0), Vec3d(-1, 0, 0));
  Contact<double> contact =
      one.meet({kThickness, 0, 0.8},
               {{"floor", PlaneDef{}}, {"wall", PlaneDef{Vec3d(-0.1, 0, 0), Vec3d::UnitX()}}});
  for (int tick = 0; tick < 15; ++tick) one.step(contact);
  CHECK(one.velocity(0)[0] == Approx(0.8).epsilon(0.02));
  CHECK(one.position(0)[1] == Approx(kThickness).epsilon(0.02));
}

TEST_CASE("layers that fall on a floor and each other never gain energy, with each solver") {
  const std::vector<Layer> rows[] = {{{0.02, 2}, {0.026, 2}, {0.032, 2}, {0.038, 2}},
                                     {{0.01, 0}, {0.03, 1}, {0.05, 3}},
                                     {{0.02, 1}, {0.04, 5}, {0.06, 0}}};
  for (const Way way : {Way::verlet, Way::implicit, Way::xpbd}) {
    for (const std::vector<Layer>& list : rows) {
      double gained[2] = {}, start = 0, end = 0;
      std::size_t recoveries = 0;
      for (const std::size_t bounces : {0U, 1U}) {
        WorldDef def = layers(list, bounces != 0 ? 0.9 : 0.0, true);
        choose(way, def);
        World<float> world(def);
        throw_down(world, list);
        start = world.report().energies.kinetic;
        EnergyRise rise;
        rise.look(world);
        for (int tick = 0; tick < 60; ++tick) {
          recoveries += world.step().divergence ? 1U : 0U;
          rise.look(world);
        }
        gained[bounces] = rise.most() / start;
        end = world.report().energies.kinetic;
      }
      INFO(name_of(way) << ", " << list.size() << " layers, " << start << " J");
      CHECK(recoveries == 0);
      // XPBD keeps lengths and not energy, with restitution and without.
      CHECK(gained[1] < (way == Way::xpbd ? gained[0] + 0.01 : 0.01));
      CHECK(end < 0.9 * start);  // something was hit
    }
  }
}

TEST_CASE("three sheets that fall on a box with restitution 0.9 gain no energy in 240 ticks") {
  for (const Way way : {Way::verlet, Way::implicit, Way::xpbd}) {
    WorldDef def;
    def.cloths.clear();
    for (int k = 0; k < 3; ++k) {
      ClothDef cloth = sheet(11, 0.5, 0.3 + 0.05 * k, 0.9);
      cloth.fabric = make_fabric("cotton");
      cloth.fabric.thickness = kThickness;
      cloth.fabric.friction = 0.4;
      cloth.fabric.restitution = 0.9;
      cloth.name = "sheet " + std::to_string(k);
      def.cloths.push_back(cloth);
    }
    choose(way, def);
    def.contact.seed.self = SelfContact::guard;
    def.colliders = {{"box", BoxDef{Vec3d(0, 0.1, 0), Vec3d(0.12, 0.1, 0.12)}}};
    World<float> world(def);
    Verdict<float> verdict;
    for (int tick = 0; tick < 240; ++tick) {
      world.step();
      verdict.look(world);
    }
    INFO(name_of(way));
    CHECK(verdict.recoveries == 0);
    CHECK(verdict.crossings == 0);
    CHECK(verdict.energy_excess < 0.01);
  }
}

TEST_CASE("piles that are pressed cost about the same with restitution and without") {
  struct Case {
    const char* scene;
    double restitution;
    int ticks;
  };
  for (const Case& c : {Case{"hard-squeeze", 0.9, 200}, Case{"hard-stack", 0.5, 120}}) {
    std::uint64_t rows[2] = {}, tests[2] = {}, substeps[2] = {};
    for (const std::size_t with : {0U, 1U}) {
      WorldDef def = make_scene(c.scene);
      for (ClothDef& cloth : def.cloths) cloth.fabric.restitution = with != 0 ? c.restitution : 0.0;
      World<float> world(def);
      for (int tick = 0; tick < c.ticks; ++tick) {
        const TickReport& report = world.step();
        CHECK_FALSE(report.divergence);
        rows[with] += report.profile[Stage::contact].work;
        tests[with] += report.profile[Stage::narrow_phase].work;
        substeps[with] += static_cast<std::uint64_t>(report.substeps);
        // The state of before ran for minutes.
        if (rows[1] > 4 * rows[0] && with != 0) break;
      }
    }
    INFO(c.scene);
    CHECK(rows[1] * 2 < rows[0] * 3);
    CHECK(tests[1] * 2 < tests[0] * 3);
    CHECK(substeps[1] == substeps[0]);
  }
}

TEST_CASE("triangles thrown into a wedge never gain energy in any substep") {
  Random random(3);
  for (const double restitution : {0.0, 0.6, 0.999}) {
    for (int round = 0; round < 12; ++round) {
      Particles<double> cloth;
      cloth.gravity.setZero();
      cloth.substeps = 30;
      for (int k = 0; k < 4; ++k) {
        const Vec3d at = Vec3d(0, 0.14 + 0.05 * k, 0) + random.vector(0.02);
        const auto corner = [&] {
          return cloth.add(at + random.vector(0.03), Vec3d(0, -3, 0) + random.vector(2),
                           1e-3 * std::exp(random.uniform(-2, 2)));
        };
        const Index a = corner(), b = corner(), c = corner();
        cloth.add_triangle(a, b, c, 0);  // no springs: contact alone
      }
      const double tilt = random.uniform(0.2, 2);
      Contact<double> contact = cloth.meet(
          {kThickness, 0.3, restitution}, {{"left", PlaneDef{Vec3d::Zero(), Vec3d(tilt, 1, 0.1)}},
                                           {"right", PlaneDef{Vec3d::Zero(), Vec3d(-1, tilt, 0.2)}},
                                           {"box", MeshDef{box_mesh(Vec3d(0.03, 0.05, 0.03))}}});
      double before = cloth.kinetic_energy();
      const double start = before;
      for (int tick = 0; tick < 20; ++tick) {
        cloth.step(contact, [&](const ClothState<double>&) {
          const double now = cloth.kinetic_energy();
          CHECK(now <= before * (1 + 1e-12));
          before = now;
        });
      }
      CHECK(before < 0.999 * start);
    }
  }
}

TEST_CASE("with the seed's contact a sheet leaves with restitution times its speed and no more") {
  for (const Way way : {Way::verlet, Way::implicit, Way::rigid}) {
    const std::vector<Layer> one = {{0.05, 2}};
    WorldDef def = layers(one, 0.6, false);
    choose(way, def);
    def.contact.model = ContactModel::seed;
    World<float> world(def);
    throw_down(world, one);
    const double start = world.report().energies.kinetic;
    EnergyRise gained;
    for (int tick = 0; tick < 8; ++tick) {
      gained.look(world);
      world.step();
    }
    INFO(name_of(way));
    CHECK(rise(world) == Approx(1.2).epsilon(0.01));
    CHECK(gained.most() < 0.01 * start);
  }
}
