#include "core/cloth/grid_cloth.h"

#include <cmath>

#include "core/cloth/grid_springs.h"
#include "core/cloth/hinges.h"
#include "core/solver/substep_rule.h"

namespace weft {
namespace {

template <class Real>
void place_particles(const ClothDef& def, ClothModel<Real>& model) {
  const Vec3d u = def.u.normalized(), v = def.v.normalized();
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c) {
      const double s = def.width * c / (def.columns - 1), t = def.height * r / (def.rows - 1);
      model.rest_positions.push_back((def.origin + s * u + t * v).template cast<Real>());
      model.material.push_back({static_cast<Real>(s), static_cast<Real>(t)});
    }
  }
}

/// Half a cell's share on border lines and a quarter on corners, or the same for all.
template <class Real>
void lump_masses(const ClothDef& def, ClothModel<Real>& model) {
  const double total = def.fabric.areal_density * def.width * def.height;
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c) {
      const double share =
          (r == 0 || r == def.rows - 1 ? 0.5 : 1.0) * (c == 0 || c == def.columns - 1 ? 0.5 : 1.0);
      const double cells = (def.rows - 1.0) * (def.columns - 1.0);
      const double particles = static_cast<double>(def.rows) * def.columns;
      model.mass.push_back(static_cast<Real>(
          def.mass_lumping == MassLumping::area ? total * share / cells : total / particles));
    }
  }
}

/// Two triangles a cell with alternating diagonals: a grid split along one diagonal is three times
/// too stiff against bending in one diagonal direction. Normals point along u x v.
/// @param first  0 or 1: which of the two ways the first cell is split
template <class Real>
void split_cells(const ClothDef& def, int first, ClothModel<Real>& model) {
  for (int r = 0; r + 1 < def.rows; ++r) {
    for (int c = 0; c + 1 < def.columns; ++c) {
      const Index a = r * def.columns + c, b = a + 1, d = a + def.columns, e = d + 1;
      if ((r + c + first) % 2 == 0) {
        model.triangles.push_back({a, b, e});
        model.triangles.push_back({a, e, d});
      } else {
        model.triangles.push_back({a, b, d});
        model.triangles.push_back({b, e, d});
      }
    }
  }
  const double area = 0.5 * def.width * def.height / ((def.rows - 1.0) * (def.columns - 1.0));
  model.triangle_area.assign(model.triangles.size(), static_cast<Real>(area));
}

/// Hinges over both ways to split the cells, with half the rigidity each. In one way alone every
/// second particle is opposite to no edge along the axes: nothing resists its second difference,
/// and a strip free to relax into that pattern bends up to a quarter too easily.
template <class Real>
void add_hinges(const ClothDef& def, ClothModel<Real>& model) {
  const HingeSettings settings{
      def.rest_angle, false, def.fabric.bending_damping,
      def.bending_model == BendingModel::sine_hinges,
      [&](double du, double dv) { return 0.5 * grid_hinge_rigidity(def.fabric, du, dv); }};
  ClothModel<Real> other;
  other.rest_positions = model.rest_positions;
  other.material = model.material;
  split_cells(def, 1, other);
  connect_triangles(settings, other);
  connect_triangles(settings, model);
  model.hinges.insert(model.hinges.end(), other.hinges.begin(), other.hinges.end());
}

/// The springs' numbers by kind, unless some of them follow no rule.
template <class Real>
void summarise_springs(const ClothDef& def, ClothPart<Real>& part) {
  if (def.direct_springs || def.skip_stiffness != 0) return;
  const double cell_u = def.width / (def.columns - 1), cell_v = def.height / (def.rows - 1);
  const GridStiffness k = grid_stiffness(def.fabric, cell_u, cell_v);
  GridSprings<Real> springs;
  springs.warp = static_cast<Real>(k.warp);
  springs.weft = static_cast<Real>(k.weft);
  springs.shear = static_cast<Real>(k.shear);
  springs.rest_warp = static_cast<Real>(cell_u);
  springs.rest_weft = static_cast<Real>(cell_v);
  springs.rest_shear = static_cast<Real>(std::hypot(cell_u, cell_v));
  if (part.bounds.membrane_omega2 > 0)
    springs.damping_per_stiffness =
        static_cast<Real>(part.bounds.membrane_damping_rate / part.bounds.membrane_omega2);
  part.grid_springs = springs;
}

/// Keeps the hinges or replaces them by the quadratic form.
template <class Real>
void choose_bending(const ClothDef& def, ClothModel<Real>& model) {
  const bool quadratic =
      def.bending_model == BendingModel::quadratic ||
      (def.bending_model == BendingModel::automatic && quadratic_bending_fits(def));
  if (!quadratic) return;
  const FabricDef& fabric = def.fabric;
  const double cell_u = def.width / (def.columns - 1), cell_v = def.height / (def.rows - 1);
  ClothPart<Real>& part = model.parts.front();
  part.quadratic_bending = {
      static_cast<Real>(fabric.bending_warp * cell_v / (cell_u * cell_u * cell_u)),
      static_cast<Real>(fabric.bending_weft * cell_u / (cell_v * cell_v * cell_v)),
      static_cast<Real>((fabric.bending_warp + fabric.bending_weft) / (cell_u * cell_v))};
  model.hinges.clear();
  part.hinges = {};
  bound_quadratic_bending(model, part);
}

}  // namespace

// An edge along v bends with curvature along u. The diagonals resist twist alone, so their weight
// is 2 h_u^2 h_v^2 / (h_u^2 + h_v^2)^2 and their rigidity the mean (PHYSICS.md section 2).
double grid_hinge_rigidity(const FabricDef& fabric, double du, double dv) {
  constexpr double kAlongAxis = 1e-9;
  if (du < kAlongAxis) return fabric.bending_warp;
  if (dv < kAlongAxis) return fabric.bending_weft;
  const double d2 = du * du + dv * dv;
  return 0.5 * (fabric.bending_warp + fabric.bending_weft) * 2 * du * du * dv * dv / (d2 * d2);
}

template <class Real>
ClothModel<Real> build_grid_cloth(const ClothDef& def) {
  ClothModel<Real> model;
  model.parts.emplace_back();
  ClothPart<Real>& part = model.parts.front();
  part.rows = def.rows;
  part.columns = def.columns;
  part.cell_u = static_cast<Real>(def.width / (def.columns - 1));
  part.cell_v = static_cast<Real>(def.height / (def.rows - 1));
  part.longest_edge =
      std::hypot(static_cast<double>(part.cell_u), static_cast<double>(part.cell_v));
  place_particles(def, model);
  lump_masses(def, model);
  split_cells(def, 0, model);
  model.springs = grid_springs<Real>(def, model.spring_kinds);
  add_hinges(def, model);
  complete_part(def, model);
  bound_frequencies(model, part);
  if (!def.direct_springs) add_spring_damping(model, part, def.fabric.damping_ratio);
  summarise_springs(def, part);
  choose_bending(def, model);
  return model;
}

template ClothModel<float> build_grid_cloth<float>(const ClothDef&);
template ClothModel<double> build_grid_cloth<double>(const ClothDef&);

}  // namespace weft
