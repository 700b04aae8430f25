#include "core/solver/relaxation.h"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;
using namespace weft::test;

namespace {

/// Particles on the x axis, one behind the other, joined by springs of rest length 1 m.
struct Chain {
  ClothModel<double> model;
  ClothState<double> state;
  RelaxationDef solver;
  Surroundings<double> surroundings;

  Chain(std::initializer_list<double> places, double stiffness, double mass) {
    ClothDef def;
    def.rows = def.columns = 2;
    def.fabric.bending_warp = def.fabric.bending_weft = 0;
    model = build_cloth<double>(def);
    model.parts[0].grid_springs.reset();  // a chain is no grid
    model.springs.clear();
    model.spring_kinds.clear();
    model.triangles.clear();
    model.mass.assign(places.size(), mass);
    for (const double place : places) state.x.emplace_back(place, 0, 0);
    state.v.assign(places.size(), Vec3d::Zero());
    state.inverse_mass.assign(places.size(), 1 / mass);
    for (Index i = 0; i + 1 < static_cast<Index>(places.size()); ++i) {
      model.springs.push_back({i, i + 1, 1.0, stiffness, 0.0});
      model.spring_kinds.push_back(SpringKind::warp);
    }
    const auto count = static_cast<Index>(places.size());
    model.parts[0].particles = {0, count};
    model.parts[0].springs = {0, count - 1};
    model.parts[0].triangles = {};
    solver.damping = 0;
  }
  void advance(double dt, int substeps = 1) {
    RelaxationWorkspace<double> work;
    work.prepare(model);
    Grabs<double> grabs;
    Profile profile;
    advance_relaxation<double>(model, surroundings, solver, dt, {0, substeps, substeps}, grabs, {},
                               state, work, profile);
  }
  double place(std::size_t i) const { return state.x[i][0]; }
};

WorldDef seed_world(const ClothDef& cloth) {
  WorldDef def = empty_world(cloth);
  def.model = Model::seed;
  return def;
}

}  // namespace

TEST_CASE("eqs. (3) to (5): a free particle keeps 1 - c of its motion and falls by dt^2 g") {
  // c = 1/4, dt = 1/64, v = 2 along x, g = 16: x' = (3/4)(2/64) = 0.0234375, y' = -16/64^2 =
  // -0.00390625; v' = (x' - x)/dt = (1.5, -0.25).
  Chain chain({0.0}, 1, 1);
  chain.state.v[0] = Vec3d(2, 0, 0);
  chain.solver.damping = 0.25;
  chain.surroundings.gravity = Vec3d(0, -16, 0);
  chain.advance(1.0 / 64);
  CHECK(chain.state.x[0] == Vec3d(0.0234375, -0.00390625, 0));
  CHECK(chain.state.v[0] == Vec3d(1.5, -0.25, 0));
}

TEST_CASE("a tick takes 1 - c of a free particle's motion, in however many substeps") {
  for (const int substeps : {1, 2, 16, 64}) {
    INFO(substeps << " substeps");
    Chain chain({0.0}, 1, 1);
    chain.state.v[0] = Vec3d(2, 0, 0);
    chain.solver.damping = 0.25;
    chain.advance(1.0 / 64 / substeps, substeps);
    CHECK(chain.state.v[0][0] == Approx(1.5).epsilon(1e-12));
  }
}

TEST_CASE("Provot: a spring too long or too short by d moves each end by d/2") {
  Chain chain({0.0, 1.3}, 1, 1);
  chain.solver.sweeps = 1;
  SECTION("too long: delta = 1.3, corr = 1.3 (1 - 1/1.3)/2 = 0.15") {
    chain.advance(0.1);
    CHECK(chain.place(0) == Approx(0.15).margin(1e-15));
    CHECK(chain.place(1) == Approx(1.15));
  }
  SECTION("too short: delta = 0.8, corr = 0.8 (1 - 1/0.8)/2 = -0.1") {
    chain.state.x[1][0] = 0.8;
    chain.advance(0.1);
    CHECK(chain.place(0) == Approx(-0.1));
    CHECK(chain.place(1) == Approx(0.9));
  }
  SECTION("a fixed end leaves all of it to the other") {
    chain.state.inverse_mass[0] = 0;
    chain.advance(0.1);
    CHECK(chain.place(0) == 0);
    CHECK(chain.place(1) == Approx(1));
  }
  SECTION("three times the mass moves a third as far: 0.3 = 0.075 + 0.225") {
    chain.state.inverse_mass[0] = 1.0 / 3;
    chain.advance(0.1);
    CHECK(chain.place(0) == Approx(0.075));
    CHECK(chain.place(1) == Approx(1.075));
  }
  SECTION("ends that coincide stay: they have no direction") {
    chain.state.x[1][0] = 0;
    chain.advance(0.1);
    CHECK(chain.place(1) == 0);
  }
}

TEST_CASE("k sweeps run forwards and backwards in turn") {
  // Fixed at 0, then 1 and 2.4. First sweep: spring a fits; b is 1.4 long: 1.2 and 2.2. Second
  // sweep, backwards: b fits, a is 1.2 long and its left end fixed: 1.0. Third: b is 1.2 long:
  // 1.1 and 2.1.
  const auto [sweeps, middle, end] =
      GENERATE(table<int, double, double>({{1, 1.2, 2.2}, {2, 1.0, 2.2}, {3, 1.1, 2.1}}));
  Chain chain({0.0, 1.0, 2.4}, 1, 1);
  chain.state.inverse_mass[0] = 0;
  chain.solver.sweeps = sweeps;
  chain.advance(0.1);
  CHECK(chain.place(1) == Approx(middle));
  CHECK(chain.place(2) == Approx(end));
}

TEST_CASE("XPBD: a compliant spring stops where its multiplier says, however many sweeps follow") {
  // k = 100, dt = 0.1: alpha~ = 1/(100 * 0.01) = 1. C = 0.3, w = 1 + 1: lambda = 0.3/(2 + 1) = 0.1
  // moves each end by 0.1. The next sweep finds C = 0.1 = alpha~ lambda: nothing is left to do.
  Chain chain({0.0, 1.3}, 100, 1);
  chain.solver.compliance = 1;
  chain.solver.sweeps = GENERATE(1, 2, 7);
  chain.advance(0.1);
  CHECK(chain.place(0) == Approx(0.1));
  CHECK(chain.place(1) == Approx(1.2));
}

namespace {

/// The seed as its text has it: positions of two steps, eq. (5), Provot's correction.
template <class Real>
struct LiteralSeed {
  Vec3Array<Real> x, before;

  void step(const ClothModel<Real>& model, const std::vector<Real>& w, const Vec3<Real>& gravity,
            Real c, Real dt, int sweeps) {
    const Vec3Array<Real> now = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (w[i] > 0) x[i] += (now[i] - before[i]) * (Real(1) - c) + gravity * (dt * dt);
    }
    before = now;
    const auto count = static_cast<int>(model.springs.size());
    for (int s = 0; s < sweeps; ++s) {
      for (int n = 0; n < count; ++n) {
        const Spring<Real>& spring =
            model.springs[static_cast<std::size_t>(s % 2 == 0 ? n : count - 1 - n)];
        Vec3<Real>& x1 = x[static_cast<std::size_t>(spring.i)];
        Vec3<Real>& x2 = x[static_cast<std::size_t>(spring.j)];
        const bool fixed1 = w[static_cast<std::size_t>(spring.i)] == 0;
        const bool fixed2 = w[static_cast<std::size_t>(spring.j)] == 0;
        if (fixed1 && fixed2) continue;
        const Vec3<Real> delta = x2 - x1;
        const Vec3<Real> all = delta * (Real(1) - spring.rest_length / delta.norm());
        if (!fixed1) x1 += fixed2 ? all : (all / 2).eval();
        if (!fixed2) x2 -= fixed1 ? all : (all / 2).eval();
      }
    }
  }
};

}  // namespace

TEMPLATE_TEST_CASE("compliance 0, one substep, k sweeps is the seed, but for rounding", "", float,
                   double) {
  // The seed moves positions, whose last bits the solver's displacements do not lose.
  const double apart = 1000 * static_cast<double>(std::numeric_limits<TestType>::epsilon());
  ClothDef cloth = flat_cloth(9, 12);
  cloth.mass_lumping = MassLumping::equal;
  cloth.skip_stiffness = 1;  // the third kind of springs
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  WorldDef def = seed_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 1);
  def.tick_rate = 64;
  def.relaxation.sweeps = 7;
  def.relaxation.damping = 0.03125;
  def.pins = {{0, 0}, {11, 0}};
  World<TestType> world(def);
  SeededRandom random(5);
  world.state().x = shaken(world.model(), 0.01, random);
  world.accept_state();
  LiteralSeed<TestType> seed{world.state().x, world.state().x};
  const Vec3<TestType> gravity = def.environment.gravity.cast<TestType>();
  for (int tick = 0; tick < 100; ++tick) {
    world.step();
    REQUIRE(world.report().substeps == 1);
    seed.step(world.model(), world.state().inverse_mass, gravity, TestType(0.03125),
              TestType(1) / 64, 7);
    for (std::size_t i = 0; i < seed.x.size(); ++i) {
      INFO("tick " << tick << " particle " << i);
      REQUIRE(static_cast<double>((seed.x[i] - world.state().x[i]).norm()) < apart);
    }
  }
}

TEST_CASE("sweeps over 256 x 256 rigid edges do not diverge, and stretch less than one sweep may",
          "[.long]") {
  // A sweep hands a pull on by one cell or so, so a substep h with one sweep leaves a false stretch
  // of up to g h^2 N^2 / length; several sweeps leave less.
  ClothDef cloth = flat_cloth(256, 256);
  cloth.v = -Vec3d::UnitY();
  WorldDef def = seed_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.relaxation.sweeps = 4;
  def.relaxation.substeps = 16;
  // Sweeps that start at the pins, and sweeps that start at the free end.
  const Index first_pin = GENERATE(0, 255 * 256);
  if (first_pin > 0) def.environment.gravity *= -1;
  for (Index i = 0; i < 256; ++i) def.pins.push_back({first_pin + i, 0});
  World<float> world(def);
  const double h = world.tick_seconds() / world.def().relaxation.substeps;
  const double bound = 9.81 * h * h * 256 * 256;
  double largest = 0, liveliest = 0;
  for (int tick = 0; tick < 24; ++tick) {
    const TickReport& report = world.step();
    REQUIRE_FALSE(report.divergence);
    largest = std::max(largest, report.largest_strain);
    liveliest = std::max(liveliest, report.energies.kinetic);
  }
  CHECK(largest < bound);
  CHECK(world.report().energies.kinetic < liveliest / 100);
}

TEST_CASE("more sweeps over 256 x 256 rigid edges leave less of a shake, and never more") {
  // Positions alone: the cloth is at rest in vacuum, so a substep is nothing but its sweeps.
  ClothDef cloth = flat_cloth(256, 256);
  cloth.skip_stiffness = 1;  // all three kinds of springs
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  WorldDef def = seed_world(cloth);
  def.pins = {{0, 0, {}}, {255, 0, {}}};
  const auto residual = [&](int sweeps) {
    def.relaxation.sweeps = sweeps;
    World<float> world(def);
    SeededRandom random(6);
    world.state().x = shaken(world.model(), 0.1 / 255, random);
    world.accept_state();
    REQUIRE_FALSE(world.step().divergence);
    double sum = 0;
    for (const Spring<float>& s : world.model().springs) {
      const auto i = static_cast<std::size_t>(s.i), j = static_cast<std::size_t>(s.j);
      const Vec3f span = world.state().x[j] - world.state().x[i];
      const double excess = static_cast<double>(span.norm() / s.rest_length) - 1;
      sum += excess * excess;
    }
    return std::sqrt(sum / static_cast<double>(world.model().springs.size()));
  };
  double before = residual(1);
  CHECK(before < 0.1);
  const double first = before;
  for (const int sweeps : {2, 4, 8, 16, 32}) {
    const double left = residual(sweeps);
    INFO(sweeps << " sweeps leave " << left << " of " << before);
    CHECK(left < before);
    before = left;
  }
  CHECK(before < first / 3);
}

TEST_CASE("with the fabric's compliance a strip hangs as long as Hooke says") {
  // A strip of stiffness Y under its own weight: strain sigma g (L - y) / Y, elongation
  // sigma g L^2 / (2 Y); its lumped form pulls each spring with what hangs below its middle,
  // which has the same sum.
  ClothDef cloth = flat_cloth(11, 2, 0.1, 1);
  cloth.v = -Vec3d::UnitY();
  cloth.fabric.shear = 0;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 100;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
  WorldDef def = seed_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.relaxation.compliance = 1;
  def.relaxation.sweeps = 20;
  def.relaxation.substeps = 4;
  def.relaxation.damping = 0.02;
  def.pins = {{0, 0}, {1, 0}};
  World<double> world(def);
  advance(world, 10);
  const double length = -world.state().x.back()[1];
  CHECK(length - 1 == Approx(0.2 * 9.81 / (2 * 100)).epsilon(1e-3));
}

TEST_CASE("relaxation is chosen by name or by the model, and a wrong word is answered") {
  WorldDef def = empty_world(flat_cloth(3, 3));
  CHECK(std::string(solver_name(def)) == "verlet");
  set_field(def, "model", "seed");
  CHECK(std::string(solver_name(def)) == "relaxation");
  set_field(def, "solver.kind", "verlet");
  CHECK(std::string(solver_name(def)) == "verlet");
  set_field(def, "model", "weft");
  set_field(def, "solver.kind", "relaxation");
  CHECK(std::string(solver_name(def)) == "relaxation");
  try {
    set_field(def, "solver.kind", "euler");
    FAIL("was accepted");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "solver.kind");
    CHECK(error.value == "euler");
    CHECK(error.limit == "automatic, verlet, relaxation or implicit");
  }
  for (const FieldListing& field : list_fields(def)) {
    if (field.key == "solver.kind") CHECK(field.value == "relaxation");
  }
}

TEST_CASE("a step of relaxation takes no memory and repeats its bits") {
  ClothDef cloth = flat_cloth(20, 20);
  cloth.rest_angle = 0.2;
  WorldDef def = seed_world(cloth);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.air_density = 1.2;
  def.environment.wind = Vec3d(1, 0, 1);
  def.pins = {{0, 0.1}};
  World<float> world(def), again(def);
  for (World<float>* w : {&world, &again}) {
    w->grab({50, {0.2, 0.3, 0.5}, 0.1, 100, 20, Vec3d(0, 0.5, 0)});
    for (int tick = 0; tick < 10; ++tick) w->step();
  }
  const std::size_t before = count_allocations();
  for (int tick = 0; tick < 10; ++tick) world.step();
  CHECK(count_allocations() == before);
  for (int tick = 0; tick < 10; ++tick) again.step();
  CHECK(world.hash() == again.hash());
}
