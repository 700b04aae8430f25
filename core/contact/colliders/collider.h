#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/contact/colliders/collider_motion.h"
#include "core/definition.h"
#include "core/geometry/triangle_mesh.h"
#include "core/types.h"

// Definitions of colliders: objects that cloth cannot enter.

namespace weft {

/// A half space, solid on the side opposite to the normal.
struct PlaneDef {
  Vec3d point = Vec3d::Zero();    ///< on the plane [m], within 1000
  Vec3d normal = Vec3d::UnitY();  ///< any length but zero
};

struct SphereDef {
  Vec3d centre = Vec3d::Zero();  ///< [m], within 1000
  double radius = 0.1;           ///< [m], 0.001 to 100
};

/// A segment with a radius.
struct CapsuleDef {
  Vec3d a = Vec3d::Zero(), b = Vec3d::UnitY();  ///< ends of the segment [m], within 1000
  double radius = 0.1;                          ///< [m], 0.001 to 100
};

struct BoxDef {
  Vec3d centre = Vec3d::Zero();               ///< [m], within 1000
  Vec3d half_extents = Vec3d::Constant(0.1);  ///< [m], each 0.001 to 100
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// A triangle mesh, given in world coordinates. A closed one is solid; an open one has two sides.
struct MeshDef {
  TriangleMesh mesh;
  MeshPlacement placement = {};  ///< origin of `mesh`, for scene files; not applied again
};

/// Matches a definition, const or not.
template <class T, class Def>
concept DefOf = std::is_same_v<std::remove_const_t<T>, Def>;

using ShapeDef = std::variant<PlaneDef, SphereDef, CapsuleDef, BoxDef, MeshDef>;

/// An object that cloth cannot enter.
struct ColliderDef {
  std::string name;
  ShapeDef shape;
  MotionDef motion = {};       ///< keyframes, if it has its own motion
  double max_force = 100;      ///< resistance beyond which it lags [N], 0.01 to 1e6
  bool force = false;          ///< follows its keyframes even if cloth cannot yield; see MoveDef
  double friction_factor = 1;  ///< times the coefficient of the cloth that touches it, 0 to 10
};

/// Passes each field of a collider except shape and motion to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_collider(Def& collider, Visitor&& visit) {
  visit(FieldInfo{"max_force", 0.01, 1e6, "N", "resistance beyond which a moving one lags"},
        collider.max_force);
  visit(FieldInfo{"force", 0, 1, "", "it moves on through cloth that cannot yield"},
        collider.force);
  visit(FieldInfo{"friction_factor", kFrictionFactorRange, "",
                  "times the friction of the cloth that touches it"},
        collider.friction_factor);
}

// Pass each field of a shape except orientations, which are unit quaternions, to `visit(info,
// value)`.

template <class Visitor>
void visit_fields_of_shape(DefOf<PlaneDef> auto& plane, Visitor&& visit) {
  visit(FieldInfo{"point", -1000, 1000, "m", "on the plane"}, plane.point);
  visit(FieldInfo{"normal", -1000, 1000, "", "out of the solid side, of any length"}, plane.normal);
}
template <class Visitor>
void visit_fields_of_shape(DefOf<SphereDef> auto& sphere, Visitor&& visit) {
  visit(FieldInfo{"center", -1000, 1000, "m", "middle of the sphere"}, sphere.centre);
  visit(FieldInfo{"radius", 1e-3, 100, "m", "radius of the sphere"}, sphere.radius);
}
template <class Visitor>
void visit_fields_of_shape(DefOf<CapsuleDef> auto& capsule, Visitor&& visit) {
  visit(FieldInfo{"a", -1000, 1000, "m", "one end of the segment"}, capsule.a);
  visit(FieldInfo{"b", -1000, 1000, "m", "other end of the segment"}, capsule.b);
  visit(FieldInfo{"radius", 1e-3, 100, "m", "distance of the surface from it"}, capsule.radius);
}
template <class Visitor>
void visit_fields_of_shape(DefOf<BoxDef> auto& box, Visitor&& visit) {
  visit(FieldInfo{"center", -1000, 1000, "m", "middle of the box"}, box.centre);
  visit(FieldInfo{"half_extents", 1e-3, 100, "m", "half of each side"}, box.half_extents);
}

/// Throws DefinitionError if a shape or its motion is out of range; `path` precedes the field's
/// name.
void validate(const ColliderDef& def, const std::string& path);

/// Throws DefinitionError if the pose would rotate a plane, whose speed would be unbounded.
void check_may_turn(const ColliderDef& def, const Pose& pose, const std::string& path);

/// The mesh that represents a box in contact, in world coordinates.
TriangleMesh world_mesh(const BoxDef& box);

}  // namespace weft
