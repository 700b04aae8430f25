#pragma once

#include <cassert>

#include "core/cloth/cloth_model.h"
#include "core/cloth/grid_cloth.h"
#include "core/cloth/hinges.h"

namespace weft {

// Cells of a grid as triangles and hinges, for whole and cut grids.

/// A rectangle with all cells.
GridCells whole_grid(int rows, int columns);

/// Completes a model of one part whose lists are filled: frequency bounds, dashpots, `grid_springs`
/// if the springs are regular, and the quadratic form in place of hinges if requested or suitable.
template <class Real>
void finish_grid(const ClothDef& def, ClothModel<Real>& model);

/// Splits each cell into two triangles with alternating diagonals: a grid split along one diagonal
/// is three times too stiff in bending along one diagonal direction. Normals point along u x v.
/// @param area   of a triangle [m^2]
/// @param first  0 or 1: the diagonal of the first cell
template <class Real>
void split_cells(const GridCells& shape, double area, int first, ClothModel<Real>& model) {
  assert(area > 0);
  assert(first == 0 || first == 1);
  for (int r = 0; r + 1 < shape.rows; ++r) {
    for (int c = 0; c + 1 < shape.columns; ++c) {
      if (!shape.has_cell(r, c)) continue;
      const Index a = shape.particle(r, c), b = shape.particle(r, c + 1),
                  d = shape.particle(r + 1, c), e = shape.particle(r + 1, c + 1);
      if ((r + c + first) % 2 == 0) {
        model.triangles.push_back({a, b, e});
        model.triangles.push_back({a, e, d});
      } else {
        model.triangles.push_back({a, b, d});
        model.triangles.push_back({b, e, d});
      }
    }
  }
  model.triangle_area.assign(model.triangles.size(), static_cast<Real>(area));
}

/// Adds hinges over both splittings of the cells, with half the rigidity each. In one splitting
/// every second particle is opposite to no edge along the axes: nothing resists its second
/// difference, and a strip free to relax into that pattern bends up to a quarter too easily.
template <class Real>
void add_hinges(const ClothDef& def, const GridCells& shape, double area, ClothModel<Real>& model) {
  const HingeSettings settings{
      def.rest_angle, false, def.fabric.bending_damping,
      def.bending_model == BendingModel::sine_hinges,
      [&](double du, double dv) { return 0.5 * grid_hinge_rigidity(def.fabric, du, dv); }};
  ClothModel<Real> other;
  other.rest_positions = model.rest_positions;
  other.material = model.material;
  split_cells(shape, area, 1, other);
  connect_triangles(settings, other);
  connect_triangles(settings, model);
  model.hinges.insert(model.hinges.end(), other.hinges.begin(), other.hinges.end());
}

}  // namespace weft
