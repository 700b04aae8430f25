#include <cmath>
#include <iostream>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_presets.h"
#include "tests/support/worlds.h"

// Doubling the resolution does not change the cloth: the same fabric with 32, 64 and 128 particles
// a side, hung by a strip of 5 cm along one edge.

using namespace weft;

namespace {

/// A square that starts level. Its strip ends on a row of 32, and between rows of 64 and 128.
World<float> hung(int n, const std::string& fabric, double damping) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = n;
  cloth.width = cloth.height = 31 * 0.05;
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d::UnitZ();
  cloth.fabric = make_fabric(fabric);
  def.pins = {{EdgeStrip{Side::top, 0.05}, 0, {}}};
  def.environment.air_density = 0;
  def.environment.damping = damping;
  def.contact.seed.self = SelfContact::none;
  return World<float>(def);
}

/// Height of the pins over the middle of the hem, at rest [m].
double rest_sag(int n, const std::string& fabric) {
  World<float> world = hung(n, fabric, 5);
  test::advance(world, 6);
  const std::size_t hem = world.state().x.size() - static_cast<std::size_t>(n);
  const auto height = [&](int k) {
    return static_cast<double>(world.state().x[hem + static_cast<std::size_t>(k)][1]);
  };
  const double sag = -0.5 * (height((n - 1) / 2) + height(n / 2));
  std::cout << fabric << " at " << n << ": rests " << sag << " m below its pins" << std::endl;
  return sag;
}

/// Where the centre of mass is at each tick of the first second of a swing from the level.
std::vector<Vec3d> swing(int n, const std::string& fabric) {
  World<float> world = hung(n, fabric, 0.5);
  const Vec3d start = test::centre_of_mass(world);
  std::vector<Vec3d> path;
  for (int tick = 0; tick < 60; ++tick) {
    world.step();
    path.push_back(test::centre_of_mass(world) - start);
  }
  return path;
}

/// Relative L2 distance of two paths.
double distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& reference) {
  double apart = 0, all = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    apart += (a[k] - reference[k]).squaredNorm();
    all += reference[k].squaredNorm();
  }
  return std::sqrt(apart / all);
}

}  // namespace

TEST_CASE("the rest of 32 by 32 is that of 128 by 128 to 2 %, that of 64 by 64 to 1 %") {
  const std::string fabric = GENERATE("cotton", "denim");
  const double finest = rest_sag(128, fabric);
  CHECK(rest_sag(32, fabric) == Approx(finest).epsilon(0.02));
  CHECK(rest_sag(64, fabric) == Approx(finest).epsilon(0.01));
}

TEST_CASE("the swing of 32 by 32 is that of 128 by 128 to 2 %, that of 64 by 64 to 1 %") {
  const std::string fabric = GENERATE("cotton", "denim");
  const std::vector<Vec3d> finest = swing(128, fabric);
  const double coarse = distance(swing(32, fabric), finest);
  const double fine = distance(swing(64, fabric), finest);
  std::cout << fabric << ": swing of 32 by 32 " << 100 * coarse
            << " % from 128 by 128, of 64 by 64 " << 100 * fine << " %" << std::endl;
  CHECK(coarse < 0.02);
  CHECK(fine < 0.01);
}
