#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

namespace weft::test {

// Hard shaking: what is done to a cloth that hangs by its upper edge, and how it takes it. Its
// rigidity is such that its rest is unique, a flat sheet: one a hundred times smaller leaves tucks
// in a cloth that may pass through itself, and they are equilibria.

enum class Insult {
  noise,    ///< every free particle gets a random velocity of 20 m/s
  crush,    ///< all free particles are put into a ball of 1 mm
  teleport  ///< the first corner is moved by 3 m for a tenth of a second, then back
};

/// One square metre in vacuum, without self-contact.
/// @param stiffness  of the structural springs [N/m]: 196 "soft", 1962 "stiff"
inline WorldDef hanging_square(int n, double stiffness, double drag) {
  WorldDef def = empty_world(flat_cloth(n, n));
  ClothDef& cloth = def.cloths[0];
  cloth.v = -Vec3d::UnitY();
  cloth.fabric.areal_density = 0.2;
  cloth.fabric.shear = 0.1 * stiffness;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 1.1 * stiffness;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-5 * stiffness;
  def.pins = {{EdgeStrip{Side::top, 0}, 0, {}}};
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.drag = drag;
  return def;
}

/// Does it to the world and declares the state good.
/// @returns energy of the state that is left [J]
template <class Real>
double insult(World<Real>& world, Insult kind) {
  Random random(20);
  ClothState<Real>& state = world.state();
  const auto first = state.x.front();
  for (std::size_t i = 0; i < state.x.size() && kind != Insult::teleport; ++i) {
    if (state.inverse_mass[i] == 0) continue;
    if (kind == Insult::noise) {
      Vec3d v = random.vector(1);
      while (v.norm() > 1 || v.norm() < 1e-3) v = random.vector(1);
      state.v[i] = (v.normalized() * 20).template cast<Real>();
    } else {
      state.x[i] = (Vec3d(0.5, -0.5, 0) + random.vector(5e-4)).template cast<Real>();
    }
  }
  if (kind == Insult::teleport) {
    state.x.front()[2] += Real(3);
    world.accept_state();
    for (int tick = 0; tick < 6; ++tick) world.step();
    state.x.front() = first;
  }
  world.accept_state();
  return world.report().energies.total();
}

/// Root of the mean square of the distance of all particles from their places at rest, over the
/// length of the cloth, which is 1 m.
template <class Real>
double distance_from(const Vec3Array<Real>& rest, const World<Real>& world) {
  double sum = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    sum += (world.state().x[i] - rest[i]).template cast<double>().squaredNorm();
  return std::sqrt(sum / static_cast<double>(rest.size()));
}

inline const char* name_of(Insult kind) {
  return kind == Insult::noise ? "noise" : kind == Insult::crush ? "crush" : "teleport";
}

inline void check_recovery(int n, double stiffness) {
  World<float> resting(hanging_square(n, stiffness, 5));
  advance(resting, 6);
  const Vec3Array<float> rest = resting.state().x;
  for (const Insult kind : {Insult::noise, Insult::crush, Insult::teleport}) {
    INFO(name_of(kind) << " at " << stiffness << " N/m");
    World<float> world(hanging_square(n, stiffness, 5));
    advance(world, 1);
    insult(world, kind);
    CHECK(distance_from(rest, world) < 5);
    for (int tick = 0; tick < 300; ++tick) REQUIRE_FALSE(world.step().divergence);
    CHECK(distance_from(rest, world) < 0.01);
    CHECK(world.report().largest_strain < 2 * resting.report().largest_strain);
  }
}

/// Energy is counted from that of the rest, which is nearly the least that there is.
inline void check_bounded_energy(int n, double stiffness) {
  World<float> resting(hanging_square(n, stiffness, 5));
  advance(resting, 6);
  const double least = resting.report().energies.total();
  for (const Insult kind : {Insult::noise, Insult::crush, Insult::teleport}) {
    INFO(name_of(kind) << " at " << stiffness << " N/m");
    World<float> world(hanging_square(n, stiffness, 0));
    advance(world, 1);
    const double brought = insult(world, kind) - least;
    REQUIRE(brought > 0);
    double most = 0;
    for (int tick = 0; tick < 300; ++tick) {
      REQUIRE_FALSE(world.step().divergence);
      most = std::max(most, world.report().energies.total() - least);
    }
    CHECK(most <= 1.01 * brought);
  }
}

}  // namespace weft::test
