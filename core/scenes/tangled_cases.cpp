#include <cassert>
// The third list of hard cases: cloth that starts through cloth.

#include "core/scenes/built_in_meshes.h"
#include "core/scenes/hard_cases.h"

namespace weft {
namespace {

constexpr double kClearAfter = 2;  ///< [s]

void fall_and_come_apart(WorldDef& def) {
  def.colliders = {ground()};
  def.environment.damping = 1;
  judge(def, 0.5, 0.2, kClearAfter);
}

ClothDef sheet(const std::string& name, double side, const Vec3d& centre, const Vec3d& u,
               const Vec3d& v) {
  assert(side > 0 && u.norm() > 0);
  ClothDef cloth;
  cloth.name = name;
  cloth.rows = cloth.columns = 25;
  cloth.width = cloth.height = side;
  cloth.u = u.normalized();
  cloth.v = (v - cloth.u * cloth.u.dot(v)).normalized();
  cloth.origin = centre - (cloth.u + cloth.v) * (side / 2);
  return cloth;
}

/// A lying sheet, one that passes through its middle, one with a corner through it, one halfway
/// over its border, and one nearly in its plane.
void build_start_through(WorldDef& def, const std::string&) {
  const Vec3d x = Vec3d::UnitX(), y = Vec3d::UnitY(), z = Vec3d::UnitZ(), middle = 0.7 * y;
  def.cloths = {
      sheet("lying", 0.8, middle, x, z),
      sheet("middle", 0.4, middle + Vec3d(-0.1, 0.03, 0.02), x + 0.2 * z, y),
      sheet("corner", 0.4, middle + Vec3d(0.013, 0.22, 0.25), x + y, Vec3d(-1, 1, 0.3)),
      sheet("border", 0.4, middle + Vec3d(0.4, 0.03, 0.02), x - 0.2 * z, y),
      sheet("parallel", 0.3, middle + Vec3d(0.01, 0.003, -0.25), x + 0.1 * y, z + 0.05 * y)};
  fall_and_come_apart(def);
}

/// A strip with ends that pass through each other; this shape is its rest shape.
void build_start_fold(WorldDef& def, const std::string&) {
  ClothDef& cloth = def.cloths[0];
  MeshPlacement placement;
  placement.source = "loop";
  placement.position = Vec3d(0, 0.5, 0);
  const MeshFile loop = built_in_mesh("loop", {});
  cloth.mesh = ClothMesh{placed(loop.mesh, placement), loop.uv, placement, loop.corner_uv};
  fall_and_come_apart(def);
}

}  // namespace

std::vector<SceneEntry> tangled_cases() {
  return {{{"hard-start-through",
            "Four sheets start through a fifth: by the middle, a corner, over its border and at a "
            "small angle: they must be apart within two seconds and stay so."},
           build_start_through},
          {{"hard-start-fold",
            "A strip starts as a loop whose ends go through each other: it must come undone within "
            "two seconds and stay so."},
           build_start_fold}};
}

}  // namespace weft
