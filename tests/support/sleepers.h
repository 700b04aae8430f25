#pragma once

#include <algorithm>

#include "core/world/world.h"
#include "tests/support/cloths.h"

namespace weft::test {

/// A cloth that hangs from its first row, in the plane x = `x`, and settles soon.
inline ClothDef curtain(const char* name, double x) {
  ClothDef cloth;
  cloth.name = name;
  cloth.rows = 12;
  cloth.columns = 12;
  cloth.width = cloth.height = 0.5;
  cloth.origin = Vec3d(x, 1, 0);
  cloth.u = Vec3d::UnitZ();
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 220;
  cloth.fabric.shear = 20;
  cloth.fabric.thickness = 0.004;
  return cloth;
}

/// Cloths that hang; what has been still to 10 um for a second sleeps.
inline WorldDef hanging(std::vector<ClothDef> cloths, double damping = 8) {
  WorldDef def;
  for (const ClothDef& cloth : cloths) {
    PinDef pin;
    pin.place = EdgeStrip{};
    pin.cloth = cloth.name;
    def.pins.push_back(pin);
  }
  def.cloths = std::move(cloths);
  def.environment.damping = damping;
  def.sleep = {1, 1e-5};
  return def;
}

inline std::uint64_t work_of(const TickReport& report) {
  std::uint64_t sum = 0;
  for (const StageProfile& stage : report.profile.stages) sum += stage.work;
  return sum;
}

/// Runs until all sleep. @return ticks that it took
template <class Real>
int run_to_sleep(World<Real>& world, int most = 1500) {
  for (int tick = 1; tick <= most; ++tick) {
    world.step();
    if (world.sleep().all_asleep()) return tick;
  }
  return -1;
}

template <class Real>
GrabDef touch(const World<Real>& world, Index triangle, double force) {
  GrabDef grab;
  grab.triangle = triangle;
  grab.radius = 0;
  grab.stiffness = 1e4;
  grab.max_force = force;
  const Index corner = world.model().triangles[static_cast<std::size_t>(triangle)][0];
  grab.target =
      world.state().x[static_cast<std::size_t>(corner)].template cast<double>() + Vec3d(1, 0, 0);
  return grab;
}

template <class Real>
double farthest_apart(const World<Real>& a, const World<Real>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.state().x.size(); ++i)
    most = std::max(most, static_cast<double>((a.state().x[i] - b.state().x[i]).norm()));
  return most;
}

}  // namespace weft::test
