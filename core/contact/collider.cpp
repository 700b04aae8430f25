#include "core/contact/collider.h"

#include <cmath>

#include "core/definition.h"
#include "core/error.h"

namespace weft {
namespace {

/// Unit within what rounding to three digits does.
void check_unit(const std::string& field, const Eigen::Quaterniond& orientation) {
  const double norm = orientation.norm();
  if (!(std::abs(norm - 1) < 1e-3))
    throw DefinitionError(field, "of norm " + number_text(norm), "a unit quaternion [x, y, z, w]",
                          "its norm must be 1");
}

struct Validator {
  const std::string& path;

  template <class Shape>
  void check_fields(const Shape& shape) const {
    visit_fields_of_shape(shape, [this](const FieldInfo& info, const auto& value) {
      check_field(path, info, value);
    });
  }
  void operator()(const PlaneDef& plane) const {
    check_fields(plane);
    if (plane.normal.norm() < 1e-9)
      throw DefinitionError(path + "normal", "0,0,0", "a direction",
                            "give a vector that is not zero");
  }
  void operator()(const SphereDef& sphere) const { check_fields(sphere); }
  void operator()(const CapsuleDef& capsule) const { check_fields(capsule); }
  void operator()(const BoxDef& box) const {
    check_fields(box);
    check_unit(path + "orientation", box.orientation);
  }
  void operator()(const MeshDef& def) const {
    check_unit(path + "orientation", def.placement.orientation);
    weft::validate(def.mesh, path);
  }
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
