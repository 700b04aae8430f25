#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/cloth/cloth_def.h"
#include "core/types.h"

namespace weft {

/// What a spring stands for.
enum class SpringKind : std::uint8_t {
  warp,   ///< structural, along u
  weft,   ///< structural, along v
  shear,  ///< cell diagonal
  skip,   ///< every second neighbour (the seed's bending spring)
};

/// A Hookean spring with a dashpot along it.
template <class Real>
struct Spring {
  Index i = 0, j = 0;    ///< end particles
  Real rest_length = 0;  ///< [m], positive
  Real stiffness = 0;    ///< k [N/m]
  Real damping = 0;      ///< c [N s/m], along the spring
};

/// Two triangles that share an edge, with the energy 1/2 stiffness (theta - rest_angle)^2 and the
/// damping moment -damping dtheta/dt.
///
/// x[0], x[1] are the ends of the shared edge; the triangles are (x0, x1, x2) and (x1, x0, x3) with
/// normals to the same side, so theta = 0 when flat and positive when the normals open away from
/// each other (a fold whose inside lies on the side opposite to the normals).
template <class Real>
struct Hinge {
  Index x[4] = {0, 0, 0, 0};
  Real rest_angle = 0;  ///< theta_0 [rad]
  Real stiffness = 0;   ///< B l^2 / (A1 + A2) [N m]
  Real damping = 0;     ///< [N m s]
  Real smallest_normal2 =
      0;  ///< squared doubled area below which a triangle counts as crumpled [m^4]
};

/// A triangle crumpled below this part of its area at rest pulls on its hinges with less lever.
inline constexpr double kCrumpledArea = 0.05;

/// Springs of a grid as one set of numbers for each kind; see grid_springs.h. Border springs have
/// half.
template <class Real>
struct GridSprings {
  Real warp = 0, weft = 0, shear = 0;                 ///< stiffness [N/m]
  Real rest_warp = 0, rest_weft = 0, rest_shear = 0;  ///< [m]
  Real damping_per_stiffness = 0;                     ///< beta = c/k [s]
};

/// Bending of a grid that is flat at rest, as a quadratic form with a constant Hessian
/// (PHYSICS.md section 2): energy density 1/2 (B_w |x_uu|^2 + B_f |x_vv|^2 + (B_w + B_f) |x_uv|^2).
/// All zero if the cloth bends by hinges or not at all.
template <class Real>
struct QuadraticBending {
  Real along_u = 0;  ///< B_w h_v / h_u^3, times |second difference along u|^2 / 2 [N/m]
  Real along_v = 0;  ///< B_f h_u / h_v^3 [N/m]
  Real twist = 0;    ///< (B_w + B_f) / (h_u h_v), times |cell difference|^2 / 2 [N/m]
};

/// Everything about a cloth that does not change while it moves.
template <class Real>
struct ClothModel {
  int rows = 0, columns = 0;
  Real cell_u = 0, cell_v = 0;                ///< h_x, h_y, cell size [m]
  Vec3Array<Real> rest_positions;             ///< where the cloth starts [m]
  std::vector<std::array<Real, 2>> material;  ///< (u, v) coordinates in the fabric [m]
  std::vector<Real> mass;                     ///< [kg], positive
  std::vector<Triangle> triangles;            ///< with alternating diagonals
  std::vector<Real> triangle_area;            ///< at rest [m^2]
  std::vector<Edge> edges;                    ///< unique edges of the triangles
  std::vector<Spring<Real>> springs;          ///< ordered by first end, then kind
  std::vector<SpringKind> spring_kinds;
  std::optional<GridSprings<Real>> grid_springs;  ///< the same springs, if they are regular
  std::vector<Hinge<Real>> hinges;                ///< empty if bending is quadratic
  QuadraticBending<Real> quadratic_bending;
  FabricDef fabric;

  /// Bound of the highest squared frequency of the membrane and of bending [1/s^2], and the
  /// matching bounds of damping rates [1/s]; see solver/substep_rule.h.
  double membrane_omega2 = 0, bending_omega2 = 0;
  double membrane_damping_rate = 0, bending_damping_rate = 0;

  Index particle_count() const { return static_cast<Index>(mass.size()); }
};

/// Builds the grid cloth of PHYSICS.md section 2: structural and shear springs whose continuum
/// limit is the fabric's tensor, hinges over alternating diagonals whose bending rigidity is B in
/// every direction. Throws DefinitionError if a field is out of range or a spring would have
/// negative stiffness (shear too large for the cell's shape).
template <class Real>
ClothModel<Real> build_cloth(const ClothDef& def);

/// The particles whose material distance from particle `centre` is at most `radius` [m], ascending;
/// at least the centre itself.
template <class Real>
std::vector<Index> particles_in_disc(const ClothModel<Real>& model, Index centre, double radius);

extern template ClothModel<float> build_cloth<float>(const ClothDef&);
extern template ClothModel<double> build_cloth<double>(const ClothDef&);
extern template std::vector<Index> particles_in_disc(const ClothModel<float>&, Index, double);
extern template std::vector<Index> particles_in_disc(const ClothModel<double>&, Index, double);

}  // namespace weft
