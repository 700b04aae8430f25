#pragma once

#include "core/world/world.h"
#include "tests/support/cloths.h"

namespace weft::test {

/// A world without anything but a cloth in vacuum and without gravity, and without contact of it
/// with itself: where nothing touches, that costs and does not change a bit (guard_world_test).
inline WorldDef empty_world(const ClothDef& cloth) {
  WorldDef def;
  def.cloths[0] = cloth;
  def.environment.gravity.setZero();
  def.environment.air_density = 0;
  def.contact.seed.self = SelfContact::none;
  return def;
}

template <class Real>
void advance(World<Real>& world, double seconds) {
  const double end = world.report().time + seconds - 0.5 * world.tick_seconds();
  while (world.report().time < end) {
    const TickReport& report = world.step();
    if (report.divergence) throw std::runtime_error(describe(*report.divergence));
  }
}

/// Lets the world run under strong damping until nothing moves, for statics.
/// @return the largest speed that is left [m/s]
template <class Real>
double settle(World<Real>& world, double damping, double seconds) {
  EnvironmentDef environment = world.environment();
  environment.damping = damping;
  world.set_environment(environment);
  advance(world, seconds);
  double fastest = 0;
  for (const Vec3<Real>& v : world.state().v)
    fastest = std::max(fastest, static_cast<double>(v.norm()));
  return fastest;
}

template <class Real>
Vec3d centre_of_mass(const World<Real>& world) {
  Vec3d sum = Vec3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    sum += world.state().x[i].template cast<double>() * static_cast<double>(world.model().mass[i]);
    mass += static_cast<double>(world.model().mass[i]);
  }
  return sum / mass;
}

template <class Real>
Vec3d momentum(const World<Real>& world) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < world.state().v.size(); ++i)
    sum += world.state().v[i].template cast<double>() * static_cast<double>(world.model().mass[i]);
  return sum;
}

}  // namespace weft::test
