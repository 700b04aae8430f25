#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "core/types.h"

namespace weft {

/// Everything on the side opposite to the normal is solid.
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
  MeshPlacement placement = {};  ///< how `mesh` was made, for scene files; not applied again
};

using ShapeDef = std::variant<PlaneDef, SphereDef, CapsuleDef, BoxDef, MeshDef>;

/// An object that the cloth cannot enter.
struct ColliderDef {
  std::string name;
  ShapeDef shape;
};

/// Throws DefinitionError if a shape is out of range; `path` stands before the field's name.
void validate(const ColliderDef& def, const std::string& path);

/// The mesh that stands for a box in contact, in world coordinates.
TriangleMesh world_mesh(const BoxDef& box);

}  // namespace weft
