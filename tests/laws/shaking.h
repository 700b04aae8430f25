#pragma once

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/insults.h"
#include "tests/support/worlds.h"

namespace weft::test {

// Hard shaking: what is done to a cloth that hangs by its upper edge, and how it takes it. Its
// rigidity is such that its rest is unique, a flat sheet: one a hundred times smaller leaves tucks
// in a cloth that may pass through itself, and they are equilibria.

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

/// Root of the mean square of the distance of all particles from their places at rest, over the
/// length of the cloth, which is 1 m.
template <class Real>
double distance_from(const Vec3Array<Real>& rest, const World<Real>& world) {
  double sum = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    sum += (world.state().x[i] - rest[i]).template cast<double>().squaredNorm();
  return std::sqrt(sum / static_cast<double>(rest.size()));
}

inline void check_recovery(int n, double stiffness) {
  World<float> resting(hanging_square(n, stiffness, 5));
  advance(resting, 6);
  const Vec3Array<float> rest = resting.state().x;
  for (const Insult kind : kInsults) {
    INFO(name_of(kind) << " at " << stiffness << " N/m");
    World<float> world(hanging_square(n, stiffness, 5));
    advance(world, 1);
    REQUIRE(insult(world, kind) == 0);
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
  for (const Insult kind : kInsults) {
    INFO(name_of(kind) << " at " << stiffness << " N/m");
    World<float> world(hanging_square(n, stiffness, 0));
    advance(world, 1);
    REQUIRE(insult(world, kind) == 0);
    const double brought = world.report().energies.total() - least;
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
