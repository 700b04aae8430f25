// Builds rectangular grids, and chooses the bending model of grids.

#include "core/cloth/grid_cloth.h"

#include <cassert>
#include <cmath>

#include "core/cloth/bending_stencil.h"
#include "core/cloth/constants.h"
#include "core/cloth/grid_cells.h"
#include "core/cloth/grid_springs.h"
#include "core/cloth/stability_bound.h"

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

/// Halves the share of a particle on border lines and quarters it at corners, or shares equally.
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

/// Whether all springs follow `uniform_springs`.
bool is_uniform(const ClothDef& def) {
  return !def.direct_springs && def.skip_stiffness == 0;
}

GridStiffness uniform_springs(const ClothDef& def) {
  return grid_stiffness(def.fabric, def.width / (def.columns - 1), def.height / (def.rows - 1));
}

/// Stores the springs' numbers by kind, if all springs are regular.
template <class Real>
void summarise_springs(const ClothDef& def, const SpringTimes& times, ClothPart<Real>& part) {
  if (!is_uniform(def)) return;
  const double cell_u = def.width / (def.columns - 1), cell_v = def.height / (def.rows - 1);
  const GridStiffness k = uniform_springs(def);
  GridSprings<Real> springs;
  springs.warp = static_cast<Real>(k.warp);
  springs.weft = static_cast<Real>(k.weft);
  springs.shear = static_cast<Real>(k.shear);
  springs.rest_warp = static_cast<Real>(cell_u);
  springs.rest_weft = static_cast<Real>(cell_v);
  springs.rest_shear = static_cast<Real>(std::hypot(cell_u, cell_v));
  springs.warp_time = static_cast<Real>(times.warp);
  springs.weft_time = static_cast<Real>(times.weft);
  springs.shear_time = static_cast<Real>(times.shear);
  springs.misfit = static_cast<Real>(misfit_stiffness(k, cell_u, cell_v));
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
  part.bending_time = static_cast<Real>(fabric.bending_damping);
  model.hinges.clear();
  part.hinges = {};
  visit_bending_stencils(
      part, [&](double, const Index*, const double*, int) { ++part.bending_stencils; });
  bound_quadratic_bending(model, part);
}

}  // namespace

GridCells whole_grid(int rows, int columns) {
  assert(rows >= 2 && columns >= 2);
  GridCells cells;
  cells.rows = rows;
  cells.columns = columns;
  cells.kept.assign(static_cast<std::size_t>(rows - 1) * static_cast<std::size_t>(columns - 1), 1);
  for (Index i = 0; i < rows * columns; ++i) cells.particles.push_back(i);
  return cells;
}

template <class Real>
void finish_grid(const ClothDef& def, ClothModel<Real>& model) {
  assert(model.parts.size() == 1);
  ClothPart<Real>& part = model.parts.front();
  bound_springs(model, part);
  bound_hinges(model, part);
  const SpringTimes times =
      grid_spring_times(def.fabric, def.width / (def.columns - 1), def.height / (def.rows - 1),
                        least_relaxation_time(part));
  if (!def.direct_springs) add_spring_damping(times, model, part);
  summarise_springs(def, times, part);
  choose_bending(def, model);
}

template void finish_grid(const ClothDef&, ClothModel<float>&);
template void finish_grid(const ClothDef&, ClothModel<double>&);

// An edge along v bends with curvature along u. The diagonals resist only twist, so their weight is
// 2 h_u^2 h_v^2 / (h_u^2 + h_v^2)^2 and their rigidity the mean: every direction then has the
// rigidity of the fabric (tests/laws/bending_test.cpp).
double grid_hinge_rigidity(const FabricDef& fabric, double du, double dv) {
  assert(du >= 0 && dv >= 0);
  if (du < kAlongThread) return fabric.bending_warp;
  if (dv < kAlongThread) return fabric.bending_weft;
  const double d2 = du * du + dv * dv;
  return 0.5 * (fabric.bending_warp + fabric.bending_weft) * 2 * du * du * dv * dv / (d2 * d2);
}

template <class Real>
ClothModel<Real> build_grid_cloth(const ClothDef& def) {
  assert(!def.mesh && def.outline == Outline::rectangle);
  ClothModel<Real> model;
  model.parts.emplace_back();
  ClothPart<Real>& part = model.parts.front();
  part.rows = def.rows;
  part.columns = def.columns;
  part.cell_u = static_cast<Real>(def.width / (def.columns - 1));
  part.cell_v = static_cast<Real>(def.height / (def.rows - 1));
  place_particles(def, model);
  lump_masses(def, model);
  part.cells = whole_grid(def.rows, def.columns);
  const double area = 0.5 * def.width * def.height / ((def.rows - 1.0) * (def.columns - 1.0));
  split_cells(part.cells, area, 0, model);
  model.springs = grid_springs<Real>(def, model.spring_kinds);
  add_hinges(def, part.cells, area, model);
  complete_part(def, model);
  finish_grid(def, model);
  return model;
}

template ClothModel<float> build_grid_cloth<float>(const ClothDef&);
template ClothModel<double> build_grid_cloth<double>(const ClothDef&);

}  // namespace weft
