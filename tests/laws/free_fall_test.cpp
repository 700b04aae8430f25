#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// Forces inside a cloth add up to nothing, and neither move nor turn it, in single precision too:
// what is stiff falls like a stone, wherever it is.

using namespace weft;

namespace {

constexpr double kGravity = 9.81;

/// A stiff upright sheet of 0.25 m and 0.1 kg/m^2 that nothing holds.
WorldDef stiff_sheet(double bending, const Vec3d& origin) {
  ClothDef cloth = test::flat_cloth(21, 21, 0.25, 0.25);
  cloth.v = -Vec3d::UnitY();
  cloth.origin = origin;
  cloth.fabric.areal_density = 0.1;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = 1000;
  cloth.fabric.shear = 100;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = bending;
  WorldDef def = test::empty_world(cloth);
  def.environment.gravity = Vec3d(0, -kGravity, 0);
  return def;
}

struct Motion {
  Vec3d velocity = Vec3d::Zero();  ///< of the centre of mass [m/s]
  double turning = 0;              ///< |angular momentum| over moment of inertia about it [rad/s]
};

Motion motion_of(const World<float>& world) {
  const Vec3d centre = test::centre_of_mass(world);
  Vec3d momentum = Vec3d::Zero(), angular = Vec3d::Zero();
  double mass = 0, inertia = 0;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const auto m = static_cast<double>(world.model().mass[i]);
    const Vec3d x = world.state().x[i].cast<double>() - centre,
                v = world.state().v[i].cast<double>();
    momentum += v * m;
    angular += x.cross(v) * m;
    inertia += x.squaredNorm() * m;
    mass += m;
  }
  return {momentum / mass, angular.norm() / inertia};
}

Motion after_fall(const WorldDef& def, double seconds) {
  World<float> world(def);
  test::advance(world, seconds);
  return motion_of(world);
}

const Vec3d kNear = Vec3d::Zero(), kFar(90, 80, -40);

}  // namespace

TEST_CASE("a stiff sheet falls 3 s by implicit with v = g t to 1e-4, near and far") {
  const double bending = GENERATE(0.001, 0.1);
  const Vec3d origin = GENERATE(kNear, kFar);
  CAPTURE(bending, origin);
  WorldDef def = stiff_sheet(bending, origin);
  def.solver.kind = SolverKind::implicit;
  const Motion motion = after_fall(def, 3);
  CHECK((motion.velocity - Vec3d(0, -kGravity * 3, 0)).norm() < 1e-4 * kGravity * 3);
}

TEST_CASE(
    "what turns a stiff sheet that falls by implicit is the tolerance of its linear systems") {
  const Vec3d origin = GENERATE(kNear, kFar);
  CAPTURE(origin);
  WorldDef def = stiff_sheet(0.1, origin);
  def.solver.kind = SolverKind::implicit;
  def.implicit.tolerance = 1e-6;
  const double turning = after_fall(def, 3).turning;
  CHECK(turning < 1e-3);
  def.implicit.tolerance = 0.02;
  const double turning_by_default = after_fall(def, 3).turning;
  CHECK(turning_by_default > 3 * turning);
  CHECK(turning_by_default < 1);
}

TEST_CASE("a stiff mesh falls 3 s by implicit with v = g t to 1e-3") {
  WorldDef def = stiff_sheet(0.1, kNear);
  const FabricDef fabric = def.cloths[0].fabric;
  def.cloths[0] = test::triangle_sheet(test::Cut::irregular, 0.25, 0.25, 0.0125, 0.1);
  def.cloths[0].fabric = fabric;
  def.solver.kind = SolverKind::implicit;
  const Motion motion = after_fall(def, 3);
  CHECK((motion.velocity - Vec3d(0, -kGravity * 3, 0)).norm() < 1e-3 * kGravity * 3);
  CHECK(motion.turning < 1);
}

TEST_CASE(
    "a stiff sheet falls 1 s by relaxation with v = g t to 1e-4 and hardly turns, near and far") {
  const double compliance = GENERATE(0, 1);
  const Vec3d origin = GENERATE(kNear, kFar);
  CAPTURE(compliance, origin);
  WorldDef def = stiff_sheet(0.03, origin);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.compliance = compliance;
  def.relaxation.sweeps = 2;
  def.relaxation.damping = 0;
  const Motion motion = after_fall(def, 1);
  CHECK((motion.velocity - Vec3d(0, -kGravity, 0)).norm() < 1e-4 * kGravity);
  CHECK(motion.turning < 0.1);  // 6 mm/s at the border, of rounding far away
}
