#pragma once

#include <optional>
#include <string>

#include "core/cloth/fabric.h"
#include "core/cloth/look.h"
#include "core/definition.h"
#include "core/geometry/triangle_mesh.h"

// Definition of a cloth: geometry, material and models.

namespace weft {

/// Distribution of the cloth's mass among its particles.
enum class MassLumping {
  area,   ///< a third of each triangle to its corners, averaged over both diagonals: half on
          ///< border lines, a quarter on corners
  equal,  ///< the same for all (the seed's)
};

/// Model of the cloth's bending resistance.
enum class BendingModel {
  automatic,    ///< quadratic where accurate enough, else hinges; see quadratic_bending_fits
  hinges,       ///< dihedral angles with rest angle and damping (Bridson 2003)
  quadratic,    ///< constant Hessian, on grids and flat meshes; needs zero rest angles
  sine_hinges,  ///< hinges with moments by sin(theta/2), as printed in Bridson 2003 (the seed's)
};

/// Model of the cloth's resistance to stretch and shear.
enum class MembraneModel {
  automatic,  ///< springs on a grid; on a mesh triangles where the solver has them
  springs,    ///< along the edges of a mesh: approximate, and what rigid relaxation needs
  triangles,  ///< of constant strain: the fabric's tensor on any mesh
};

/// The shape that a mesh has without strain.
enum class RestShape {
  placed,  ///< as its vertices lie in space
  uv,      ///< flat, in the shape of its (u, v) in metres; it starts strained where its vertices
           ///< lie. With seams each triangle rests on its own, and nothing is bent at rest
};

/// Outline of a grid within its rectangle.
enum class Outline {
  rectangle,  ///< the whole rectangle
  ellipse,    ///< the whole cells whose centre lies in the inscribed ellipse
};

/// Spring stiffnesses given directly, as in the seed, instead of derived from the fabric.
struct DirectSprings {
  double structural = 0;  ///< neighbours in a row or column [N/m]
  double shear = 0;       ///< cell diagonals [N/m]
  double skip = 0;        ///< every second neighbour, the seed's bending springs [N/m]
  double dashpot = 0;     ///< along every spring [N s/m]
};

/// A cloth of any shape: every vertex a particle.
struct ClothMesh {
  TriangleMesh
      mesh;  ///< in world coordinates [m]; every vertex used, at most two triangles an edge
  std::vector<std::array<double, 2>> uv;  ///< per vertex, u along the warp, any scale unless they
                                          ///< are the rest shape [m]; empty: projected along the
                                          ///< axis that the mesh faces
  MeshPlacement placement = {};           ///< origin of `mesh`; not applied again
  std::vector<CornerUv> corner_uv = {};   ///< by triangle, of its corners, where a vertex has
                                          ///< several at a seam, of which `uv` has one; empty:
                                          ///< those of the vertices
};

/// A cloth: rectangular with rows x columns particles, flat at rest, or a triangle mesh.
///
/// Particle (row r, column c) has index r * columns + c and starts at
/// origin + u * width * c/(columns-1) + v * height * r/(rows-1).
struct ClothDef {
  std::string name = "cloth";
  int rows = 20;                         ///< particles along v
  int columns = 30;                      ///< particles along u
  double width = 1;                      ///< extent along u [m]
  double height = 1;                     ///< extent along v [m]
  Vec3d origin = Vec3d::Zero();          ///< initial position of particle 0 [m]
  Vec3d u = Vec3d::UnitX();              ///< direction of a row, warp; normalised when built
  Vec3d v = -Vec3d::UnitY();             ///< direction of a column, weft; must be normal to u
  double rest_angle = 0;                 ///< of every hinge [rad]
  Outline outline = Outline::rectangle;  ///< a cut grid numbers its particles row by row
  double skip_stiffness = 0;             ///< the seed's bending springs, besides the hinges [N/m]
  BendingModel bending_model = BendingModel::automatic;
  MembraneModel membrane_model = MembraneModel::automatic;
  RestShape rest_shape = RestShape::placed;
  MassLumping mass_lumping = MassLumping::area;
  std::optional<DirectSprings> direct_springs;
  FabricDef fabric;
  std::optional<ClothMesh> mesh;  ///< replaces the rectangle and its parameters
  std::optional<LookDef> look;    ///< absent: as its fabric's preset looks
};

/// Passes each field of a grid to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_grid(Def& c, Visitor&& visit) {
  visit(FieldInfo{"rows", 2, 2048, "", "particles along v"}, c.rows);
  visit(FieldInfo{"columns", 2, 2048, "", "particles along u"}, c.columns);
  visit(FieldInfo{"width", 1e-3, 100, "m", "extent along u"}, c.width);
  visit(FieldInfo{"height", 1e-3, 100, "m", "extent along v"}, c.height);
  visit(FieldInfo{"origin", -100, 100, "m", "initial position of particle 0"}, c.origin);
  visit(FieldInfo{"u", -1e3, 1e3, "", "direction of a row"}, c.u);
  visit(FieldInfo{"v", -1e3, 1e3, "", "direction of a column"}, c.v);
  visit(
      choice("outline", "rectangle|ellipse",
             "outline within the rectangle; an ellipse is the whole cells whose centre lies in it: "
             "its area and mass are off by 13 % at 7 x 7, at most 4 % from 11 x 11 and 2 % from "
             "21 x 21 on"),
      c.outline);
  visit(FieldInfo{"skip_stiffness", 0, 1e6, "N/m", "springs to every second neighbour"},
        c.skip_stiffness);
}

/// The same for the fields of any cloth, grid or mesh.
template <class Def, class Visitor>
void visit_fields_of_any_cloth(Def& c, Visitor&& visit) {
  visit(choice("bending_model", "automatic|hinges|quadratic|sine_hinges",
               "how the cloth resists bending"),
        c.bending_model);
  visit(choice("membrane_model", "automatic|springs|triangles",
               "how the cloth resists stretch; triangles on a mesh only"),
        c.membrane_model);
  visit(choice("rest_shape", "placed|uv", "shape of a mesh without strain; uv: in metres, flat"),
        c.rest_shape);
  visit(choice("mass_lumping", "area|equal", "how the particles share the mass"), c.mass_lumping);
  visit(FieldInfo{"rest_angle", -3, 3, "rad", "rest angle of every hinge"}, c.rest_angle);
}

template <class Def, class Visitor>
void visit_fields_of_cloth(Def& c, Visitor&& visit) {
  visit_fields_of_grid(c, visit);
  visit_fields_of_any_cloth(c, visit);
}

/// Passes each field of the direct springs to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_direct_springs(Def& d, Visitor&& visit) {
  visit(FieldInfo{"structural", 0, 1e6, "N/m", "neighbours in a row or column"}, d.structural);
  visit(FieldInfo{"shear", 0, 1e6, "N/m", "cell diagonals"}, d.shear);
  visit(FieldInfo{"skip", 0, 1e6, "N/m", "every second neighbour"}, d.skip);
  visit(FieldInfo{"dashpot", 0, 1e3, "N s/m", "along every spring"}, d.dashpot);
}

/// Whether the quadratic form may replace the hinges: if no rest angle is asked for.
inline bool quadratic_bending_fits(const ClothDef& def) {
  return def.rest_angle == 0;
}

/// Whether the cloth is built from triangles of constant strain: a mesh, unless springs were asked
/// for.
inline bool has_membrane_triangles(const ClothDef& def) {
  return def.mesh && def.membrane_model != MembraneModel::springs;
}

/// Checks every range, that u and v are at right angles, and that the models suit the shape.
/// Throws DefinitionError.
void validate(const ClothDef& def);

/// Name of a field of one of several cloths: "cloth.rows" and "fabric.shear" for the first,
/// "cloths[1].rows" and "cloths[1].fabric.shear" for the second.
/// @param field  its name for the first cloth
std::string cloth_field(std::size_t cloth, const std::string& field);

}  // namespace weft
