#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/definition.h"
#include "core/types.h"

// Triangle meshes and their placement in the world.

namespace weft {

/// Triangles with shared vertices, counter-clockwise seen from outside [m].
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

/// (u, v) of a triangle's corners, where the fabric or a texture lies.
using CornerUv = std::array<std::array<double, 2>, 3>;

/// Source and placement of a mesh: p = position + R (scale p_source).
struct MeshPlacement {
  std::string source;              ///< name of a built-in mesh or file; empty: made by code
  double scale = 1;                ///< 1e-4 to 1e4
  Vec3d position = Vec3d::Zero();  ///< [m], within 1000
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Passes each field of a placement except its orientation to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_placement(Def& placement, Visitor&& visit) {
  visit(FieldInfo{"scale", 1e-4, 1e4, "", "metres per unit of the mesh"}, placement.scale);
  visit(FieldInfo{"position", -1000, 1000, "m", "position of its origin"}, placement.position);
}

/// The mesh with the placement applied.
TriangleMesh placed(TriangleMesh mesh, const MeshPlacement& placement);

/// An edge with its adjacent triangles.
struct MeshEdge {
  Index a = 0, b = 0;                              ///< ends, smaller index first
  std::array<Index, 2> triangle = {kNone, kNone};  ///< the second is none at a border
};

/// Unique edges, ordered by their ends. An edge with more than two triangles keeps the first two.
std::vector<MeshEdge> edges_of(const TriangleMesh& mesh);

/// Whether every edge has exactly two triangles that traverse it in opposite directions, so that
/// the mesh has an inside.
bool is_closed(const TriangleMesh& mesh);

double surface_area(const TriangleMesh& mesh);  ///< [m^2]

/// Volume of a closed mesh [m^3], positive if its triangles face outwards. Computed about a vertex,
/// so that rounding does not decide its sign far from the origin.
double enclosed_volume(const TriangleMesh& mesh);

Vec3d unit_normal(const TriangleMesh& mesh, Index triangle);  ///< zero if the triangle has no area

/// Vertex normals, weighted by the angles of the triangles there: they give the distance to the
/// surface the right sign even at vertices (Baerentzen, Aanaes 2005).
std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh);

/// Checks counts, indices, coordinates (finite, within 1000 m) and areas.
/// Throws DefinitionError with `path` in front of the field's name.
void validate(const TriangleMesh& mesh, const std::string& path);

/// The twelve triangles of an axis-aligned box around the origin.
TriangleMesh box_mesh(const Vec3d& half_extents);

}  // namespace weft
