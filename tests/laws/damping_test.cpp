#include <cmath>
#include <complex>
#include <iostream>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_modes.h"
#include "core/diagnostics/energies.h"
#include "core/forces/force_pass.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// Damping belongs to the fabric: a wave or mode decays with the relaxation time of what it
// deforms, whatever the mesh and the substeps.

using namespace weft;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLength = 1;  // of the strip along the warp, held at both ends [m]

/// One half wave along a strip, in a direction in which the strip is deformed in one way only.
struct Mode {
  ClothDef strip;
  Vec3d direction;       ///< of its motion
  double omega2 = 0;     ///< of the continuum [1/s^2]
  double time = 0;       ///< relaxation time of what it deforms [s]
  double narrowing = 0;  ///< across the strip, per strain along it

  double shape(double u) const { return std::sin(kPi * u / kLength); }
};

ClothDef strip_of(int cells) {
  ClothDef strip = test::flat_cloth(3, cells + 1, kLength, 2 * kLength / cells);
  strip.fabric.bending_warp = strip.fabric.bending_weft = 0;
  return strip;
}

ClothDef strip_of(test::Cut cut, int cells) {
  return test::triangle_sheet(cut, kLength, 4 * kLength / cells, kLength / cells);
}

/// @param strip  any, without bending
Mode stretch_wave(ClothDef strip) {
  strip.fabric.bending_warp = strip.fabric.bending_weft = 0;
  if (strip.mesh)
    strip.fabric.poisson = 0;
  else
    strip.fabric.shear = 0;  // which would couple the threads
  const double wave = kPi / kLength;
  Mode mode{strip, Vec3d::UnitX()};
  mode.omega2 = wave * wave * strip.fabric.stretch_warp / strip.fabric.areal_density;
  mode.time = mode.strip.fabric.stretch_damping = 2e-4;  // more than 10 cells need
  return mode;
}

/// @param time  relaxation time of bending [s]
Mode bending_mode(ClothDef strip, double time) {
  FabricDef& f = strip.fabric;
  f.bending_warp = f.bending_weft = 1e-2;
  if (strip.mesh) f.poisson = 0;
  Mode mode{strip, strip.mesh ? Vec3d::UnitZ() : Vec3d::UnitY()};
  mode.omega2 = std::pow(kPi / kLength, 4) * f.bending_warp / f.areal_density;
  mode.time = mode.strip.fabric.bending_damping = time;
  return mode;
}

/// Amplitude, its rate and the mass of a mode.
struct Amplitude {
  double q = 0, rate = 0, mass = 0;
};

Amplitude amplitude_of(const Mode& mode, const World<double>& world) {
  Amplitude a;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const double weight = world.model().mass[i] * mode.shape(world.model().rest_positions[i][0]);
    const Vec3d moved = world.state().x[i] - world.model().rest_positions[i];
    a.q += weight * moved.dot(mode.direction);
    a.rate += weight * world.state().v[i].dot(mode.direction);
    a.mass += weight * mode.shape(world.model().rest_positions[i][0]);
  }
  a.q /= a.mass, a.rate /= a.mass;
  return a;
}

/// Narrows a strip as its strain along the warp asks for, but for what is held.
void narrow(const Mode& mode, double amplitude, World<double>& world) {
  const Vec3d weft(0, 0, 1);
  const Vec3d middle = test::centre_of_mass(world);
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    if (world.state().inverse_mass[i] == 0) continue;
    const double u = world.model().rest_positions[i][0];
    const double strain = amplitude * kPi / kLength * std::cos(kPi * u / kLength);
    Vec3d& x = world.state().x[i];
    x -= mode.narrowing * strain * weft.dot(x - middle) * weft;
  }
}

/// Rate at which the energy of the mode decays, over that of the continuum, omega^2 tau.
/// @param finer   times the substeps that it takes
/// @param decays  by exp(-decays) meanwhile
double decay(const Mode& mode, int finer, double decays) {
  WorldDef def = test::empty_world(mode.strip);
  def.environment.gravity = Vec3d::Zero();
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  const double expected = mode.omega2 * mode.time, seconds = decays / expected;
  const int ticks = static_cast<int>(std::ceil(20 * seconds));
  def.tick_rate = ticks / seconds;
  def.solver.min_substeps =
      finer * static_cast<int>(World<double>(def).cost_in(def.environment).substeps);
  World<double> world(def);
  const auto elastic = [&] {
    const ElasticEnergy energy = elastic_energy(world.model(), world.state().x);
    return energy.stretch + energy.bending;
  };
  const double flat = elastic();  // links of a mesh that are left out leave it something
  for (std::size_t i = 0; i < world.state().x.size(); ++i)
    world.state().x[i] += 1e-5 * mode.shape(world.model().rest_positions[i][0]) * mode.direction;
  narrow(mode, 1e-5, world);
  world.accept_state();
  const Amplitude start = amplitude_of(mode, world);
  const double omega2 = 2 * (elastic() - flat) / (start.mass * start.q * start.q);
  // Of q'' + 2 gamma q' + omega^2 q = 0 this falls by exp(-2 gamma t), without a ripple.
  const auto size = [&](const Amplitude& a) {
    return a.rate * a.rate + omega2 * a.q * a.q + expected * a.q * a.rate;
  };
  for (int tick = 0; tick < ticks; ++tick) REQUIRE_FALSE(world.step().divergence);
  return std::log(size(start) / size(amplitude_of(mode, world))) / decays;
}

void check_decay(const std::string& name, const Mode& mode, int finer, double decays) {
  const double measured = decay(mode, finer, decays);
  std::cout << name << ", " << finer << " times the substeps: decay " << measured
            << " of the continuum's" << std::endl;
  CHECK(measured == Approx(1).epsilon(0.05));
}

}  // namespace

TEST_CASE("a stretch wave decays by omega^2 tau on any grid and mesh, to 5 %") {
  const int cells = GENERATE(10, 20, 40);
  const int finer = GENERATE(1, 4);
  const std::string name = "stretch, " + std::to_string(cells) + " cells";
  check_decay(name, stretch_wave(strip_of(cells)), finer, 1);
  for (const test::Cut cut : test::kCuts)
    check_decay(name + ", " + test::name_of(cut), stretch_wave(strip_of(cut, cells)), finer, 1);
}

TEST_CASE("a strip of a grid stretches and decays as both of its dashpots say, to 5 %") {
  const auto [stretch, shear] =
      GENERATE(table<double, double>({{1e-3, 1e-3}, {1e-3, 0.0}, {1e-3, 1.5e-3}, {5e-4, 2e-3}}));
  constexpr int kCells = 120;  // a narrow strip: at its held ends it cannot narrow
  Mode mode{strip_of(kCells), Vec3d::UnitX()};
  FabricDef& f = mode.strip.fabric;
  f.stretch_warp = f.stretch_weft = 100;
  f.shear = 50;
  f.damping_ratio = 0;
  f.stretch_damping = stretch;
  f.shear_damping = shear;
  mode.narrowing = 0.5;
  const double omega = angular_frequency(f, FabricMode::stretch, kLength);
  mode.omega2 = omega * omega;
  mode.time = stretch_relaxation_on_grid(f, kLength / kCells, kLength / kCells);
  check_decay("stretch, " + std::to_string(stretch) + " s and " + std::to_string(shear) + " s",
              mode, 2, 1);
  // The way back, where the diagonals do not damp more than was asked for.
  if (stretch < least_stretch_damping_on_grid(f, 1, 1)) return;
  CHECK(stretch_damping_on_grid(f, mode.time) == Approx(stretch));
}

TEST_CASE("a bending mode decays by omega^2 tau on any grid and mesh, to 5 %") {
  const int cells = GENERATE(10, 20, 40);
  const int finer = GENERATE(1, 4);
  constexpr double kTime = 2e-2, kDecays = 0.5;
  const std::string name = "bending, " + std::to_string(cells) + " cells";
  check_decay(name, bending_mode(strip_of(cells), kTime), finer, kDecays);
  for (const test::Cut cut : test::kCuts)
    check_decay(name + ", " + test::name_of(cut), bending_mode(strip_of(cut, cells), kTime), finer,
                kDecays);
}

namespace {

/// A strip that is held level at one end and swings in the shape of its first mode.
struct SwingingStrip {
  static constexpr int kCells = 10, kHeld = 2;
  static constexpr double kFree = 0.2, kCell = kFree / kCells;
  WorldDef def;

  SwingingStrip() {
    ClothDef strip = test::flat_cloth(3, kCells + kHeld + 1, (kCells + kHeld) * kCell, 2 * kCell);
    strip.fabric.bending_warp = strip.fabric.bending_weft = 4e-2;
    strip.fabric.damping_ratio = 0;
    def = test::empty_world(strip);
    def.pins = {{EdgeStrip{Side::left, kHeld * kCell}, 0, {}}};
  }

  FabricDef& fabric() { return def.cloths[0].fabric; }
  double omega() const {
    return angular_frequency(def.cloths[0].fabric, FabricMode::bending, kFree);
  }

  /// Rate at which its amplitude decays [1/s].
  double decay() const {
    World<double> world(def);
    const double root = 1.8751040687119612;
    const double turn = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root));
    for (std::size_t i = 0; i < world.state().v.size(); ++i) {
      const double s = root * (world.model().rest_positions[i][0] - kHeld * kCell) / kFree;
      if (s <= 1e-9) continue;
      const double shape = std::cosh(s) - std::cos(s) - turn * (std::sinh(s) - std::sin(s));
      world.state().v[i] = Vec3d(0, 1e-4 * shape, 0);
    }
    world.accept_state();
    const auto energy = [&] {
      return world.report().energies.kinetic + world.report().energies.bending;
    };
    test::advance(world, 0.1);
    const double before = energy();
    constexpr double kSeconds = 2;
    test::advance(world, kSeconds);
    return std::log(before / energy()) / (2 * kSeconds);
  }
};

}  // namespace

TEST_CASE("a decay time that was measured, converted, is what a strip of the fabric has") {
  constexpr double kDecay = 1.5;
  SwingingStrip strip;
  strip.fabric().bending_damping = relaxation_of_decay(strip.omega(), kDecay);
  const double decay_time = 1 / strip.decay();
  std::cout << "cantilever: decays in " << decay_time << " s of " << kDecay << std::endl;
  CHECK(decay_time == Approx(kDecay).epsilon(0.05));
}

TEST_CASE(
    "a strip with a loss factor above 2 creeps, and its decay time is that of a creep, to 5 %") {
  SwingingStrip strip;
  strip.def.tick_rate = 1000;  // the dashpots act once a tick
  strip.fabric().bending_damping = relaxation_of_loss(strip.omega(), 10);
  REQUIRE(creeps(strip.omega(), strip.fabric().bending_damping));
  const double told = decay_time(strip.omega(), strip.fabric().bending_damping),
               measured = 1 / strip.decay();
  std::cout << "cantilever that creeps: falls in " << measured << " s of " << told << std::endl;
  CHECK(measured == Approx(told).epsilon(0.05));
}

TEST_CASE("decay times are those of the damped oscillator, the shortest that of critical damping") {
  const double omega = 7;
  for (const double loss : {0.01, 0.5, 1.999, 2.0, 2.001, 3.0, 50.0}) {
    const double tau = relaxation_of_loss(omega, loss), time = decay_time(omega, tau);
    CAPTURE(loss);
    // Of s^2 + omega^2 tau s + omega^2 = 0 the root with the larger real part.
    const std::complex<double> half = omega * omega * tau / 2,
                               root = -half + std::sqrt(half * half - omega * omega);
    CHECK(time == Approx(-1 / root.real()));
    CHECK(time >= shortest_decay_time(omega) * (1 - 1e-12));
    CHECK(creeps(omega, tau) == (loss > 2));
    if (loss <= 2) CHECK(relaxation_of_decay(omega, time) == Approx(tau));
  }
  CHECK(decay_time(omega, 2 / omega) == Approx(shortest_decay_time(omega)));
}

TEST_CASE("every solver damps bending by omega^2 tau beside what it loses by itself, to 10 %") {
  const SolverKind kind = GENERATE(SolverKind::implicit, SolverKind::relaxation);
  SwingingStrip strip;
  strip.def.solver.kind = kind;
  strip.def.implicit.substeps = 32;
  strip.def.relaxation.substeps = 64;
  strip.def.relaxation.compliance = 1;
  strip.def.relaxation.sweeps = 2;
  strip.def.relaxation.damping = 0;
  const double alone = strip.decay(), rate = 1;
  strip.fabric().bending_damping = relaxation_of_decay(strip.omega(), 1 / rate);
  const double damped = strip.decay();
  std::cout << (kind == SolverKind::implicit ? "implicit" : "XPBD") << ": decays by " << alone
            << "/s alone, and by " << damped << "/s with " << rate << "/s of its own" << std::endl;
  CHECK(damped - alone == Approx(rate).epsilon(0.1));
}

namespace {

/// Loss of a cloth at rest whose velocities are those of a uniform rate of strain, over its area
/// and the square of the rate [N s/m].
/// @param weft  its direction in space
double loss(const ClothModel<double>& model, const Vec3d& weft, double u, double v, double shear) {
  Vec3Array<double> rate, force(model.mass.size(), Vec3d::Zero());
  for (const auto& place : model.material)
    rate.push_back((u * place[0] + shear * place[1]) * Vec3d::UnitX() + v * place[1] * weft);
  add_spring_forces(model, model.rest_positions, rate, force);
  add_membrane_forces(model, model.rest_positions, rate, force);
  double power = 0, area = 0;
  for (std::size_t i = 0; i < rate.size(); ++i) power -= force[i].dot(rate[i]);
  for (const double a : model.triangle_area) area += a;
  return power / area;
}

}  // namespace

TEST_CASE(
    "the dashpots of grid and mesh have the tensor tau C, but C12 of a grid the tau of shear") {
  FabricDef f;
  f.stretch_warp = 500;
  f.stretch_weft = 300;
  f.shear = 60;
  const auto [stretch, shear] =
      GENERATE(table<double, double>({{1e-3, 1e-3}, {1e-3, 4e-3}, {4e-3, 1e-3}, {0.0, 1e-3}}));
  f.stretch_damping = stretch;
  f.shear_damping = shear;
  ClothDef grid = test::flat_cloth(9, 11, 1, 0.8);
  ClothDef mesh = test::triangle_sheet(test::Cut::irregular, 1, 0.8, 0.1);
  for (ClothDef* cloth : {&grid, &mesh}) {
    cloth->fabric = f;
    INFO((cloth->mesh ? "mesh, " : "grid, ") << stretch << " s, " << shear << " s");
    const ClothModel<double> model = build_cloth<double>(*cloth);
    const double least = least_relaxation_time(model.parts[0]);
    REQUIRE(least < 1e-3);
    const Vec3d weft = cloth->mesh ? Vec3d(0, -1, 0) : Vec3d(0, 0, 1);
    CHECK(loss(model, weft, 0, 0, 1) == Approx(shear * 60));
    if (stretch == 0 && !cloth->mesh) {
      // The diagonals resist stretch too.
      CHECK(loss(model, weft, 1, 0, 0) > least * 500);
      continue;
    }
    const double own = std::max(stretch, least);
    CHECK(loss(model, weft, 1, 0, 0) == Approx(own * 500));
    CHECK(loss(model, weft, 0, 1, 0) == Approx(own * 300));
    const double coupled = 60 * (cloth->mesh ? own : shear);
    CHECK(loss(model, weft, 1, 1, 0) == Approx(own * 800 + 2 * coupled));
  }
}

TEST_CASE("without relaxation times a fabric is damped as stability needs, and no more") {
  const ClothModel<double> grid = build_cloth<double>(strip_of(20));
  const double least = least_relaxation_time(grid.parts[0]);
  CHECK(least == Approx(2 * 0.05 / std::sqrt(grid.parts[0].bounds.membrane_omega2)));
  for (const Spring<double>& s : grid.springs) CHECK(s.damping == Approx(least * s.stiffness));
}

TEST_CASE("dashpots of bending bring no energy to cloth that all but rests, with any solver") {
  // Bending sets the substeps, so that its fastest mode is near their limit.
  const auto [kind, compliance] = GENERATE(table<SolverKind, double>(
      {{SolverKind::verlet, 0.0}, {SolverKind::relaxation, 1.0}, {SolverKind::relaxation, 0.0}}));
  const double time = GENERATE(1e-4, 1e-3, 1e-2);
  CAPTURE(static_cast<int>(kind), compliance, time);
  ClothDef sheet = test::flat_cloth(11, 11, 0.1, 0.1);
  sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-3;
  sheet.fabric.bending_damping = time;
  WorldDef def = test::empty_world(sheet);
  def.solver.kind = kind;
  def.relaxation.compliance = compliance;
  def.relaxation.substeps = 8;
  def.relaxation.sweeps = 4;
  def.relaxation.damping = 0;
  World<double> flat(def);
  StartDef start;
  for (std::size_t i = 0; i < flat.state().x.size(); ++i) {
    const double off = 1e-9 * (static_cast<double>(i * 7919 % 13) - 6);
    start.x.push_back(flat.state().x[i] + Vec3d(0, off, 0));
  }
  def.start = start;
  World<double> world(def);
  const auto energy = [&world] {
    const Energies now = world.step().energies;
    return now.bending + now.kinetic;
  };
  const double before = energy();
  test::advance(world, 8);
  CHECK(energy() < before);
}
