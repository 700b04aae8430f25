#include "core/contact/collider.h"

#include <cmath>

#include "core/definition.h"
#include "core/error.h"

namespace weft {
namespace {

struct Validator {
  const std::string& path;

  void position(const char* name, const Vec3d& value) const {
    check_field(path, {name, -1000, 1000, "m", "a position"}, value);
  }
  void radius(double value) const {
    check_field(path, {"radius", 1e-3, 100, "m", "radius of the shape"}, value);
  }
  void operator()(const PlaneDef& plane) const {
    position("point", plane.point);
    position("normal", plane.normal);
    if (plane.normal.norm() < 1e-9)
      throw DefinitionError(path + "normal", "0,0,0", "a direction",
                            "give a vector that is not zero");
  }
  void operator()(const SphereDef& sphere) const {
    position("center", sphere.centre);
    radius(sphere.radius);
  }
  void operator()(const CapsuleDef& capsule) const {
    position("a", capsule.a);
    position("b", capsule.b);
    radius(capsule.radius);
  }
  void operator()(const BoxDef& box) const {
    position("center", box.centre);
    check_field(path, {"half_extents", 1e-3, 100, "m", "half the sides"}, box.half_extents);
    const double norm = box.orientation.norm();
    if (!(std::abs(norm - 1) < 1e-3))
      throw DefinitionError(path + "orientation", number_text(norm), "a unit quaternion",
                            "its norm must be 1");
  }
  void operator()(const MeshDef& def) const { weft::validate(def.mesh, path); }
};

}  // namespace

void validate(const ColliderDef& def, const std::string& path) {
  std::visit(Validator{path}, def.shape);
}

TriangleMesh world_mesh(const BoxDef& box) {
  TriangleMesh mesh = box_mesh(box.half_extents);
  const Eigen::Quaterniond turn = box.orientation.normalized();
  for (Vec3d& p : mesh.positions) p = turn * p + box.centre;
  return mesh;
}

}  // namespace weft
