#pragma once

#include <cassert>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/cloth/cloth_def.h"
#include "core/cloth/membrane_triangle.h"
#include "core/types.h"

// The constant data of cloths: masses, triangles, springs and hinges.

namespace weft {

/// Role of a spring.
enum class SpringKind : std::uint8_t {
  warp,   ///< structural, along u
  weft,   ///< structural, along v
  shear,  ///< cell diagonal
  skip,   ///< every second neighbour (the seed's bending spring)
  edge,   ///< an edge of a mesh cloth
};

/// A Hookean spring with a dashpot.
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
/// normals on the same side, so theta = 0 when flat, and positive when the normals diverge (a fold
/// with its inside on the side opposite to the normals).
template <class Real>
struct Hinge {
  Index x[4] = {0, 0, 0, 0};
  Real rest_angle = 0;  ///< theta_0 [rad]
  Real stiffness = 0;   ///< B l^2 / (A1 + A2) [N m]
  Real damping = 0;     ///< [N m s]
  Real smallest_normal2 =
      0;                   ///< squared doubled area below which a triangle counts as crumpled [m^4]
  bool sine_form = false;  ///< moment by sines of half angles; see hinge_moment
};

/// Springs of a grid as one set of numbers per kind; see grid_springs.h. Border springs have half
/// the stiffness.
template <class Real>
struct GridSprings {
  Real warp = 0, weft = 0, shear = 0;                 ///< stiffness [N/m]
  Real rest_warp = 0, rest_weft = 0, rest_shear = 0;  ///< [m]
  Real warp_time = 0, weft_time = 0, shear_time = 0;  ///< beta = c/k [s]
  Real misfit = 0;  ///< E, of a twisted cell's chords; see forces/cell_misfit.h [N m]
};

/// Bending of a grid that is flat at rest, as a quadratic form with a constant Hessian:
/// energy density 1/2 (B_w |x_uu|^2 + B_f |x_vv|^2 + (B_w + B_f) |x_uv|^2).
/// All zero if the cloth bends by hinges or not at all.
template <class Real>
struct QuadraticBending {
  Real along_u = 0;  ///< B_w h_v / h_u^3, times |second difference along u|^2 / 2 [N/m]
  Real along_v = 0;  ///< B_f h_u / h_v^3 [N/m]
  Real twist = 0;    ///< (B_w + B_f) / (h_u h_v), times |cell difference|^2 / 2 [N/m]
};

/// Two particles of a mesh, with the energy 1/2 weight |x_j - x_i|^2: an entry of its bending's
/// constant matrix, whose rows sum to zero; see mesh_bending.h.
struct BendingLink {
  Index i = 0, j = 0;  ///< counted from the part's first particle
  double weight = 0;   ///< of either sign [N/m]; in double, because pulls on flat cloth must cancel
};

/// Curvatures of a mesh's triangles along both threads and between them, each a sum over particles
/// near by. The links sum the energies of their squares; the dashpots need each on its own.
template <class Real>
struct TriangleCurvatures {
  std::vector<Index> triangles;  ///< that bend: not in a held strip; counted from the part's first
  std::vector<std::size_t> begin;   ///< of each triangle's particles below, and the last one's end
  std::vector<Index> particles;     ///< counted from the part's first
  std::vector<Vec3<Real>> weights;  ///< of each in the three curvatures [1/m^2]
  std::vector<Vec3<Real>> stiffness;  ///< by triangle: rigidity times area [N m^3]
};

/// Rest shape of a curved mesh. A triangle with the curvatures c = sum_i w_i x_i, at rest kappa
/// along its normal n, has the energy sum k/2 |c - kappa n|^2. The links have k/2 |c|^2 of it;
/// these add -n . sum_i pull_i x_i with pull = sum k kappa w, and the sum of all k/2 kappa^2.
template <class Real>
struct RestCurves {
  std::vector<Triangle> triangles;   ///< their corners, counted from the part's first particle
  std::vector<std::size_t> begin;    ///< of each triangle's particles below, and the last one's end
  std::vector<Index> particles;      ///< counted from the part's first
  std::vector<Real> pulls;           ///< of each, along the normal [N]
  std::vector<Real> smallest_cross;  ///< by triangle: doubled area below which it is crumpled [m^2]
  double energy = 0;                 ///< of the cloth laid flat [J]
};

/// The present cells of a grid, and the particles at their corners, numbered row by row. A whole
/// grid has all cells.
struct GridCells {
  int rows = 0, columns = 0;     ///< of particle sites; 0 if the cloth is not a grid
  std::vector<char> kept;        ///< 1 for each present cell, row by row
  std::vector<Index> particles;  ///< by site, counted from the part's first; kNone: no particle
  /// Factors of the bending about each row and column, where a clamp shortens what bends there
  /// (attachments/clamp_line.h); empty: all 1.
  std::vector<double> row_stiffening, column_stiffening;
  /// Factors of the bending along u and along v about each site, where the circle of a pinned disc
  /// clamps (attachments/clamp_disc.h); empty: all 1.
  std::vector<std::array<double, 2>> site_stiffening;

  double stiffening_of_row(int r) const {
    assert(r >= 0 && r < rows);
    return row_stiffening.empty() ? 1 : row_stiffening[static_cast<std::size_t>(r)];
  }
  double stiffening_of_column(int c) const {
    assert(c >= 0 && c < columns);
    return column_stiffening.empty() ? 1 : column_stiffening[static_cast<std::size_t>(c)];
  }
  /// Factors of the second differences along u and along v that are centred at a site.
  double stiffening_along_u(int r, int c) const {
    return stiffening_of_column(c) * stiffening_at(r, c, 0);
  }
  double stiffening_along_v(int r, int c) const {
    return stiffening_of_row(r) * stiffening_at(r, c, 1);
  }
  double stiffening_at(int r, int c, std::size_t axis) const {
    return site_stiffening.empty()
               ? 1
               : site_stiffening[static_cast<std::size_t>(r * columns + c)][axis];
  }
  bool has_cell(int r, int c) const {
    return r >= 0 && c >= 0 && r + 1 < rows && c + 1 < columns &&
           kept[static_cast<std::size_t>(r * (columns - 1) + c)] != 0;
  }
  int cells_around(int r, int c) const {
    return has_cell(r - 1, c - 1) + has_cell(r - 1, c) + has_cell(r, c - 1) + has_cell(r, c);
  }
  Index particle(int r, int c) const {
    assert(r >= 0 && r < rows && c >= 0 && c < columns);
    return particles[static_cast<std::size_t>(r * columns + c)];
  }
};

/// A pinned strip along one side of a mesh, which is straight up to its border
/// (attachments/clamp_line.h).
struct HeldStrip {
  int axis = 0;           ///< across it: 0 u, 1 v
  bool far_side = false;  ///< holds what lies beyond the border in the direction of the axis
  double border = 0;      ///< coordinate [m]

  friend bool operator==(const HeldStrip&, const HeldStrip&) = default;
};

/// A thread of a triangle or along an edge of a grid, w = g1 (x1 - x0) + g2 (x2 - x0), that is
/// stiffer when its strain |w| - 1 exceeds the fabric's `locking_strain` (thread_locks.h).
template <class Real>
struct ThreadLock {
  Triangle x = {0, 0, 0};
  Real g1 = 0, g2 = 0;  ///< [1/m]
  Real stiffness = 0;   ///< (factor - 1) Y times its area [N m]
};

/// A range of consecutive indices.
struct IndexRange {
  Index first = 0, count = 0;
  Index end() const { return first + count; }
  bool contains(Index i) const { return i >= first && i < end(); }
};

/// Bounds of the highest squared frequency of membrane and bending [1/s^2], and the corresponding
/// bounds of damping rates [1/s]; see stability_bound.h.
struct FrequencyBounds {
  double membrane_omega2 = 0, bending_omega2 = 0;
  double locking_omega2 = 0;         ///< of all threads that may lock
  double membrane_shear_omega2 = 0;  ///< the share of membrane_omega2 that grows with the square
                                     ///< of the stretch; see membrane.h
  double membrane_damping_rate = 0, bending_damping_rate = 0;
  double area_per_mass = 0;  ///< that the air damps, in the worst motion [m^2/kg]
};

/// One cloth of a model: its range of every list, and its own data.
template <class Real>
struct ClothPart {
  std::string name;
  FabricDef fabric;
  IndexRange particles, triangles, edges, springs, hinges;
  IndexRange membrane;  ///< triangles of constant strain, in place of springs
  IndexRange locks;     ///< of a fabric that locks
  MembraneTensor<Real> membrane_tensor;
  int rows = 0, columns = 0;    ///< of a whole grid, with particle (r, c) at particles.first +
                                ///< r * columns + c; else 0
  Real cell_u = 0, cell_v = 0;  ///< h_x, h_y, cell size of a grid [m]
  Real rest_diagonal = 0;       ///< of the box around its rest positions [m]
  std::optional<GridSprings<Real>> grid_springs;  ///< the same springs, if they are regular
  QuadraticBending<Real> quadratic_bending;       ///< of a grid; it then has no hinges
  std::vector<BendingLink> bending_links;         ///< of a mesh
  Real bending_time = 0;  ///< tau of the quadratic form's dashpots (bending_dashpots.h) [s]
  TriangleCurvatures<Real> curvatures;  ///< of such a mesh, if it has these
  RestCurves<Real> rest_curves;         ///< of such a mesh, if it is curved at rest
  bool bends_by_links = false;          ///< such a mesh, even if no link is left
  bool curved_at_rest = false;          ///< such a mesh; it then has rest curves
  bool rests_by_triangle = false;       ///< each triangle rests by its `corner_material`, unbent;
                                        ///< the rest positions are where it starts
  std::vector<HeldStrip> held_strips;   ///< that the links are made for
  std::size_t bending_stencils = 0;     ///< or links of the quadratic form; see bending_stencil.h
  GridCells cells;                      ///< of a grid, whole or cut
  FrequencyBounds bounds;
};

/// Springs and membrane triangles of a part.
template <class Real>
std::size_t membrane_elements(const ClothPart<Real>& part) {
  return static_cast<std::size_t>(part.springs.count + part.membrane.count);
}

/// The constant data of the cloths. Several cloths follow each other in every list; no spring,
/// hinge or triangle joins two of them.
template <class Real>
struct ClothModel {
  std::vector<ClothPart<Real>> parts;         ///< in the order of their particles; at least one
  Vec3Array<Real> rest_positions;             ///< of a shape without strain, unless a part
                                              ///< `rests_by_triangle` [m]
  Vec3Array<Real> start_positions;            ///< where it begins, mostly the same [m]
  std::vector<std::array<Real, 2>> material;  ///< (u, v) coordinates in the fabric of its part [m]
  /// (u, v) of each triangle's corners [m], where a particle has several at a seam and `material`
  /// one of them; empty: those of the particles. See corner_places.h.
  std::vector<std::array<std::array<Real, 2>, 3>> corner_material;
  std::vector<Real> mass;             ///< [kg], positive
  std::vector<Triangle> triangles;    ///< of a grid with alternating diagonals
  std::vector<Real> triangle_area;    ///< at rest [m^2]
  std::vector<Edge> edges;            ///< unique edges of the triangles
  std::vector<Spring<Real>> springs;  ///< of a grid ordered by first end, then kind
  std::vector<SpringKind> spring_kinds;
  std::vector<Hinge<Real>> hinges;               ///< empty for a part with quadratic bending
  std::vector<MembraneTriangle<Real>> membrane;  ///< of a mesh, ordered by their first particle
  std::vector<ThreadLock<Real>> locks;

  Index particle_count() const { return static_cast<Index>(mass.size()); }
};

/// Builds one cloth, as a model with one part.
///
/// A grid has structural and shear springs whose continuum limit is the fabric's tensor, and hinges
/// over both splittings of its cells, with half the rigidity each, which give the bending rigidity
/// B in every direction. A mesh is built as described in mesh_cloth.h. Throws DefinitionError if a
/// field is out of range, a spring would have negative stiffness (shear too large for the cell's
/// shape) or a mesh is degenerate.
template <class Real>
ClothModel<Real> build_cloth(const ClothDef& def);

/// Builds several cloths as one model. Errors name the cloth: `cloth.` and `fabric.` for the first,
/// `cloths[k].` and `cloths[k].fabric.` for the others.
/// @param defs  at least one
template <class Real>
ClothModel<Real> build_cloths(const std::vector<ClothDef>& defs);

/// The part that contains a particle.
template <class Real>
const ClothPart<Real>& part_of_particle(const ClothModel<Real>& model, Index particle);

/// The particles of a part that are near and that edges with a near end join to where it starts, in
/// ascending order. What lies at the same place of the fabric, in another piece or on the far side
/// of a projected mesh, is not among them.
/// @param start  particles that belong together, of one part; not necessarily near
template <class Real>
std::vector<Index> joined_near(const ClothModel<Real>& model, std::span<const Index> start,
                               const std::function<bool(Index)>& is_near);

/// How far rounding may move a place of the fabric over a circle on which it lies [m]. Floats and
/// doubles must agree on what a circle holds, and so must its halves.
double disc_slack(const std::array<double, 2>& middle, double radius);

/// The particles of the same part within material distance `radius` [m] of particle `centre` that
/// edges near there join to it, in ascending order; at radius 0 the centre alone.
template <class Real>
std::vector<Index> particles_in_disc(const ClothModel<Real>& model, Index centre, double radius);

extern template ClothModel<float> build_cloth<float>(const ClothDef&);
extern template ClothModel<double> build_cloth<double>(const ClothDef&);
extern template ClothModel<float> build_cloths<float>(const std::vector<ClothDef>&);
extern template ClothModel<double> build_cloths<double>(const std::vector<ClothDef>&);
extern template const ClothPart<float>& part_of_particle(const ClothModel<float>&, Index);
extern template const ClothPart<double>& part_of_particle(const ClothModel<double>&, Index);
extern template std::vector<Index> particles_in_disc(const ClothModel<float>&, Index, double);
extern template std::vector<Index> particles_in_disc(const ClothModel<double>&, Index, double);

}  // namespace weft
