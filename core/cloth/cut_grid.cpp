// Builds grids that are cut to an outline.

#include "core/cloth/cut_grid.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "core/cloth/grid_cells.h"
#include "core/cloth/grid_cloth.h"
#include "core/cloth/grid_springs.h"
#include "core/cloth/stability_bound.h"

namespace weft {
namespace {

/// A cut grid under construction.
struct Cut {
  GridCells cells;
  double cell_u = 0, cell_v = 0;  // [m]
};

Cut cut_out(const ClothDef& def) {
  Cut cut;
  cut.cells.rows = def.rows;
  cut.cells.columns = def.columns;
  cut.cell_u = def.width / (def.columns - 1);
  cut.cell_v = def.height / (def.rows - 1);
  for (int r = 0; r + 1 < def.rows; ++r) {
    for (int c = 0; c + 1 < def.columns; ++c) {
      const double x = (2 * c + 1.0) / (def.columns - 1) - 1,
                   y = (2 * r + 1.0) / (def.rows - 1) - 1;
      cut.cells.kept.push_back(x * x + y * y <= 1);
    }
  }
  Index count = 0;
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c)
      cut.cells.particles.push_back(cut.cells.cells_around(r, c) > 0 ? count++ : kNone);
  }
  return cut;
}

template <class Real>
void place_particles(const ClothDef& def, const Cut& cut, ClothModel<Real>& model) {
  const Vec3d u = def.u.normalized(), v = def.v.normalized();
  const double quarter = 0.25 * def.fabric.areal_density * cut.cell_u * cut.cell_v;
  double whole = 0;
  for (int r = 0; r < cut.cells.rows; ++r) {
    for (int c = 0; c < cut.cells.columns; ++c) {
      if (cut.cells.particle(r, c) == kNone) continue;
      const double s = cut.cell_u * c, t = cut.cell_v * r;
      model.rest_positions.push_back((def.origin + s * u + t * v).template cast<Real>());
      model.material.push_back({static_cast<Real>(s), static_cast<Real>(t)});
      const double mass = quarter * cut.cells.cells_around(r, c);
      assert(mass > 0);
      model.mass.push_back(static_cast<Real>(mass));
      whole += mass;
    }
  }
  if (def.mass_lumping == MassLumping::equal)
    model.mass.assign(model.mass.size(),
                      static_cast<Real>(whole / static_cast<double>(model.mass.size())));
}

/// Adds half an axis spring for each adjacent cell, and both diagonals of each cell.
template <class Real>
void add_springs(const ClothDef& def, const Cut& cut, ClothModel<Real>& model) {
  const GridStiffness k = grid_stiffness(def.fabric, cut.cell_u, cut.cell_v);
  const auto add = [&](Index i, Index j, double length, double stiffness, SpringKind kind) {
    assert(i != kNone && j != kNone);
    assert(length > 0 && stiffness >= 0);
    if (stiffness == 0) return;
    Spring<Real> spring;
    spring.i = i;
    spring.j = j;
    spring.rest_length = static_cast<Real>(length);
    spring.stiffness = static_cast<Real>(stiffness);
    model.springs.push_back(spring);
    model.spring_kinds.push_back(kind);
  };
  const double diagonal = std::hypot(cut.cell_u, cut.cell_v);
  for (int r = 0; r < cut.cells.rows; ++r) {
    for (int c = 0; c < cut.cells.columns; ++c) {
      const Index i = cut.cells.particle(r, c);
      if (i == kNone) continue;
      const bool above = cut.cells.has_cell(r - 1, c), left = cut.cells.has_cell(r, c - 1),
                 here = cut.cells.has_cell(r, c);
      if (above || here)
        add(i, cut.cells.particle(r, c + 1), cut.cell_u, 0.5 * (above + here) * k.warp,
            SpringKind::warp);
      if (left || here)
        add(i, cut.cells.particle(r + 1, c), cut.cell_v, 0.5 * (left + here) * k.weft,
            SpringKind::weft);
      if (here) add(i, cut.cells.particle(r + 1, c + 1), diagonal, k.shear, SpringKind::shear);
      if (left) add(i, cut.cells.particle(r + 1, c - 1), diagonal, k.shear, SpringKind::shear);
    }
  }
}

}  // namespace

template <class Real>
ClothModel<Real> build_cut_grid(const ClothDef& def) {
  assert(!def.mesh && def.outline != Outline::rectangle);
  Cut cut = cut_out(def);
  ClothModel<Real> model;
  model.parts.emplace_back();
  ClothPart<Real>& part = model.parts.front();
  place_particles(def, cut, model);
  const double area = 0.5 * cut.cell_u * cut.cell_v;
  split_cells(cut.cells, area, 0, model);
  add_springs(def, cut, model);
  add_hinges(def, cut.cells, area, model);
  part.cells = std::move(cut.cells);
  complete_part(def, model);
  finish_grid(def, model);
  return model;
}

template ClothModel<float> build_cut_grid<float>(const ClothDef&);
template ClothModel<double> build_cut_grid<double>(const ClothDef&);

}  // namespace weft
