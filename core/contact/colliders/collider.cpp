// Validates colliders and turns boxes into meshes.

#include "core/contact/colliders/collider.h"

#include "core/definition.h"
#include "core/error.h"
#include "core/geometry/constants.h"

namespace weft {
namespace {

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
    if (plane.normal.norm() < kShortestDirection)
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
  visit_fields_of_collider(
      def, [&path](const FieldInfo& info, const auto& value) { check_field(path, info, value); });
  validate(def.motion, path + "motion.");
  for (std::size_t k = 0; k < def.motion.keyframes.size(); ++k)
    check_may_turn(def, {Vec3d::Zero(), def.motion.keyframes[k].rotation},
                   path + "motion.keyframes[" + std::to_string(k) + "].");
}

void check_may_turn(const ColliderDef& def, const Pose& pose, const std::string& path) {
  if (!std::holds_alternative<PlaneDef>(def.shape) || pose.rotation.vec().isZero(0)) return;
  throw DefinitionError(path + "rotation", "a turn", "no turn of a plane",
                        "it has no end and so no bound on its speed: use a box");
}

TriangleMesh world_mesh(const BoxDef& box) {
  TriangleMesh mesh = box_mesh(box.half_extents);
  const Eigen::Quaterniond turn = box.orientation.normalized();
  for (Vec3d& p : mesh.positions) p = turn * p + box.centre;
  return mesh;
}

}  // namespace weft
