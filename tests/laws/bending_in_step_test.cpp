#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// Damped bending that swings in step with the ticks.

using namespace weft;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLength = 0.2;  // of a strip that is held at both ends [m]
constexpr double kTime = 1e-3;   // relaxation time of its bending [s]

/// A strip whose half wave swings with so many hertz.
WorldDef strip_of(double hertz, double tick_rate, SolverKind solver) {
  ClothDef strip = test::flat_cloth(3, 13, kLength, kLength / 6);
  FabricDef& f = strip.fabric;
  f.areal_density = 0.05;
  f.bending_warp = f.bending_weft =
      f.areal_density * std::pow(2 * kPi * hertz, 2) / std::pow(kPi / kLength, 4);
  f.bending_damping = kTime;
  WorldDef def = test::empty_world(strip);
  def.pins = {{EdgeStrip{Side::left, 0}, 0, {}}, {EdgeStrip{Side::right, 0}, 0, {}}};
  def.tick_rate = tick_rate;
  def.solver.kind = solver;
  if (solver == SolverKind::relaxation) {
    def.relaxation.compliance = 1;
    def.relaxation.damping = 0;
    def.relaxation.substeps = 64;
    def.relaxation.sweeps = 2;
  }
  return def;
}

/// Rate at which the energy of the half wave decays, over omega^2 tau.
/// @param phase  of the swing at the start [rad]
double decay(double hertz, double tick_rate, double phase, SolverKind solver = SolverKind::verlet) {
  World<double> world(strip_of(hertz, tick_rate, solver));
  const double omega = 2 * kPi * hertz, rate = omega * omega * kTime;
  const auto shape = [&world](std::size_t i) {
    return std::sin(kPi * world.model().rest_positions[i][0] / kLength);
  };
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const Vec3d way = 1e-6 * shape(i) * Vec3d::UnitY();
    world.state().x[i] += std::cos(phase) * way;
    if (world.state().inverse_mass[i] > 0) world.state().v[i] -= omega * std::sin(phase) * way;
  }
  world.accept_state();
  const auto energy = [&] {
    double q = 0, speed = 0, mass = 0;
    for (std::size_t i = 0; i < world.state().x.size(); ++i) {
      q += shape(i) * world.state().x[i][1];
      speed += shape(i) * world.state().v[i][1];
      mass += shape(i) * shape(i);
    }
    return (speed * speed + omega * omega * q * q + rate * q * speed) / (mass * mass);
  };
  const double before = energy();
  const int ticks = static_cast<int>(std::ceil(3 / rate * tick_rate));
  for (int t = 0; t < ticks; ++t) REQUIRE_FALSE(world.step().divergence);
  return std::log(before / energy()) / (rate * ticks / tick_rate);
}

}  // namespace

TEST_CASE("bending that swings once in two ticks is damped by its law at any phase, to 20 %") {
  const auto [rate, hertz] = GENERATE(std::pair(60.0, 30.0), std::pair(30.0, 15.0),
                                      std::pair(30.0, 30.0), std::pair(120.0, 60.0));
  const SolverKind solver = GENERATE(SolverKind::verlet, SolverKind::relaxation);
  for (const double phase : {0.0, kPi / 4, kPi / 2, 3 * kPi / 4}) {
    CAPTURE(rate, hertz, phase);
    CHECK(decay(hertz, rate, phase, solver) == Approx(1).epsilon(0.2));
  }
}

TEST_CASE("bending that swings once in a tick of a sixtieth is damped by at least 0.4 of its law") {
  for (const double phase : {0.0, kPi / 4, kPi / 2, 3 * kPi / 4}) {
    CAPTURE(phase);
    CHECK(decay(60, 60, phase) == Approx(0.8).margin(0.4));
  }
}

TEST_CASE("bending that is not in step with the ticks is damped by its law at any rate, to 8 %") {
  const double rate = GENERATE(30.0, 55.0, 60.0, 120.0, 240.0, 1000.0);
  for (const double hertz : {10.0, 22.0, 37.0}) {
    for (const double phase : {0.0, kPi / 4, kPi / 2, 3 * kPi / 4}) {
      CAPTURE(rate, hertz, phase);
      CHECK(decay(hertz, rate, phase) == Approx(1).epsilon(0.08));
    }
  }
}
