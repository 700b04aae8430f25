#pragma once

#include <cstddef>

#include "core/diagnostics/crossings.h"
#include "core/scenes/scene_parts.h"
#include "core/world/world.h"
#include "tests/support/random.h"

// Sheets of cloth that are guarded against themselves, and what is asked of them.

namespace weft::test {

/// A square sheet that stands upright, a little aslant, over the ground on which it crumples.
/// @param particles       a side
/// @param side            [m]
/// @param top             height at which its upper edge starts [m]
/// @param thickness_part  its thickness, as a part of the edge length
/// @param damping         uniform [1/s]
/// @param fabric          but for the thickness
inline WorldDef upright_sheet(int particles, double side, double top, double thickness_part,
                              double damping, const FabricDef& fabric = {}) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth = hanging_cloth(particles, particles, side, side, top, 0);
  cloth.v = Vec3d(0, -1, -0.12).normalized();
  cloth.fabric = fabric;
  cloth.fabric.thickness = thickness_part * side / (particles - 1);
  def.environment.damping = damping;
  def.colliders = {ground()};
  def.contact.seed.self = SelfContact::guard;
  return def;
}

/// Random velocities of up to `size` a coordinate for all particles, to make runs differ [m/s].
template <class Real>
void jolt(World<Real>& world, double size, unsigned seed) {
  Random random(seed);
  for (Vec3<Real>& v : world.state().v) v += random.vector(size).template cast<Real>();
  world.accept_state();
}

/// Edges that pass through or touch triangles of the same cloth or another one, now.
template <class Real>
std::size_t crossings(const World<Real>& world) {
  const Crossings found =
      count_self_crossings(world.state().x, world.model().edges, world.model().triangles);
  return found.proper + found.touching;
}

/// Part of the motion that the particles wanted and the guard took.
template <class Real>
double lost_fraction(const World<Real>& world) {
  const GuardCounts& counts = world.guard()->counts();
  return counts.wanted > 0 ? counts.truncated / counts.wanted : 0;
}

}  // namespace weft::test
